// Ways between two colours, against VTK 9.1 (vtkColorTransferFunction).
#include <catch2/catch.hpp>

#include <array>

#include "tf/color_spaces.h"

using namespace pellucid;

namespace {

// The ends of ParaView's "Cool to Warm".
const Rgb kCool{0.23137254902, 0.298039215686, 0.752941176471}, kWarm{0.705882352941, 0.0156862745098, 0.149019607843};

struct Golden {
    ColorSpace space;
    std::array<Rgb, 3> at; ///< t = 0.25, 0.5, 0.75
    double margin;
};

} // namespace

TEST_CASE("colours between two colours are those of VTK", "[tf][colorspace]") {
    const Golden all[] = {
        {ColorSpace::Rgb, {{{.3500, .2275, .6020}, {.4686, .1569, .4510}, {.5873, .0863, .3000}}}, 1e-4},
        {ColorSpace::HsvWrapped, {{{.3764, .1749, .7412}, {.6316, .1202, .7294}, {.7176, .0671, .5074}}}, 1e-4},
        {ColorSpace::Hsv, {{{.3764, .1749, .7412}, {.6316, .1202, .7294}, {.7176, .0671, .5074}}}, 1e-4},
        {ColorSpace::Lab, {{{.4668, .2531, .5952}, {.5807, .2025, .4430}, {.6539, .1386, .2960}}}, 1e-3},
        {ColorSpace::Diverging, {{{.5533, .6886, .9952}, {.8654, .8654, .8654}, {.9584, .6031, .4817}}}, 1e-3},
        // VTK rounds to 8 bits on this way, and begins at the next of 17 steps of each part.
        {ColorSpace::Ciede2000, {{{.4314, .3137, .5686}, {.5490, .3137, .4549}, {.6745, .2039, .3255}}}, 0.012},
        {ColorSpace::Step, {{kWarm, kWarm, kWarm}}, 1e-12}};
    for (const Golden& golden : all) {
        const ColorWay way(kCool, kWarm, golden.space);
        for (std::size_t i = 0; i < 3; ++i) {
            const Rgb c = way.at(0.25 * static_cast<double>(i + 1));
            INFO(static_cast<int>(golden.space) << " at " << 0.25 * static_cast<double>(i + 1));
            CHECK(c.r == Approx(golden.at[i].r).margin(golden.margin));
            CHECK(c.g == Approx(golden.at[i].g).margin(golden.margin));
            CHECK(c.b == Approx(golden.at[i].b).margin(golden.margin));
        }
        CHECK(way.at(0) == kCool);
        CHECK(way.at(1) == kWarm);
    }
}

TEST_CASE("hue goes the shorter way round where it wraps", "[tf][colorspace]") {
    // From hue 0.05 to 0.9: half way lies 0.975 round the circle, and 0.475 along the numbers.
    const Rgb from = rgbFromHsv(0.05 * 360, 1, 1), to = rgbFromHsv(0.9 * 360, 1, 1);
    const Rgb wrapped = ColorWay(from, to, ColorSpace::HsvWrapped).at(0.5),
              straight = ColorWay(from, to, ColorSpace::Hsv).at(0.5);
    CHECK(wrapped.r == Approx(1));
    CHECK(wrapped.g == Approx(0).margin(1e-12));
    CHECK(wrapped.b == Approx(0.15));
    CHECK(straight.r == Approx(0).margin(1e-12));
    CHECK(straight.g == Approx(1));
    CHECK(straight.b == Approx(0.85));
}

TEST_CASE("greys stay grey in every space", "[tf][colorspace]") {
    for (const ColorSpace space : {ColorSpace::Rgb, ColorSpace::Hsv, ColorSpace::HsvWrapped, ColorSpace::Lab,
                                   ColorSpace::Diverging, ColorSpace::Ciede2000, ColorSpace::ProLab}) {
        INFO(static_cast<int>(space));
        const ColorWay way({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}, space);
        for (const double t : {0.1, 0.5, 0.9}) {
            const Rgb c = way.at(t);
            CHECK(c.r == Approx(c.g).margin(2e-3));
            CHECK(c.g == Approx(c.b).margin(2e-3));
            CHECK((c.r > 0.2 && c.r < 0.8));
        }
        CHECK(way.at(0.25).r < way.at(0.75).r);
    }
}

TEST_CASE("proLab's lightness rises evenly between black and white", "[tf][colorspace]") {
    // Of white it is Q/(q·(1,1,1) + 1) = 729.59/(6.2959 + 1) = 100, so that half way there it is 50: the grey of
    // luminance Y with 729.59·Y/(6.2959·Y + 1) = 50, Y = 50/(729.59 − 314.795) = 0.12054, sRGB 0.3818.
    CHECK(ColorWay({0, 0, 0}, {1, 1, 1}, ColorSpace::ProLab).at(0.5).g == Approx(0.3818).margin(2e-3));
}

TEST_CASE("CIEDE2000 has the values of Sharma's table", "[tf][colorspace]") {
    // Rows 1, 7, 17 and 25 of the test data of Sharma, Wu, Dalal 2005.
    CHECK(ciede2000({50, 2.6772, -79.7751}, {50, 0, -82.7485}) == Approx(2.0425).margin(1e-4));
    CHECK(ciede2000({50, 0, 0}, {50, -1, 2}) == Approx(2.3669).margin(1e-4));
    CHECK(ciede2000({50, 2.5, 0}, {73, 25, -18}) == Approx(27.1492).margin(1e-4));
    CHECK(ciede2000({60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}) == Approx(1.2644).margin(1e-4));
}
