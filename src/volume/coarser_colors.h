// Colours by voxel for a coarser copy of their volume.
#pragma once

#include "volume/voxel_colors.h"

namespace pellucid {

/// Each voxel the mean over `factor` (≥ 1) voxels along each axis, fewer at the far ends: the grid of coarserCopy().
VoxelColors coarserColors(const VoxelColors& colors, int factor);

} // namespace pellucid
