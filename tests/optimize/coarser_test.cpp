#include <cmath>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "optimize/coarser.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Shells around the middle of the box, intensities from 0 at its corners to 1.
std::shared_ptr<const Volume> shells(const Int3& dims) {
    const Vec3 middle = 0.5 * Vec3(dims - 1);
    return volumeFrom(geometryOf(dims), [&](int i, int j, int k) {
        return std::clamp(1.1 - glm::length((Vec3(i, j, k) - middle) / Vec3(dims)) * 2, 0.0, 1.0);
    });
}

} // namespace

TEST_CASE("a halved volume has the means, the place and the lengths of the volume", "[optimize][coarser]") {
    const auto volume = volumeFrom(geometryOf({5, 4, 2}), [](int i, int, int) { return i / 4.0; });
    const auto half = halved(*volume);
    CHECK(half->dims() == Int3(3, 2, 1));
    CHECK(half->geometry().spacing == 2.0 * volume->geometry().spacing);
    CHECK(half->geometry().d0() == volume->geometry().d0());
    CHECK(half->range() == volume->range());
    CHECK(half->intensity(0) == Approx(0.125).margin(1e-2)); // of 0 and 1/4
    CHECK(half->intensity(2) == Approx(1));                  // the last one alone
    // The centre of the first one lies between those of the first two.
    CHECK(half->geometry().origin.x == Approx(volume->geometry().origin.x + 0.5 * volume->geometry().spacing.x));
    CHECK(halved(*half)->geometry().d0() == volume->geometry().d0());
    // An axis that is coarse already stays.
    Geometry flat = geometryOf({4, 4, 4});
    flat.spacing = {1, 1, 2};
    const auto kept = halved(*volumeFrom(flat, [](int i, int, int) { return i / 3.0; }));
    CHECK(kept->dims() == Int3(2, 2, 4));
    CHECK(kept->geometry().spacing == Vec3(2, 2, 2));
}

TEST_CASE("weights of a halved volume are means", "[optimize][coarser]") {
    const auto volume = volumeFrom(geometryOf({4, 2, 2}), [](int i, int, int) { return i / 3.0; });
    WeightFields weights({4, 2, 2}, 1, 1);
    for (std::size_t i = 0; i < 16; ++i) weights.set(i, i % 4 < 2 ? 0.25f : 0.5f, i % 2 == 0 ? 0.0f : 1.0f);
    const WeightFields half = halvedWeights(weights, *volume);
    CHECK(half.dims() == Int3(2, 1, 1));
    CHECK(half.brightness(0) == Approx(0.25).margin(1e-4));
    CHECK(half.brightness(1) == Approx(0.5).margin(1e-4));
    CHECK(half.saturation(0) == Approx(0.5).margin(1e-4));
}

TEST_CASE("figures of a halved volume are nearly those of the volume", "[optimize][coarser]") {
    const auto volume = shells({44, 48, 40});
    const auto half = halved(*volume);
    const TransferFunction tf = tents(3);
    const WeightFields weights = saliencyFields(*volume, tf), halfWeights = halvedWeights(weights, *volume);
    const auto cpu = makeCpuEngine(volume), halfCpu = makeCpuEngine(half), halfReference = makeReferenceEngine(half, 4);
    for (const auto& [azimuth, elevation] : {std::pair{30.0, 20.0}, {0.0, 0.0}}) {
        const View view{cameraFromView(volume->geometry(), azimuth, elevation, 1, Projection::Perspective), {}};
        for (const double opacity : {0.01, 0.3, 0.95}) {
            INFO(azimuth << ", " << opacity);
            const std::vector<double> x(3, opacity);
            const auto w = [&](VisibilityEngine& e, const WeightFields& fields) {
                return EngineVws(e, view, tf, fields).evaluate({&x, 1})[0];
            };
            const auto full = w(*cpu, weights), coarse = w(*halfCpu, halfWeights);
            CHECK(objectiveOf(coarse, full) < 0.03);
            // The engines agree on voxels that are larger than d0 as they do on others.
            CHECK(objectiveOf(coarse, w(*halfReference, halfWeights)) < 0.01);
        }
    }
}

TEST_CASE("large volumes have coarser copies, small ones are their own", "[optimize][coarser]") {
    const auto make = [](std::shared_ptr<const Volume> v) { return makeCpuEngine(std::move(v)); };
    const auto small = shells({40, 40, 40});
    const CoarserVolumes itself(small, make);
    REQUIRE(itself.size() == 1);
    CHECK(&itself.volume(0) == small.get());
    const auto volume = shells({128, 128, 136}); // 2.2 million voxels
    const CoarserVolumes one(volume, make);
    REQUIRE(one.size() == 1);
    CHECK(one.volume(0).dims() == Int3(64, 64, 68));
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(CoarserVolumes(volume, make, {stop.get_token(), {}}), Cancelled);
    const WeightFields weights({128, 128, 136}, 1, 1);
    CHECK_THROWS_AS(halvedWeights(weights, *volume, {stop.get_token(), {}}), Cancelled);
}
