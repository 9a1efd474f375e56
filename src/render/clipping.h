// What is cut away of the volume, or made faint (docs/method.md, "Clipping").
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

/// A convex part of a volume: of its box, in fractions of it along the axes of the grid, within all half-spaces.
struct BoxPart {
    Vec3 lo{0, 0, 0}, hi{1, 1, 1}; ///< 0 ≤ lo < hi ≤ 1
    std::vector<ClipPlane> planes; ///< at most kMostClipPlanes

    bool operator==(const BoxPart&) const = default;
    bool isWhole() const { return lo == Vec3(0) && hi == Vec3(1) && planes.empty(); }
    void validate() const; ///< throws UsageError
};

/// What an object lies on: all that lies outside of a part of the volume. No feature has any of it.
struct FaintRest {
    BoxPart within;
    double density = 0; ///< of what lies outside, as part of its own, [0, 1); 0: it is left out

    bool operator==(const FaintRest&) const = default;
    bool isNone() const { return within.isWhole(); }
};

/// What is left: a part of the box. What lies outside is not there.
struct Clipping {
    Vec3 lo{0, 0, 0}, hi{1, 1, 1}; ///< as in BoxPart
    std::vector<ClipPlane> planes;
    FaintRest rest{};

    bool operator==(const Clipping&) const = default;
    bool isNone() const { return part().isWhole(); } ///< nothing is cut away, whatever is faint
    BoxPart part() const { return {lo, hi, planes}; }
    void setPart(const BoxPart& part) { lo = part.lo, hi = part.hi, planes = part.planes; }
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

/// The planes of a part, and those of its sides that are not sides of the box: at most kMostPartPlanes, and none where
/// it is the whole.
std::vector<VoxelPlane> planesInVoxels(const BoxPart& part, const Geometry& geometry);
inline constexpr std::size_t kMostPartPlanes = 6 + kMostClipPlanes;
/// Of what is left and not faint: of what features can have.
std::vector<VoxelPlane> planesInVoxels(const Clipping& clipping, const Geometry& geometry);

/// A clipping for a volume.
struct VoxelClipping {
    std::vector<VoxelPlane> cut, faint; ///< there is nothing beyond the first, and what lies beyond the others is faint
    double density = 0;                 ///< FaintRest::density
};
VoxelClipping clippingInVoxels(const Clipping& clipping, const Geometry& geometry);

/// In d0. A voxel whose centre lies no farther than this beyond a plane is kept, so that all engines, whatever their
/// precision, agree on planes through centres.
inline constexpr double kClipTie = 1e-3;

/// Whether the centre of a voxel is kept.
inline bool keeps(std::span<const VoxelPlane> planes, const Vec3& voxel) {
    for (const VoxelPlane& plane : planes)
        if (plane.beyond(voxel) > kClipTie) return false;
    return true;
}

/// What of its own a path keeps, a part of which, `within` in [0, 1], is not faint.
inline double thinned(double density, double within) { return density + (1 - density) * within; }

/// Leaves of an interval of a ray in voxel coordinates what lies within the planes.
void cut(RayInterval& interval, const Ray& ray, std::span<const VoxelPlane> planes);

} // namespace pellucid
