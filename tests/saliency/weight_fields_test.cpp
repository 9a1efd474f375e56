#include <catch2/catch.hpp>

#include <cmath>

#include "saliency/weight_fields.h"

using namespace pellucid;

TEST_CASE("weights come back as they were stored, but for half a unit", "[weights]") {
    WeightFields weights({4, 3, 2}, 1.0, 1.34);
    CHECK(weights.dims() == Int3(4, 3, 2));
    CHECK(weights.size() == 24);
    for (std::size_t i = 0; i < 24; ++i) {
        CHECK(weights.brightness(i) == 0);
        CHECK(weights.saturation(i) == 0);
    }
    for (std::size_t i = 0; i < 24; ++i)
        weights.set(i, static_cast<float>(i) / 23, 1.34f * (1 - static_cast<float>(i) / 23));
    for (std::size_t i = 0; i < 24; ++i) {
        CHECK(weights.brightness(i) == Approx(static_cast<double>(i) / 23).margin(0.5 / 65535 + 1e-7));
        CHECK(weights.at(1, i) == Approx(1.34 * (1 - static_cast<double>(i) / 23)).margin(0.5 * 1.34 / 65535 + 1e-7));
    }
    CHECK(gridOf(weights, 1).at(3, 2, 1) == weights.saturation(23));
}

TEST_CASE("a packed weight has brightness in its low half, in units of the scale", "[weights]") {
    WeightFields weights({2, 1, 1}, 65535.0, 65535.0 * 2);
    CHECK(weights.scale(0) == 1);
    CHECK(weights.scale(1) == 2);
    weights.set(1, 3.4f, 10.9f); // 3 units; 5.45 units of 2, so 5
    CHECK(weights.data()[0] == 0);
    CHECK(weights.data()[1] == (5u << 16 | 3u));
    CHECK(weights.brightness(1) == 3);
    CHECK(weights.saturation(1) == 10);
}

TEST_CASE("weights out of range are clamped, where nothing can be stored they are 0", "[weights]") {
    WeightFields weights({1, 1, 1}, 1.0, 0.0);
    weights.set(0, 2.0f, 1.0f);
    CHECK(weights.brightness(0) == Approx(1.0));
    CHECK(weights.saturation(0) == 0);
    weights.set(0, -1.0f, std::nanf(""));
    CHECK(weights.data()[0] == 0);
}

TEST_CASE("no weights are empty", "[weights]") {
    const WeightFields none;
    CHECK(none.empty());
    CHECK(none.dims() == Int3(0, 0, 0));
    WeightFields some({1, 2, 3}, 1, 1), same({1, 2, 3}, 1, 1);
    CHECK(some == same);
    same.set(2, 0.5f, 0);
    CHECK_FALSE(some == same);
}
