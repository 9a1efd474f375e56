// Views that fit what is drawn: how much of the picture it fills, wherever it lies in its box.
#include <catch2/catch.hpp>

#include <algorithm>

#include "render/camera_motion.h"
#include "render/drawn_part.h"
#include "render/image_renderer.h"
#include "render/projected.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Opaque from intensity 0.5 on.
TransferFunction solid() {
    TransferFunction tf;
    tf.points = {{0.5, 0, {1, 1, 1}, false, {}}, {0.5, 1, {1, 1, 1}, false, {}}, {1, 1, {1, 1, 1}, false, {}}};
    tf.features = {{"all", 0.5, 1, {1, 1, 1}, {}}};
    return tf;
}

std::shared_ptr<const Volume> block(Int3 dims, Int3 lo, Int3 hi, Vec3 spacing = Vec3(1)) {
    return volumeFrom(geometryOf(dims, spacing), [=](int i, int j, int k) {
        return i >= lo.x && i < hi.x && j >= lo.y && j < hi.y && k >= lo.z && k < hi.z ? 1.0 : 0.0;
    });
}

struct Bounds {
    Vec3 lo{1e300}, hi{-1e300};
};
Bounds boundsOf(const DrawnPart& part) {
    Bounds b;
    for (const Vec3& p : part) {
        b.lo = glm::min(b.lo, p);
        b.hi = glm::max(b.hi, p);
    }
    return b;
}

/// The rectangle in which a picture of 240 × 160 pixels has an alpha above ½, in parts of its height.
struct Filled {
    double width, height, x, y; ///< x, y: of its middle, from that of the picture
};
Filled filledBy(const std::shared_ptr<const Volume>& volume, const Camera& camera) {
    RenderSettings settings;
    settings.width = 240;
    settings.height = 160;
    settings.background.reset();
    const Image image = makeCpuRenderer(volume)->render(camera, solid(), settings);
    int left = image.width, right = -1, top = image.height, bottom = -1;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (image.pixel(x, y)[3] > 0.5F) {
                left = std::min(left, x), right = std::max(right, x);
                top = std::min(top, y), bottom = std::max(bottom, y);
            }
    const double h = image.height;
    return {(right + 1 - left) / h, (bottom + 1 - top) / h, (left + right + 1 - image.width) / (2 * h),
            (top + bottom + 1 - image.height) / (2 * h)};
}

} // namespace

TEST_CASE("the drawn part reaches to the outer faces of its voxels", "[drawn part]") {
    // Voxels 10 to 19 along x of spacing 2: from 10·2 − 1 to 19·2 + 1; likewise along y and z, of spacing 1.
    const auto volume = block({40, 32, 24}, {10, 3, 8}, {20, 9, 12}, {2, 1, 1});
    const Bounds b = boundsOf(drawnPart(*volume, solid(), {}));
    CHECK(glm::length(b.lo - Vec3(19, 2.5, 7.5)) < 1e-9);
    CHECK(glm::length(b.hi - Vec3(39, 8.5, 11.5)) < 1e-9);
    // Cut off beyond the middle of the box along x: the centres of voxels 10 to 19 lie below 20 − ½.
    Clipping half;
    half.lo.x = 0.375; // voxel coordinate 14.5
    CHECK(boundsOf(drawnPart(*volume, solid(), half)).lo.x == Approx(15 * 2 - 1));
}

TEST_CASE("specks do not count beside something, and do where there is nothing else", "[drawn part]") {
    const auto dust = [](int i, int j, int k) { return (i * 7 + j * 13 + k * 29) % 997 == 0; };
    const auto dusty = volumeFrom(geometryOf(Int3(40)), [&](int i, int j, int k) {
        return (i >= 12 && i < 20 && j >= 12 && j < 20 && k >= 12 && k < 20) || dust(i, j, k) ? 1.0 : 0.0;
    });
    const Bounds b = boundsOf(drawnPart(*dusty, solid(), {}));
    CHECK(glm::length(b.lo - Vec3(11.5)) < 1e-9);
    CHECK(glm::length(b.hi - Vec3(19.5)) < 1e-9);
    const auto voxel = block(Int3(20), Int3(3), Int3(4));
    CHECK(glm::length(boundsOf(drawnPart(*voxel, solid(), {})).hi - Vec3(3.5)) < 1e-9);
    CHECK(drawnPart(*slab(Int3(8), 0.25), solid(), {}).empty());
}

TEST_CASE("something small in a large volume is looked at closely", "[drawn part]") {
    // 160³ voxels are sixteen times as many as are looked at: the second look is at the block alone.
    const auto volume = block(Int3(160), {100, 20, 70}, {112, 30, 85});
    const Bounds b = boundsOf(drawnPart(*volume, solid(), {}));
    CHECK(glm::length(b.lo - Vec3(99.5, 19.5, 69.5)) < 1e-9);
    CHECK(glm::length(b.hi - Vec3(111.5, 29.5, 84.5)) < 1e-9);
}

TEST_CASE("what is drawn fills the picture, in its middle, wherever it lies in its box", "[drawn part]") {
    const auto projection = GENERATE(Projection::Perspective, Projection::Orthographic);
    const auto lo = GENERATE(Int3(1, 2, 40), Int3(20, 30, 10));
    const auto volume = block(Int3(60), lo, lo + Int3(14, 9, 17));
    const Geometry& geometry = volume->geometry();
    for (const auto& [azimuth, elevation] :
         {std::pair(0, 0), std::pair(30, 20), std::pair(-135, 60), std::pair(0, 90)}) {
        CAPTURE(lo.x, azimuth, elevation);
        const Camera from = standardCamera(geometry, azimuth, elevation, projection);
        const Camera camera = fittedTo(drawnPart(*volume, solid(), {}), from, geometry);
        CHECK_NOTHROW(camera.validate(geometry, "test"));
        CHECK(glm::length(camera.forward() - from.forward()) < 1e-9);
        CHECK(camera.projection == projection);
        const Filled f = filledBy(volume, camera);
        CHECK(std::max(f.width, f.height) >= 0.8);
        CHECK(std::max(f.width, f.height) <= 0.95);
        CHECK(std::abs(f.x) < 0.03);
        CHECK(std::abs(f.y) < 0.03);
    }
}

TEST_CASE("where nothing is drawn the box is fitted", "[drawn part]") {
    const Geometry geometry = geometryOf(Int3(16));
    const Camera home = homeCamera(geometry, Projection::Perspective);
    CHECK(fittedTo({}, home, geometry) == fitted(home, geometry));
}

TEST_CASE("a single voxel in a large box is fitted from outside", "[drawn part]") {
    const Geometry geometry = geometryOf(Int3(400));
    DrawnPart part;
    for (int corner = 0; corner < 8; ++corner)
        part.push_back(Vec3(200) + Vec3(corner & 1, corner >> 1 & 1, corner >> 2));
    const Camera camera = fittedTo(part, homeCamera(geometry, Projection::Perspective), geometry);
    CHECK_NOTHROW(camera.validate(geometry, "test"));
    CHECK(camera.fovY >= 0.49);
}
