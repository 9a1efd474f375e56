#include <catch2/catch.hpp>

#include "base/color.h"
#include "base/error.h"

using namespace pellucid;

TEST_CASE("hues meet the corners of the RGB cube", "[color]") {
    CHECK(hexFromRgb(rgbFromHsv(0, 1, 1)) == "#ff0000");
    CHECK(hexFromRgb(rgbFromHsv(60, 1, 1)) == "#ffff00");
    CHECK(hexFromRgb(rgbFromHsv(180, 1, 1)) == "#00ffff");
    CHECK(hexFromRgb(rgbFromHsv(300, 1, 1)) == "#ff00ff");
    CHECK(hexFromRgb(rgbFromHsv(-60, 1, 1)) == "#ff00ff");   // hues wrap
    CHECK(hexFromRgb(rgbFromHsv(123, 0, 0.5)) == "#808080"); // 0.5·255 = 127.5 rounds up
}

TEST_CASE("HSV and RGB undo each other", "[color]") {
    for (double hue = 0; hue < 360; hue += 37) {
        const Hsv back = hsvFromRgb(rgbFromHsv(hue, 0.6, 0.8));
        CHECK(back.hueDegrees == Approx(hue).margin(1e-9));
        CHECK(back.saturation == Approx(0.6));
        CHECK(back.value == Approx(0.8));
    }
    CHECK(hsvFromRgb({0, 0, 0}).saturation == 0);
}

TEST_CASE("hex colours are read in both lengths and nothing else", "[color]") {
    CHECK(rgbFromHex("#fff") == Rgb{1, 1, 1});
    CHECK(rgbFromHex("#00FF00") == Rgb{0, 1, 0});
    for (const char* bad : {"", "#", "red", "#12345", "#1234567", "123456", "#gg0000", "#-10000"})
        CHECK_THROWS_AS(rgbFromHex(bad), Error);
}
