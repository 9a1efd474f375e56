#include "render/overlay.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "render/slice.h"

namespace pellucid {

namespace {

/// Whether the file says where its voxels lie, not only how far they are apart.
bool isPlaced(const Geometry& g) {
    return g.worldAxes == WorldAxes::Patient || g.origin != Vec3(0) || g.directions != Mat3(1);
}

/// The interval that a box covers along a direction.
std::pair<double, double> extentAlong(const Geometry& g, const Vec3& direction) {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (int n = 0; n < 8; ++n) {
        const double at = glm::dot(direction, g.corner(n));
        lo = std::min(lo, at);
        hi = std::max(hi, at);
    }
    return {lo, hi};
}

/// Directions across which two boxes can be told apart: normals of the sides of both, and of all pairs of their edges.
std::vector<Vec3> separating(const Geometry& a, const Geometry& b) {
    std::vector<Vec3> all;
    const auto add = [&](const Vec3& p, const Vec3& q) {
        const Vec3 normal = glm::cross(p, q);
        if (glm::length(normal) > 1e-9) all.push_back(glm::normalize(normal));
    };
    for (int i = 0; i < 3; ++i) {
        add(a.directions[i], a.directions[(i + 1) % 3]);
        add(b.directions[i], b.directions[(i + 1) % 3]);
        for (int j = 0; j < 3; ++j) add(a.directions[i], b.directions[j]);
    }
    return all;
}

} // namespace

std::optional<double> Overlay::valueAt(const Vec3& world) const {
    return pellucid::valueAt(*volume, geometry.voxelFromWorld(world));
}

OverlayPlace overlayPlace(const Geometry& first, const Geometry& second) {
    OverlayPlace place{second, false};
    place.geometry.referenceLength = first.d0();
    place.byCentres = first.worldAxes != second.worldAxes || !(isPlaced(first) || isPlaced(second));
    if (place.byCentres) place.geometry.origin += first.boxCenter() - second.boxCenter();
    return place;
}

double boxGap(const Geometry& a, const Geometry& b) {
    double gap = 0;
    for (const Vec3& direction : separating(a, b)) {
        const auto [aLow, aHigh] = extentAlong(a, direction);
        const auto [bLow, bHigh] = extentAlong(b, direction);
        gap = std::max({gap, aLow - bHigh, bLow - aHigh});
    }
    return gap;
}

} // namespace pellucid
