// Colours for things that are to be told apart: calm, of well-spread lightness and hue, safe for colour-blind eyes.
#pragma once

#include <vector>

#include "base/color.h"

namespace pellucid {

/// Colours that differ from their neighbours by at least this distance in CIELAB (ΔE*ab), as all people see them: also
/// as simulated for protanopia and deuteranopia (Machado et al. 2009, severity 1).
inline constexpr double kLeastNeighbourDistance = 20;

/// `count` ≥ 1 colours for classes of ascending intensity: the last one is the lightest, ivory. From 6 on hues that
/// alternate in lightness, for labels, of which no order is asked.
std::vector<Rgb> classColors(int count);

/// From strongly negative to strongly positive: blue, light blue, light red, red.
std::vector<Rgb> divergingColors();

/// Of tissues in CT.
struct TissueColors {
    Rgb lung, fat, soft, bone, dense;
};
TissueColors tissueColors();

} // namespace pellucid
