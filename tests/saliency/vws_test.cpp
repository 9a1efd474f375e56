#include <catch2/catch.hpp>

#include "saliency/vws.h"

using namespace pellucid;

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
