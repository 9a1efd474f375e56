#include <catch2/catch.hpp>

#include "tf/lch.h"

using namespace pellucid;

TEST_CASE("the corners of sRGB have their known CIELCh values under D65", "[lch]") {
    // Published CIELAB of the sRGB primaries: red (53.24, 80.09, 67.20), green (87.73, −86.18, 83.18), blue
    // (32.30, 79.19, −107.86); C* = hypot(a*, b*), h = atan2(b*, a*).
    const Lch red = lchFromSrgb({1, 0, 0}), green = lchFromSrgb({0, 1, 0}), blue = lchFromSrgb({0, 0, 1});
    CHECK(red.lightness == Approx(53.24).margin(0.01));
    CHECK(red.chroma == Approx(104.55).margin(0.02));
    CHECK(red.hueDegrees == Approx(40.0).margin(0.02));
    CHECK(green.lightness == Approx(87.73).margin(0.01));
    CHECK(green.chroma == Approx(119.78).margin(0.02));
    CHECK(blue.lightness == Approx(32.30).margin(0.01));
    CHECK(blue.chroma == Approx(133.81).margin(0.02));
    CHECK(blue.hueDegrees == Approx(306.29).margin(0.02));
}

TEST_CASE("greys have no chroma", "[lch]") {
    for (const double v : {0.0, 0.02, 0.5, 1.0}) CHECK(lchFromSrgb({v, v, v}).chroma == Approx(0).margin(1e-9));
    CHECK(lchFromSrgb({1, 1, 1}).lightness == Approx(100));
    CHECK(lchFromSrgb({0, 0, 0}).lightness == Approx(0).margin(1e-9));
    CHECK(lchFromSrgb({0.5, 0.5, 0.5}).lightness == Approx(53.39).margin(0.01)); // mid grey
}
