#include <catch2/catch.hpp>

#include "saliency/vws.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("VWS weighs the shares of both attributes", "[vws]") {
    FeatureSums sums;
    sums.visibility = {1, 3};
    sums.allVisibility = 5; // 1 belongs to no feature
    sums.weighted = {{{2, 6}, {1, 0}}};
    sums.allWeighted = {10, 4};
    const auto m = featureMeasures(sums, {0.25, 0.75});
    CHECK(m[0].visibility == Approx(0.2));
    CHECK(m[1].visibility == Approx(0.6));
    CHECK(m[0].vwsBrightness == Approx(0.2));
    CHECK(m[0].vwsSaturation == Approx(0.25));
    CHECK(m[0].vws == Approx(0.25 * 0.2 + 0.75 * 0.25));
    CHECK(m[1].vws == Approx(0.25 * 0.6));
}

TEST_CASE("an attribute that is nowhere salient leaves its weight to the other", "[vws]") {
    FeatureSums sums;
    sums.visibility = {1, 1};
    sums.allVisibility = 2;
    sums.weighted = {{{1, 3}, {0, 0}}};
    sums.allWeighted = {4, 0};
    CHECK(vwsOf(sums)[1] == Approx(0.75));
    sums.weighted = {{{0, 0}, {1, 3}}};
    sums.allWeighted = {0, 4};
    CHECK(vwsOf(sums)[1] == Approx(0.75));
    sums.weighted = {{{0, 0}, {0, 0}}};
    sums.allWeighted = {0, 0};
    CHECK(vwsOf(sums)[1] == 0);
    sums.allVisibility = 0;
    CHECK(featureMeasures(sums)[0].visibility == 0);
}

TEST_CASE("sums of a stored field go to the features of their intensities", "[vws]") {
    // Intensities 0, ¼, ½, ¾, 1 along x; features [0,½) and [½,1]; visibility 1, 2, 3, 4, 5; saliency ½ everywhere.
    const auto volume = volumeFrom(geometryOf({5, 1, 1}), [](int i, int, int) { return i / 4.0; });
    const std::vector<Feature> features{{"low", 0, 0.5, {}, {}}, {"high", 0.5, 1, {}, {}}};
    Grid<float> visibility({5, 1, 1}, std::vector<float>{1, 2, 3, 4, 5});
    WeightFields weights({5, 1, 1}, 65535 / 65536.0, 65535 / 65536.0); // units of 2^-16: ½ and ¼ are exact
    for (std::size_t i = 0; i < 5; ++i) weights.set(i, 0.5f, 0.25f);
    const FeatureSums sums = sumsOfField(*volume, features, visibility, &weights);
    CHECK(sums.visibility == std::vector<double>{3, 12});
    CHECK(sums.weighted[0] == std::vector<double>{1.5, 6});
    CHECK(sums.weighted[1] == std::vector<double>{0.75, 3});
    CHECK(sums.allVisibility == 15);
    const auto histogram = visibilityHistogram(*volume, visibility, 4);
    CHECK(histogram == std::vector<double>{1 / 15.0, 2 / 15.0, 3 / 15.0, 9 / 15.0}); // the last bin is closed
}
