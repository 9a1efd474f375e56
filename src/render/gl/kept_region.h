// What clipping leaves of a volume: a convex region in voxel coordinates. No GL.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "render/clipping.h"

namespace pellucid::gl {

/// The corners of the kept part of the box, voxel coordinates, in no order; a corner in which many planes meet comes
/// more than once. Planes are taken kClipTie farther out, so that every voxel for which keeps() holds lies inside.
/// Empty where nothing is kept.
std::vector<Vec3> keptCorners(const Geometry& geometry, std::span<const VoxelPlane> planes);

/// Voxels between two corners, both included.
struct KeptVoxels {
    Int3 first{0, 0, 0}, last{0, 0, 0};
};
/// The smallest block of voxels that holds every kept one; empty where there is none.
std::optional<KeptVoxels> keptVoxels(const Geometry& geometry, std::span<const VoxelPlane> planes);

} // namespace pellucid::gl
