#include <catch2/catch.hpp>

#include "optimize/measure.h"
#include "support/field_sums.h"
#include "support/random_cases.h"
#include "support/volumes.h"
#include "volume/intensity_grid.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("measure() divides visibility by feature and by intensity", "[measure]") {
    // Intensities 0, ¼, ½, ¾, 1 side by side, each with opacity 0.3 and nothing in front of it: v = 0.3 five times.
    const auto volume = volumeFrom(geometryOf({5, 1, 1}), [](int i, int, int) { return i / 4.0; });
    TransferFunction tf = homogeneous(0.3);
    tf.features = {{"low", 0, 0.5, {1, 0, 0}, {}}, {"high", 0.6, 1, {0, 0, 1}, {}}}; // ½ is in none
    const WeightFields weights(volume->dims(), 1, 1);
    for (const auto& engine : {makeReferenceEngine(volume), makeCpuEngine(volume)}) {
        const Measures m = measure(*engine, lookingAlong(volume->geometry(), {0, 1, 0}), tf, weights);
        REQUIRE(m.features.size() == 2);
        CHECK(m.features[0].visibility == Approx(0.4));
        CHECK(m.features[1].visibility == Approx(0.4));
        CHECK(m.features[0].vws == 0); // nothing is salient
        CHECK(m.opacities == std::vector<double>{0.3, 0.3});
        REQUIRE(m.visibilityHistogram.size() == 256);
        double sum = 0;
        for (const int bin : {0, 64, 128, 192, 255}) { // the last one is closed
            CHECK(m.visibilityHistogram[static_cast<std::size_t>(bin)] == Approx(0.2));
            sum += m.visibilityHistogram[static_cast<std::size_t>(bin)];
        }
        CHECK(sum == Approx(1));
    }
}

TEST_CASE("measure() finds in one sweep what the visibility field holds", "[measure]") {
    for (std::uint32_t n = 0; n < 10; ++n) {
        const RandomCase c = randomCase(n);
        INFO(c.describe());
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const auto engine = makeCpuEngine(c.volume);
        const Measures m = measure(*engine, c.camera, c.tf, weights);
        const Grid<float> field = engine->field(c.camera, c.tf).values;
        const auto expected = featureMeasures(sumsOfField(*c.volume, c.tf.features, field, &weights));
        const auto histogram = histogramOfField(*c.volume, field, 256);
        // Floats are rounded to codes, which takes a few voxels over a border of features or bins.
        const double margin = IntensityCoder(*c.volume).exact() ? 1e-6 : 1e-3;
        REQUIRE(m.features.size() == expected.size());
        for (std::size_t f = 0; f < expected.size(); ++f) {
            CHECK(m.features[f].visibility == Approx(expected[f].visibility).margin(margin));
            CHECK(m.features[f].vwsBrightness == Approx(expected[f].vwsBrightness).margin(margin));
            CHECK(m.features[f].vws == Approx(expected[f].vws).margin(margin));
        }
        for (std::size_t bin = 0; bin < 256; ++bin)
            CHECK(m.visibilityHistogram[bin] == Approx(histogram[bin]).margin(margin));
    }
}
