// Colours between two colours, in the spaces in which other programs mix them (docs/method.md, "Transfer functions of
// other programs").
#pragma once

#include <vector>

#include "base/color.h"
#include "tf/lch.h"

namespace pellucid {

enum class ColorSpace {
    Rgb,        ///< straight through sRGB
    Hsv,        ///< hue as a number from 0 to 1
    HsvWrapped, ///< the shorter way round the circle of hues
    Lab,        ///< straight through CIELAB
    Diverging,  ///< lightness, saturation and hue of Msh, with white between two hues that lie far apart
    Step,       ///< the second colour
    Ciede2000,  ///< the shortest way by CIEDE2000
    ProLab      ///< straight through proLab
};

/// What lies between two colours.
class ColorWay {
public:
    ColorWay(const Rgb& from, const Rgb& to, ColorSpace space);
    Rgb at(double t) const; ///< t in [0,1]: `from` at 0 and, but for Step, until then; `to` at 1

private:
    struct Stop {
        Lab lab;
        double distance = 0; ///< from the first, of CIEDE2000
    };
    Rgb between(double t) const;

    Rgb m_from, m_to;
    ColorSpace m_space;
    std::vector<Stop> m_stops; ///< of Ciede2000
};

/// The difference of two colours by CIEDE2000.
double ciede2000(const Lab& p, const Lab& q);

/// The colour of CIELAB in sRGB. One that sRGB does not have gets darker until no part is above 1, and parts below 0
/// become 0, as VTK has it.
Rgb srgbFromLab(const Lab& lab);

} // namespace pellucid
