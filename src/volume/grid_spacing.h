// The distances of a grid's voxels where its file does not state them, or states them wrongly: as the user has them.
#pragma once

#include <string>

#include "volume/volume.h"

namespace pellucid {

struct GridSpacing {
    Vec3 distances{1, 1, 1};               ///< of voxels of the data along i, j, k, in `unit`
    LengthUnit unit = LengthUnit::Unknown; ///< Unknown: the one of the file
    bool operator==(const GridSpacing&) const = default;
};

/// "SX,SY,SZ[,UNIT]", such as "0.2,0.2,1,um". Throws UsageError, also for distances that nothing can be computed with
/// (spacing.h).
GridSpacing parseGridSpacing(const std::string& text);
/// The same text back.
std::string gridSpacingText(const GridSpacing& spacing);

/// How far the voxels of the data are apart of which `volume` is made, however coarse it is itself; in unitOf() its
/// geometry.
GridSpacing spacingOfData(const Volume& volume);

/// `geometry` of `volume` with these distances. The first voxel of the data stays where it is, whatever part of them
/// `volume` is, and however coarse; a patient's lengths stay millimetres. Throws UsageError for what is too small or
/// too large in that unit.
Geometry withSpacing(const Volume& volume, const Geometry& geometry, const GridSpacing& spacing);

} // namespace pellucid
