#include "render/clipping.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/error.h"

namespace pellucid {

void BoxPart::validate() const {
    for (int a = 0; a < 3; ++a)
        if (!(lo[a] >= 0 && lo[a] < hi[a] && hi[a] <= 1))
            throw UsageError("a clip interval needs 0 <= a < b <= 1", "clip", "give fractions of the box");
    if (planes.size() > kMostClipPlanes)
        throw UsageError("there are " + std::to_string(planes.size()) + " oblique clip planes", "clip",
                         "give at most " + std::to_string(kMostClipPlanes));
    for (const ClipPlane& plane : planes) {
        const double length = glm::length(plane.normal);
        if (!(length > 0) || !std::isfinite(length) || !std::isfinite(plane.offset))
            throw UsageError("a clip plane needs a normal that is not 0 and finite numbers", "clip",
                             "give its normal and distance");
    }
}

void Clipping::validate() const {
    part().validate();
    rest.within.validate();
    if (!(rest.density >= 0 && rest.density < 1))
        throw UsageError("what is faint needs 0 <= density < 1", "holder", "give 0 to leave it out, 0.05 to see it");
}

std::vector<VoxelPlane> planesInVoxels(const BoxPart& part, const Geometry& geometry) {
    std::vector<VoxelPlane> planes;
    const Mat3 worldFromIndex = geometry.worldFromIndex(), indexFromWorld = geometry.indexFromWorld();
    const double d0 = geometry.d0();
    for (int a = 0; a < 3; ++a) {
        // Distance between the planes of voxels, in d0; the gradient of index a is row a of A⁻¹.
        const Vec3 gradient{indexFromWorld[0][a], indexFromWorld[1][a], indexFromWorld[2][a]};
        const double apart = 1 / (glm::length(gradient) * d0);
        Vec3 normal(0);
        normal[a] = apart;
        if (part.lo[a] > 0) planes.push_back({-normal, -apart * (part.lo[a] * geometry.dims[a] - 0.5)});
        if (part.hi[a] < 1) planes.push_back({normal, apart * (part.hi[a] * geometry.dims[a] - 0.5)});
    }
    for (const ClipPlane& plane : part.planes) {
        const double scale = 1 / (glm::length(plane.normal) * d0);
        planes.push_back({glm::transpose(worldFromIndex) * plane.normal * scale,
                          (plane.offset - glm::dot(plane.normal, geometry.origin)) * scale});
    }
    return planes;
}

std::vector<VoxelPlane> planesInVoxels(const Clipping& clipping, const Geometry& geometry) {
    std::vector<VoxelPlane> planes = planesInVoxels(clipping.part(), geometry);
    const std::vector<VoxelPlane> faint = planesInVoxels(clipping.rest.within, geometry);
    planes.insert(planes.end(), faint.begin(), faint.end());
    return planes;
}

VoxelClipping clippingInVoxels(const Clipping& clipping, const Geometry& geometry) {
    return {planesInVoxels(clipping.part(), geometry), planesInVoxels(clipping.rest.within, geometry),
            clipping.rest.density};
}

void cut(RayInterval& interval, const Ray& ray, std::span<const VoxelPlane> planes) {
    for (const VoxelPlane& plane : planes) {
        const double beyond = plane.beyond(ray.origin), rate = glm::dot(plane.normal, ray.direction);
        if (rate == 0) {
            if (beyond > kClipTie) interval.exit = interval.enter; // nothing is left
            continue;
        }
        const double at = -beyond / rate;
        if (rate > 0)
            interval.exit = std::min(interval.exit, at);
        else
            interval.enter = std::max(interval.enter, at);
    }
}

} // namespace pellucid
