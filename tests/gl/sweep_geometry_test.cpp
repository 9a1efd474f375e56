#include "gl_test.h"

#include <array>

#include <glm/geometric.hpp>

#include "render/gl/depth_tables.h"
#include "render/gl/picture_rays.h"
#include "render/gl/resident_volume.h"
#include "render/gl/sweep_geometry.h"

using namespace pellucid;
using namespace pellucid::gl;
using namespace pellucid::testing;

namespace {

const Geometry kBox{{12, 9, 7}, {1, 0.5, 2}, {4, 5, 6}};

} // namespace

TEST_CASE("a view along an axis has one ray per voxel column and one sample per voxel plane", "[sweep]") {
    const Geometry cube{{6, 5, 4}, {1, 1, 1}, {0, 0, 0}};
    const auto sweeps = makeSweeps(orthographic(cube, {0, -1, 0}, 10), cube, Quality::Normal);
    REQUIRE(sweeps.size() == 1);
    const Sweep& s = sweeps[0];
    CHECK(s.axis == 1);
    CHECK(s.sign == -1);
    CHECK(s.dims == Int3(6, 4, 5)); // x and z across, y along
    CHECK(s.rays == glm::ivec2(6, 4));
    CHECK(s.grid == glm::dvec2(0, 0));
    CHECK(s.front == -0.5);
    CHECK(s.firstPlane == 0);
    CHECK(s.pieces == 1);
    CHECK(s.ownPlanes == glm::ivec2(1, 1)); // every ray is a voxel's own line
}

TEST_CASE("the axis of a sweep is the one along which rays cross most voxels", "[sweep]") {
    // Voxels a thousand times as long along x: at 45 degrees a ray crosses 1000 along y while it crosses one along x.
    const Geometry thick{{20, 30, 10}, {1000, 1, 1}, {0, 0, 0}};
    const auto sweeps = makeSweeps(orthographic(thick, {1, 1, 0}, 10), thick, Quality::Normal);
    REQUIRE(sweeps.size() == 1);
    CHECK(sweeps[0].axis == 1);
    CHECK(sweeps[0].shear == glm::dvec2(0.001, 0));
    CHECK(sweeps[0].pieces == 2);
}

TEST_CASE("rays of an eye that is very far away are parallel", "[sweep]") {
    const auto sweeps = makeSweeps(perspective(kBox, {0, -1e12, 0}), kBox, Quality::Normal);
    REQUIRE(sweeps.size() == 1);
    CHECK_FALSE(sweeps[0].perspective);
    CHECK(sweeps[0].axis == 1);
    CHECK(sweeps[0].sign == 1);
}

TEST_CASE("sweep coordinates and the volume's own agree", "[sweep]") {
    for (const Vec3& direction :
         {Vec3(1, 0.2, 0), Vec3(-1, 0.2, 0), Vec3(0, 1, 0.1), Vec3(0, -1, 0.1), Vec3(0, 0, 1), Vec3(0, 0.1, -1)}) {
        const auto sweeps = makeSweeps(orthographic(kBox, direction, 10), kBox, Quality::Normal);
        REQUIRE(sweeps.size() == 1);
        const Sweep& s = sweeps[0];
        const Grid<char> grid(kBox.dims);
        const auto stride = s.strides();
        double depthBefore = -1e9;
        for (int c = 0; c < s.dims.z; ++c) {
            const int a = (c * 3) % s.dims.x, b = (c * 5) % s.dims.y;
            const Int3 voxel(glm::round(s.voxelFromQ() * Vec3(a, b, c) + s.voxelOffset()));
            CHECK(static_cast<std::ptrdiff_t>(grid.index(voxel.x, voxel.y, voxel.z)) ==
                  stride.base + a * stride.a + b * stride.b + c * stride.c);
            const double depth = voxel[s.axis] * direction[s.axis];
            CHECK(depth > depthBefore); // c grows away from the eye
            depthBefore = depth;
        }
    }
}

TEST_CASE("every voxel's ray lies between rays of its sweep", "[sweep]") {
    const Vec3 c = kBox.boxCenter(), hi = kBox.boundsMax();
    for (const Vec3& eye :
         {c + Vec3(30, -50, 20), c + Vec3(0, -2.8, 0), hi + Vec3(0.5, 0.6, 0.4), Vec3(c.x, c.y, hi.z + 0.1)}) {
        Camera camera = perspective(kBox, eye - c);
        int voxels = 0;
        for (const Sweep& s : makeSweeps(camera, kBox, Quality::Normal)) {
            for (int z = s.firstPlane; z < s.dims.z; ++z)
                for (int y = 0; y < s.dims.y; ++y)
                    for (int x = 0; x < s.dims.x; ++x) {
                        const Vec3 q(x, y, z), d = q - s.eye;
                        if (s.pyramid && (std::abs(d.x) > d.z || std::abs(d.y) > d.z)) continue;
                        ++voxels;
                        for (int lateral = 0; lateral < 2; ++lateral) {
                            const double at = s.eye[lateral] +
                                              (q[lateral] - s.eye[lateral]) * (s.reference - s.eye.z) / (q.z - s.eye.z);
                            const double position = (at - s.grid[lateral]) * s.raysPerVoxel;
                            CHECK(position >= -1e-3);
                            CHECK(position <= s.rays[lateral] - 1 + 1e-3);
                        }
                    }
        }
        // Voxels on the border of two pyramids are counted twice here; none may be missing.
        CHECK(voxels >= static_cast<int>(voxelCount(kBox.dims)));
    }
}

TEST_CASE("an eye far away needs one sweep, one close to the box several", "[sweep]") {
    CHECK(makeSweeps(perspective(kBox, {3, -60, 5}), kBox, Quality::Normal).size() == 1);
    CHECK(makeSweeps(perspective(kBox, {0, -2.3, 0}), kBox, Quality::Normal).size() > 1);
}

