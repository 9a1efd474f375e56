// A straight line through a box.
#pragma once

#include <algorithm>
#include <limits>

#include "render/camera.h"

namespace pellucid {

/// The part of a ray inside a box, as an interval of its parameter t; empty where enter ≥ exit.
struct RayInterval {
    double enter = 0, exit = 0;
    bool empty() const { return !(enter < exit); }
};

/// Box and ray in the same coordinates, whatever they are; t is the ray's own parameter.
inline RayInterval intersectBox(const Ray& ray, const Vec3& lo, const Vec3& hi) {
    RayInterval t{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (int a = 0; a < 3; ++a) {
        if (ray.direction[a] == 0.0) {
            if (ray.origin[a] < lo[a] || ray.origin[a] > hi[a]) return {0, 0};
            continue;
        }
        const double t0 = (lo[a] - ray.origin[a]) / ray.direction[a], t1 = (hi[a] - ray.origin[a]) / ray.direction[a];
        t.enter = std::max(t.enter, std::min(t0, t1));
        t.exit = std::min(t.exit, std::max(t0, t1));
    }
    return t;
}

/// A ray of the world in voxel coordinates. t stays the length in the world; the direction is no unit vector there.
inline Ray inVoxels(const Ray& world, const Geometry& geometry) {
    return {geometry.voxelFromWorld(world.origin), geometry.indexFromWorld() * world.direction};
}

/// The part of a ray in voxel coordinates inside the volume's box.
inline RayInterval intersectBox(const Ray& ray, const Geometry& geometry) {
    return intersectBox(ray, geometry.voxelBoxMin(), geometry.voxelBoxMax());
}

} // namespace pellucid
