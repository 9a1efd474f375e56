// Numbers of 8 bits, as the published profile rounds colours and opacities (docs/method.md, "The published profile").
#pragma once

#include <algorithm>
#include <cmath>

namespace pellucid {

/// ⌊255·clamp(v)+½⌋, in [0,255].
inline int eightBit(double v) { return static_cast<int>(std::floor(255 * std::clamp(v, 0.0, 1.0) + 0.5)); }

/// q8(v) = eightBit(v)/255.
inline double roundedToEightBits(double v) { return eightBit(v) / 255.0; }

} // namespace pellucid
