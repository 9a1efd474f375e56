// Colours of heights: what a ground under the volume is painted with (docs/method.md, "The ground").
#pragma once

#include <string>
#include <vector>

#include "base/color.h"

namespace pellucid {

/// Beside the colour maps of transfer functions, and for heights alone: it jumps at the coast.
inline constexpr const char* kTerrainMap = "terrain";

/// t in [0, 1], clamped: 0 is the sea, then green lowlands, brown, white.
Rgb terrainColor(double t);

using ColorAt = Rgb (*)(double t);
/// The colours of kTerrainMap, or of the map of this name in colorMaps(); not of a categorical one. Throws UsageError
/// that lists them all.
ColorAt groundColors(const std::string& name);
/// All names that groundColors() takes, kTerrainMap first.
std::vector<std::string> groundColorNames();

} // namespace pellucid
