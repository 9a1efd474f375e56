// What is cut away of the volume: it has opacity 0 in pictures and in measures (docs/method.md, "Clipping").
#pragma once

#include <span>
#include <vector>

#include "render/ray_box.h"

namespace pellucid {

/// A half-space that is kept: dot(normal, p) ≤ offset, world units. The normal has any length but 0.
struct ClipPlane {
    Vec3 normal{0, 0, 1};
    double offset = 0;
    bool operator==(const ClipPlane&) const = default;
};

inline constexpr std::size_t kMostClipPlanes = 6;

/// What is left: a part of the box, in fractions of it along the axes of the grid, within all half-spaces.
struct Clipping {
    Vec3 lo{0, 0, 0}, hi{1, 1, 1}; ///< 0 ≤ lo < hi ≤ 1
    std::vector<ClipPlane> planes; ///< at most kMostClipPlanes

    bool operator==(const Clipping&) const = default;
    bool isNone() const { return lo == Vec3(0) && hi == Vec3(1) && planes.empty(); }
    void validate() const; ///< throws UsageError
};

/// The same half-space for a volume: dot(normal, voxel) ≤ offset; the difference of the two is the distance from the
/// plane in the world, in units of d0.
struct VoxelPlane {
    Vec3 normal;
    double offset;
    double beyond(const Vec3& voxel) const {
        return normal.x * voxel.x + normal.y * voxel.y + normal.z * voxel.z - offset;
    }
};

/// The planes, and those sides of the part of the box that are not sides of the box: at most 6 + kMostClipPlanes, and
/// none where nothing is clipped.
std::vector<VoxelPlane> planesInVoxels(const Clipping& clipping, const Geometry& geometry);

/// In d0. A voxel whose centre lies no farther than this beyond a plane is kept, so that all engines, whatever their
/// precision, agree on planes through centres.
inline constexpr double kClipTie = 1e-3;

/// Whether the centre of a voxel is kept.
inline bool keeps(std::span<const VoxelPlane> planes, const Vec3& voxel) {
    for (const VoxelPlane& plane : planes)
        if (plane.beyond(voxel) > kClipTie) return false;
    return true;
}

/// Leaves of an interval of a ray in voxel coordinates what lies within the planes.
void cut(RayInterval& interval, const Ray& ray, std::span<const VoxelPlane> planes);

} // namespace pellucid
