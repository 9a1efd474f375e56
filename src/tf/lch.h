// sRGB, CIELAB and CIELCh(ab), white point D65.
#pragma once

#include "base/color.h"

namespace pellucid {

struct Lab {
    double lightness = 0; ///< L*, [0,100]
    double a = 0, b = 0;  ///< a*, b*, within ±134 for sRGB colours
};

Lab labFromSrgb(const Rgb& srgb);
/// Of linear light.
Lab labFromLinear(const Rgb& linear);
/// CIE76's ΔE, the distance of both: 0 the same, about 2.3 just noticed, 100 black to white.
double deltaE(const Lab& p, const Lab& q);

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
