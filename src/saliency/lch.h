// sRGB to CIELCh(ab), white point D65.
#pragma once

#include "tf/color.h"

namespace pellucid {

/// The appearance attributes of a colour (docs/method.md, "Saliency").
struct Appearance {
    double brightness = 0; ///< O_b = L*/100, [0,1]
    double saturation = 0; ///< O_s = C*ab/100, [0, about 1.34] for sRGB colours
};

struct Lch {
    double lightness = 0;  ///< L*, [0,100]
    double chroma = 0;     ///< C*ab, [0, about 134] for sRGB colours
    double hueDegrees = 0; ///< [0, 360); 0 for greys
};

Lch lchFromSrgb(const Rgb& srgb);
Appearance appearanceOf(const Rgb& srgb);

} // namespace pellucid
