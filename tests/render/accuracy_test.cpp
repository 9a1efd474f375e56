// MEASURES §10 on random cases: every kind of volume, camera and transfer function that support/random_cases.h draws.
#include <catch2/catch.hpp>

#include "support/accuracy_check.h"
#include "support/engine_checks.h"
#include "volume/procedural.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("the cpu engine keeps the tolerances of MEASURES on 50 random cases", "[visibility][cpu][accuracy]") {
    checkRandomCases([](auto volume, Quality quality) { return makeCpuEngine(volume, quality); }, 50);
}

TEST_CASE("in volumes too large to follow every line alone the cpu engine keeps the tolerances too",
          "[visibility][cpu][accuracy]") {
    // Above the 128³ voxels from which on all is left to the rays.
    const auto volume = std::make_shared<const Volume>(makeSample("knee", 165));
    REQUIRE(volume->size() > 128 * 128 * 128);
    const TransferFunction tf = tents(3, 0.3);
    const WeightFields weights = saliencyFields(*volume, tf);
    const auto reference = makeReferenceEngine(volume);
    for (const auto& [azimuth, projection] :
         {std::pair{30.0, Projection::Perspective}, std::pair{45.0, Projection::Orthographic}}) {
        const Camera camera = cameraFromView(volume->geometry(), azimuth, 20, 1, projection);
        const Disagreement d = compare(*reference, *makeCpuEngine(volume), camera, tf, weights);
        CHECK(d.visibilityRms < 0.015);
        CHECK(d.visibility < 0.01);
        CHECK(d.vws < 0.01);
    }
}

TEST_CASE("random cases are what they promise", "[visibility][accuracy]") {
    // Measurable, and no measure is trivial in most: more than one feature with a share of what is seen.
    int telling = 0;
    for (std::uint32_t n = 0; n < 50; ++n) {
        const RandomCase c = randomCase(n), again = randomCase(n);
        INFO(c.describe());
        CHECK(c.describe() == again.describe());
        CHECK(c.camera == again.camera);
        CHECK(c.tf == again.tf);
        const auto& opacities = featureOpacities(c.tf);
        REQUIRE(!opacities.empty());
        CHECK(opacities.size() <= 5);
        for (int a = 0; a < 3; ++a) {
            CHECK(c.volume->dims()[a] >= 12);
            CHECK(c.volume->dims()[a] <= 48);
        }
        const auto measures = featureMeasures(makeCpuEngine(c.volume)->sums(c.camera, {&c.tf, 1}, nullptr)[0]);
        int shown = 0;
        for (const FeatureMeasures& m : measures) shown += m.visibility > 0.02;
        CHECK(std::any_of(measures.begin(), measures.end(), [](const auto& m) { return m.visibility > 0; }));
        telling += shown > 1;
    }
    CHECK(telling >= 35);
}
