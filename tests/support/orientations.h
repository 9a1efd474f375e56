// One anatomy stored in several ways: permuted, mirrored, oblique, sheared. All lie at the same place in the world.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "support/temp_folder.h"
#include "volume/loader.h"

namespace pellucid::test {

struct Oriented {
    std::string name;
    std::shared_ptr<const Volume> volume;
};

/// `g` with other axes: the grid of these dims whose centre is that of the box of `g`.
inline Geometry regridded(const Geometry& g, const Int3& dims, const Mat3& directions, const Vec3& spacing) {
    Geometry other = g;
    other.dims = dims;
    other.directions = directions;
    other.spacing = spacing;
    other.origin = Vec3(0);
    other.origin = g.boxCenter() - other.boxCenter();
    return other;
}

/// `anatomy` on another grid of the same world: trilinear, `outside` beyond its box.
inline Samples sampledOn(const Geometry& grid, const Volume& anatomy, double outside) {
    const Geometry& g = anatomy.geometry();
    std::vector<float> values;
    values.reserve(voxelCount(grid.dims));
    for (int k = 0; k < grid.dims.z; ++k)
        for (int j = 0; j < grid.dims.y; ++j)
            for (int i = 0; i < grid.dims.x; ++i) {
                const Vec3 p = g.voxelFromWorld(grid.worldFromVoxel(Vec3(i, j, k)));
                bool inside = true;
                Int3 at;
                Vec3 f;
                for (int a = 0; a < 3; ++a) {
                    inside = inside && p[a] > -0.5 - 1e-9 && p[a] < g.dims[a] - 0.5 + 1e-9;
                    const double clamped = std::clamp(p[a], 0.0, g.dims[a] - 1.0);
                    at[a] = std::min(static_cast<int>(clamped + 1e-9), g.dims[a] - 2);
                    f[a] = clamped - at[a];
                }
                double value = inside ? 0 : outside;
                for (int corner = 0; inside && corner < 8; ++corner) {
                    double weight = 1;
                    Int3 v = at;
                    for (int a = 0; a < 3; ++a) {
                        const bool far = (corner >> a & 1) != 0;
                        weight *= far ? f[a] : 1 - f[a];
                        v[a] += far;
                    }
                    if (weight > 1e-9)
                        value += weight * anatomy.value(static_cast<std::size_t>(
                                              v.x + static_cast<std::ptrdiff_t>(g.dims.x) * (v.y + g.dims.y * v.z)));
                }
                values.push_back(static_cast<float>(value));
            }
    return values;
}

/// The same anatomy eight times, through files: as it is, permuted and mirrored without any resampling, then on grids
/// that are oblique by 10° and sheared by 15°. The grid of `anatomy` follows the world's axes.
inline std::vector<Oriented> orientations(const Volume& anatomy, double outside) {
    const Geometry& g = anatomy.geometry();
    const TempFolder folder;
    std::vector<Oriented> all;
    const auto add = [&](const std::string& name, const Geometry& grid) {
        writeNrrd(Volume(grid, sampledOn(grid, anatomy, outside)), folder.path("a.nrrd"));
        VolumeSource source;
        source.path = folder.path("a.nrrd");
        all.push_back({name, std::make_shared<const Volume>(loadVolume(source).withRange(anatomy.range()))});
    };
    const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const Int3 d = g.dims;
    const Vec3 s = g.spacing;
    add("as it is", g);
    add("mirrored along i", regridded(g, d, Mat3(-x, y, z), s));
    add("mirrored along j and k", regridded(g, d, Mat3(x, -y, -z), s));
    add("turned about z", regridded(g, {d.y, d.x, d.z}, Mat3(y, -x, z), {s.y, s.x, s.z}));
    add("k first", regridded(g, {d.z, d.x, d.y}, Mat3(z, x, y), {s.z, s.x, s.y}));
    add("j and k exchanged, mirrored", regridded(g, {d.x, d.z, d.y}, Mat3(-x, -z, y), {s.x, s.z, s.y}));
    const Int3 larger = d + d / 4;
    const Mat3 turn = glm::mat3_cast(glm::angleAxis(glm::radians(10.0), glm::normalize(Vec3(1, 2, 3))));
    add("oblique by 10°", regridded(g, larger, turn, s));
    const double shear = glm::radians(15.0);
    add("sheared by 15°", regridded(g, larger + d / 4, Mat3(x, Vec3(std::sin(shear), std::cos(shear), 0), z), s));
    return all;
}

} // namespace pellucid::test
