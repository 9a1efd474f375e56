// The view that a volume opens on: what hides what from where, and that patients are seen as they are known.
#include <catch2/catch.hpp>

#include "base/parallel.h"
#include "optimize/views/opening_view.h"
#include "render/camera_motion.h"
#include "render/view_direction.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Two features, opaque, of low and of high intensities: what lies between them is neither, so that no rim of the one
/// is the other.
TransferFunction twoSolids(double opacity = 0.9) {
    TransferFunction tf;
    tf.points = {{0, opacity, {1, 0, 0}, false, {}},    {0.35, opacity, {1, 0, 0}, false, {}},
                 {0.35, 0, {1, 0, 0}, false, {}},       {0.65, 0, {0, 0, 1}, false, {}},
                 {0.65, opacity, {0, 0, 1}, false, {}}, {1, opacity, {0, 0, 1}, false, {}}};
    tf.features = {{"plate", 0, 0.35, {1, 0, 0}, {}}, {"block", 0.65, 1, {0, 0, 1}, {}}};
    return tf;
}

/// A plate across the usual view, and a block behind it that cannot be seen from in front.
std::shared_ptr<const Volume> plateBeforeBlock(WorldAxes axes = WorldAxes::File) {
    Geometry geometry = geometryOf(Int3(48));
    geometry.worldAxes = axes;
    return volumeFrom(geometry, [](int i, int j, int k) {
        const bool across = i >= 4 && i < 44 && k >= 4 && k < 44;
        if (across && j >= 14 && j < 18) return 0.2;
        return std::abs(i - 24) < 5 && std::abs(k - 24) < 5 && j >= 20 && j < 30 ? 0.8 : 0.5;
    });
}

Camera usual(const Volume& volume) { return homeCamera(volume.geometry(), Projection::Perspective); }

} // namespace

TEST_CASE("what hides nothing is shown least wholly, what hides something is not", "[opening view]") {
    const auto volume = plateBeforeBlock();
    const Geometry& geometry = volume->geometry();
    const auto shownFrom = [&](double azimuth, double elevation) {
        return shownLeast(*volume, twoSolids(), standardCamera(geometry, azimuth, elevation, Projection::Perspective));
    };
    CHECK(shownFrom(0, 0) < 0.01); // four voxels of 0.9 let 0.0001 through
    CHECK(shownFrom(180, 0) > 0.5);
    // From the side both lie free, side by side: the fourth root of the part that they cover, some 40 by 4 and 10 by 10
    // of a picture that the box, 48 wide, fills by 0.94.
    const double covered = (40 * 4 + 10 * 10) * std::pow(0.94 / 48, 2);
    CHECK(shownFrom(90, 0) == Approx(std::pow(covered, 0.25)).epsilon(0.1));
}

TEST_CASE("a volume opens from where the feature that is seen least is seen most", "[opening view]") {
    const auto volume = plateBeforeBlock();
    const Camera camera = openingView(*volume, twoSolids(), {}).camera;
    CHECK(shownLeast(*volume, twoSolids(), usual(*volume)) < 0.05); // the block is hidden
    CHECK(-camera.forward().y > 0.1);                               // from behind the plate it is in front
    CHECK(shownLeast(*volume, twoSolids(), camera) > 0.5);
    // Upright by the third axis, and one of 26 directions: multiples of 45° round the axis.
    CHECK(camera.trueUp().z > 0);
    const double azimuth = viewAngles(camera, volume->geometry()).azimuth;
    CHECK(std::abs(std::remainder(azimuth, 45)) < 1e-6);
    CHECK_NOTHROW(camera.validate(volume->geometry(), "test"));
}

TEST_CASE("a patient is seen from the usual direction, whatever hides what", "[opening view]") {
    const auto volume = plateBeforeBlock(WorldAxes::Patient);
    const Camera camera = openingView(*volume, twoSolids(), {}).camera;
    CHECK(glm::length(camera.forward() - usual(*volume).forward()) < 1e-9);
}

TEST_CASE("what looks alike from everywhere opens from the usual direction", "[opening view]") {
    const auto balls = volumeFrom(geometryOf(Int3(40)), [](int i, int j, int k) {
        const double r = glm::length(Vec3(i, j, k) - 19.5);
        return r < 8 ? 0.8 : r < 16 ? 0.2 : 0.5;
    });
    CHECK(glm::length(openingView(*balls, twoSolids(0.05), {}).camera.forward() - usual(*balls).forward()) < 1e-9);
    // Neither is a choice made where nothing is drawn.
    const auto nothing = slab(Int3(8), 0.5);
    CHECK(glm::length(openingView(*nothing, twoSolids(), {}).camera.eye - usual(*nothing).eye) < 1e-6);
}

TEST_CASE("the same view for any number of threads, and none where it is stopped", "[opening view]") {
    const auto volume = plateBeforeBlock();
    setThreadCount(1);
    const Camera one = openingView(*volume, twoSolids(), {}).camera;
    setThreadCount(5);
    const Camera five = openingView(*volume, twoSolids(), {}).camera;
    setThreadCount(0);
    CHECK(one == five);
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(openingView(*volume, twoSolids(), {}, {stop.get_token(), {}}), Cancelled);
}
