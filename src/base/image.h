// A picture in memory.
#pragma once

#include <cstddef>
#include <vector>

namespace pellucid {

/// Floats, width × height × 4 (R, G, B, A), top row first, sRGB components in [0,1]; colours straight, not
/// premultiplied. Alpha 1 everywhere where a background was given.
struct Image {
    int width = 0, height = 0;
    std::vector<float> rgba;

    Image() = default;
    Image(int w, int h)
        : width(w), height(h), rgba(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 4, 0.0f) {}
    float* pixel(int x, int y) {
        return &rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
    }
    const float* pixel(int x, int y) const { return const_cast<Image*>(this)->pixel(x, y); }
};

} // namespace pellucid
