// A pixel as windows show it.
#pragma once

#include <algorithm>
#include <cstdint>

namespace pellucid {

/// 0xffRRGGBB: opaque; components of `rgb` beyond [0, 1] are held in it.
inline std::uint32_t screenPixel(const float* rgb) {
    const auto byte = [](float v) { return static_cast<std::uint32_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f); };
    return 0xff000000u | byte(rgb[0]) << 16 | byte(rgb[1]) << 8 | byte(rgb[2]);
}

} // namespace pellucid
