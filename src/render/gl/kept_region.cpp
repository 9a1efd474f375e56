#include "render/gl/kept_region.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pellucid::gl {

std::vector<Vec3> keptCorners(const Geometry& geometry, std::span<const VoxelPlane> planes) {
    std::vector<Vec3> corners;
    if (planes.empty()) {
        for (int n = 0; n < 8; ++n)
            corners.push_back(
                glm::mix(geometry.voxelBoxMin(), geometry.voxelBoxMax(), Vec3(n & 1, n >> 1 & 1, n >> 2 & 1)));
        return corners;
    }
    std::vector<VoxelPlane> all;
    for (const VoxelPlane& plane : planes) all.push_back({plane.normal, plane.offset + kClipTie});
    for (int a = 0; a < 3; ++a) {
        Vec3 normal(0);
        normal[a] = 1;
        all.push_back({-normal, 0.5});
        all.push_back({normal, geometry.dims[a] - 0.5});
    }
    const double size = glm::length(Vec3(geometry.dims));
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            for (std::size_t k = 0; k < j; ++k) {
                // The point that lies on all three.
                const Vec3 jk = glm::cross(all[j].normal, all[k].normal);
                const double volume = glm::dot(all[i].normal, jk);
                if (std::abs(volume) < 1e-12 * glm::length(all[i].normal) * glm::length(jk)) continue;
                const Vec3 p = (all[i].offset * jk + all[j].offset * glm::cross(all[k].normal, all[i].normal) +
                                all[k].offset * glm::cross(all[i].normal, all[j].normal)) /
                               volume;
                const auto holds = [&](const VoxelPlane& plane) {
                    return plane.beyond(p) <= 1e-9 * size * glm::length(plane.normal);
                };
                if (std::ranges::all_of(all, holds)) corners.push_back(p);
            }
    return corners;
}

std::optional<KeptVoxels> keptVoxels(const Geometry& geometry, std::span<const VoxelPlane> planes) {
    const Int3 most = geometry.dims - 1;
    if (planes.empty()) return KeptVoxels{Int3(0), most};
    const std::vector<Vec3> corners = keptCorners(geometry, planes);
    if (corners.empty()) return {};
    Vec3 lo = corners.front(), hi = lo;
    for (const Vec3& p : corners) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    constexpr double kRounding = 1e-6; // of the corners
    const KeptVoxels kept{glm::max(Int3(glm::ceil(lo - kRounding)), Int3(0)),
                          glm::min(Int3(glm::floor(hi + kRounding)), most)};
    for (int a = 0; a < 3; ++a)
        if (kept.first[a] > kept.last[a]) return {};
    return kept;
}

} // namespace pellucid::gl
