// Opacity for a step of any length: the only copy of the formula in C++ (GLSL: shaders/include/opacity.glsl).
#pragma once

#include <algorithm>
#include <cmath>

namespace pellucid {

/// docs/method.md, "Visibility": α is capped, so that the extinction stays finite.
inline constexpr double kMaxOpacity = 1.0 - 1e-7;

/// Optical depth −ln(1 − α) of one reference length d0 (τ·d0 of docs/method.md, "Visibility"). In [0, 16.2].
inline double opticalDepthOfOpacity(double alpha) { return -std::log1p(-std::min(alpha, kMaxOpacity)); }

/// 1 − (1 − α)^(d/d0); `steps` = d/d0, the step's length in reference lengths.
inline double opacityOfStep(double alpha, double steps) { return -std::expm1(-opticalDepthOfOpacity(alpha) * steps); }

} // namespace pellucid