TEST_CASE("tables integrate tau exactly, whatever the transfer function", "[tables]") {
    // A tent from 0.2 over (0.5, 1) to 0.5 (a step down to 0), then a box of alpha 0.5 over [0.7, 0.9].
    TransferFunction tf;
    tf.points = {{0.2, 0, {}, false, {}},   {0.5, 1.0, {}, false, {}}, {0.5, 0, {}, false, {}}, {0.7, 0, {}, false, {}},
                 {0.7, 0.5, {}, false, {}}, {0.9, 0.5, {}, false, {}}, {0.9, 0, {}, false, {}}};
    const int cells = 1000;
    const TransferFunction other = constantOpacity(0.25);
    const std::array<TransferFunction, 2> tfs{tf, other};
    const DepthTables t = makeDepthTables(tfs, 4, cells);
    const auto integral = [&](double s, std::size_t lane) {
        return t.integral[static_cast<std::size_t>(std::lround(s * cells)) * 4 + lane] * t.unit / cells;
    };
    // Over the tent: 0.3 times the integral of -ln(1 - a) over [0, 1], which is 1. Over the box: 0.2 ln 2.
    CHECK(integral(0.2, 0) == 0);
    CHECK(integral(0.5, 0) == Approx(0.3).epsilon(1e-5));
    CHECK(integral(0.7, 0) == Approx(0.3).epsilon(1e-5));
    CHECK(integral(1.0, 0) == Approx(0.3 + 0.2 * std::log(2.0)).epsilon(1e-5));
    CHECK(integral(1.0, 1) == Approx(-std::log(0.75)).epsilon(1e-6));
    CHECK(integral(1.0, 3) == integral(1.0, 1)); // the last one fills the lanes that are left
    const auto tau = [&](int entry, std::size_t lane) { return t.tau[static_cast<std::size_t>(entry) * 4 + lane]; };
    CHECK(static_cast<double>(tau(350, 0)) == Approx(std::log(2.0))); // alpha = 0.5 half way up
    CHECK(tau(500, 0) == 0);                                          // of two points the later one holds
    CHECK(static_cast<double>(tau(700, 0)) == Approx(std::log(2.0)));
    CHECK(tau(900, 0) == 0);
    CHECK(t.opaqueBefore[1000] == 1000); // the second one is opaque everywhere
    const DepthTables alone = makeDepthTables({&tf, 1}, 1, cells);
    CHECK(alone.opaqueBefore[200] == 0);
    CHECK(alone.opaqueBefore[500] == 300);
    CHECK(alone.opaqueBefore[1000] == 500);
}

TEST_CASE("integer intensities are entries of the tables", "[tables]") {
    const auto eight = volumeOf({2, 1, 1}, {0, 255});
    CHECK(tableCells(*eight, Quality::Normal) % 255 == 0);
    const Volume twelve(Geometry{{2, 1, 1}, {1, 1, 1}, {0, 0, 0}}, Samples(std::vector<std::uint16_t>{0, 4999}));
    CHECK(tableCells(twelve, Quality::Normal) == 4999);
}

TEST_CASE("boxes longer than a texture are folded into one", "[tables]") {
    CHECK_FALSE(foldInto({16, 16, 16}, 16)->folded());
    const auto f = foldInto({41, 7, 3}, 16);
    REQUIRE(f);
    CHECK(f->bricks == Int3(3, 1, 1)); // 40 cells in bricks of at most 15
    CHECK(f->brick.x == 14);
    CHECK(f->tile == Int3(15, 7, 3));
    CHECK(f->slots.x * f->slots.y * f->slots.z >= 3);
    for (int a = 0; a < 3; ++a) CHECK(f->textureSize()[a] <= 16);
    CHECK_FALSE(foldInto({16, 16, 17}, 16)); // more voxels than a texture holds
    CHECK_FALSE(foldInto({5, 1, 1}, 1));
}

TEST_CASE("rays of the picture are the camera's", "[picture]") {
    Geometry sheared = kBox;
    sheared.directions = {Vec3(0, -1, 0), glm::normalize(Vec3(0.3, 0, 1)), Vec3(1, 0, 0)};
    for (const Geometry& g : {kBox, sheared})
        for (const Camera& camera : {perspective(g, {10, -20, 15}), orthographic(g, {0.3, 1, -0.4}, 20)}) {
            const PictureRays rays(camera, g, 31.0 / 17);
            for (const auto& [x, y] : {std::pair(0.5, 0.5), std::pair(20.25, 3.0)}) {
                const Vec3 picture(2 * x / 31 - 1, 1 - 2 * y / 17, 1);
                const Ray ray = pixelRay(camera, x, y, 31, 17);
                const auto at = [&](double t) {
                    return g.worldFromVoxel(rays.origin * picture + t * (rays.direction * picture));
                };
                for (const double t :
                     {-2.0, 0.0, 3.0}) { // points of the camera's ray, t deep from the middle of the box
                    const Vec3 off = at(t) - ray.origin;
                    CHECK(glm::length(off - ray.direction * glm::dot(off, ray.direction)) < 1e-8);
                    CHECK(glm::dot(at(t) - g.boxCenter(), camera.forward()) == Approx(t).margin(1e-9));
                }
                const double length = glm::length(Vec3(rays.tangents.x * picture.x, rays.tangents.y * picture.y, 1));
                CHECK(glm::length(at(1) - at(0)) == Approx(length));
                if (camera.projection == Projection::Perspective)
                    CHECK(glm::length(at(rays.nearest) - camera.eye) < 1e-9);
            }
        }
}
