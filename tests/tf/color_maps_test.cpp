#include <catch2/catch.hpp>

#include "base/error.h"
#include "support/random_tfs.h"
#include "tf/color_maps.h"
#include "tf/lch.h"

using namespace pellucid;
using test::mostDifference;

TEST_CASE("CIELCh goes to sRGB and back", "[colormaps]") {
    test::Random random(5);
    for (int i = 0; i < 300; ++i) {
        const Rgb color{random.unit(), random.unit(), random.unit()};
        CHECK(colorDifference(srgbFromLch(lchFromSrgb(color)), color) < 1e-3);
    }
    // What sRGB does not have gives way in chroma alone.
    const Lch nearest = lchFromSrgb(srgbFromLch({60, 150, 200}));
    CHECK(nearest.lightness == Approx(60).margin(0.01));
    CHECK(nearest.hueDegrees == Approx(200).margin(0.1));
    CHECK(nearest.chroma < 60);
    CHECK(colorDifference(srgbFromLch({100, 0, 0}), {1, 1, 1}) < 1e-3);
}

TEST_CASE("sequential maps grow evenly lighter, diverging ones mirror their lightness", "[colormaps]") {
    for (const ColorMap& map : colorMaps()) {
        INFO(map.name);
        const auto lightness = [&](double t) { return lchFromSrgb(colorOf(map, t)).lightness; };
        if (map.kind == ColorMap::Kind::Sequential) {
            const double step = (lightness(1) - lightness(0)) / 64;
            CHECK(step > 1); // more than 64 of the 100 of L*
            for (int i = 0; i < 64; ++i)
                CHECK(lightness((i + 1) / 64.0) - lightness(i / 64.0) == Approx(step).margin(0.02));
        }
        if (map.kind == ColorMap::Kind::Diverging)
            for (int i = 0; i <= 32; ++i) CHECK(lightness(i / 64.0) == Approx(lightness(1 - i / 64.0)).margin(0.02));
        if (map.kind != ColorMap::Kind::Categorical) // no jumps: at most 6 ΔE in 1/64
            for (int i = 0; i < 64; ++i)
                CHECK(colorDifference(colorOf(map, i / 64.0), colorOf(map, (i + 1) / 64.0)) <
                      (map.kind == ColorMap::Kind::Hue ? 25 : 6));
    }
    CHECK(colorOf(colorMapNamed("hue"), 0.5) == rgbFromHsv(180, 1, 1));
    CHECK_THROWS_WITH(colorMapNamed("jet"), Catch::Contains("spiral"));
}

TEST_CASE("the colours of categories are told apart", "[colormaps]") {
    const ColorMap& map = colorMapNamed("categorical");
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < i; ++j)
            CHECK(colorDifference(colorOf(map, (i + 0.5) / 8), colorOf(map, (j + 0.5) / 8)) > 20);
    std::vector<Rgb> present;
    for (int i = 0; i < 8; ++i) {
        const Rgb next = colorApartFrom(present);
        for (const Rgb& other : present) CHECK(colorDifference(next, other) > 20);
        present.push_back(next);
    }
}

TEST_CASE("a map colours points by their intensity and leaves the opacities", "[colormaps]") {
    test::Random random(9);
    for (const ColorMap& map : colorMaps()) {
        INFO(map.name);
        for (int round = 0; round < 12; ++round) {
            const TransferFunction tf = test::randomTf(random);
            ColorMapOptions options;
            options.reversed = random.chance(0.5);
            options.inverted = random.chance(0.3);
            const TransferFunction colored = withColorMap(tf, map, options);
            REQUIRE_NOTHROW(colored.validate());
            REQUIRE(mostDifference(colored, tf) < 1e-12);
            if (map.kind == ColorMap::Kind::Categorical) continue;
            // Where it is not transparent it is in the map's colours; between the places that are tried, of steps of
            // 1/768, ΔE can rise a little above its limit.
            for (int i = 0; i <= 500; ++i) {
                const double x = i / 500.0;
                if (tf.points.empty() || x < tf.points.front().x || x > tf.points.back().x) continue;
                if (tf.opacity(x) > 0) REQUIRE(colorDifference(colored.color(x), colorOf(map, x, options)) < 1.5);
            }
        }
    }
    // tents(6) needs few points for a smooth map, and none where it is transparent.
    CHECK(withColorMap(tents(6), colorMapNamed("sand")).points.size() <= 24);
}

TEST_CASE("features take the colour of their highest point", "[colormaps]") {
    const ColorMap& map = colorMapNamed("spiral");
    const TransferFunction colored = withColorMap(tents(3), map);
    for (int i = 0; i < 3; ++i)
        CHECK(colorDifference(colored.features[static_cast<std::size_t>(i)].color, colorOf(map, (i + 0.5) / 3)) < 1e-6);
    // Over features: one colour each, that of the middle of its third, whatever the intensities.
    ColorMapOptions options;
    options.overFeatures = true;
    const TransferFunction each = withColorMap(tents(3), map, options);
    CHECK(each.points.size() == 9);
    for (std::size_t i = 0; i < 9; ++i) {
        const double middle = static_cast<double>(i / 3) / 3 + 1.0 / 6;
        CHECK(colorDifference(each.points[i].color, colorOf(map, middle)) < 1e-6);
        CHECK(each.features[i / 3].color == each.points[i].color);
    }
}

TEST_CASE("colours are reversed and inverted, twice is as before", "[colormaps]") {
    const TransferFunction tf = withColorMap(tents(3), colorMapNamed("sand"));
    const TransferFunction reversed = withColorsReversed(tents(3));
    CHECK(colorDifference(reversed.points[1].color, tents(3).points[7].color) < 1e-9); // the first peak, the last one's
    CHECK(mostDifference(reversed, tents(3)) == 0);
    const TransferFunction dark = withColorsInverted(tf);
    CHECK(lchFromSrgb(dark.points[1].color).lightness ==
          Approx(100 - lchFromSrgb(tf.points[1].color).lightness).margin(0.01));
    for (std::size_t i = 0; i < tf.points.size(); ++i) {
        CHECK(dark.points[i].opacity == tf.points[i].opacity);
        // Chroma comes back where the inverted colour could hold it.
        const Rgb back = withColorsInverted(dark).points[i].color;
        CHECK(lchFromSrgb(back).lightness == Approx(lchFromSrgb(tf.points[i].color).lightness).margin(0.01));
    }
}
