// sRGB and CIELCh(ab), white point D65.
#pragma once

#include "base/color.h"

namespace pellucid {

struct Lch {
    double lightness = 0;  ///< L*, [0,100]
    double chroma = 0;     ///< C*ab, [0, about 134] for sRGB colours
    double hueDegrees = 0; ///< [0, 360); 0 for greys
};

Lch lchFromSrgb(const Rgb& srgb);
/// The colour nearest in chroma that sRGB has, lightness clamped to [0,100], hue as given.
Rgb srgbFromLch(const Lch& lch);

/// The curve f(t) of CIELAB, t a tristimulus value as a part of the white point's.
double labCurve(double t);

/// One component of sRGB, and the linear light that it stands for; both in [0,1].
double linearFromSrgb(double value);
double srgbFromLinear(double value);

} // namespace pellucid
