// MEASURES §10 on random cases: every kind of volume, camera and transfer function that support/random_cases.h draws.
#include <catch2/catch.hpp>

#include "support/accuracy_check.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("the cpu engine keeps the tolerances of MEASURES on 50 random cases", "[visibility][cpu][accuracy]") {
    checkRandomCases([](auto volume, Quality quality) { return makeCpuEngine(volume, quality); }, 50);
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
