#include "tf/hsb_colors.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "volume/noise.h"

using namespace pellucid;

namespace {

constexpr Int3 kDims{9, 7, 5};

/// Noise whose values lie in [0, 1] or beyond, seen through the window [0.1, 0.8].
std::shared_ptr<const Volume> channel(std::uint32_t seed, bool holed = false) {
    std::vector<float> values(voxelCount(kDims));
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(0.5 + 0.6 * smoothNoise({0.7 * static_cast<double>(i), 0.3, 0.9}, seed));
    if (holed) values[17] = std::nanf("");
    Geometry g;
    g.dims = kDims;
    return std::make_shared<const Volume>(Volume(g, SampleArray<float>(std::move(values))).withRange({0.1, 0.8}));
}

/// Travis's hexcone, as textbooks have it: sectors of 60 degrees.
std::array<double, 3> rgbFromHsb(double h, double s, double v) {
    h = std::fmod(std::fmod(h, 360) + 360, 360) / 60;
    const int sector = static_cast<int>(h);
    const double f = h - sector, p = v * (1 - s), q = v * (1 - s * f), t = v * (1 - s * (1 - f));
    switch (sector) {
    case 0:
        return {v, t, p};
    case 1:
        return {q, v, p};
    case 2:
        return {p, v, t};
    case 3:
        return {p, q, v};
    case 4:
        return {t, p, v};
    default:
        return {v, p, q};
    }
}

double clip(double v) { return std::min(1.0, std::max(0.0, v)); }

} // namespace

TEST_CASE("colours are those of equation 6.1 to 1/255", "[hsb]") {
    const auto s = channel(1), y = channel(2, true), h = channel(3);
    struct Case {
        bool hasS, hasY, hasH;
        double a, b, from, to;
    };
    for (const Case& c : {Case{true, true, true, 10, 5, 0, 240}, Case{true, true, false, 1, 1, 200, 0},
                          Case{true, false, true, 0.4, 1, -30, 400}, Case{false, true, false, 1, 3.5, 359, 0},
                          Case{false, false, false, 1, 1, 60, 0}, Case{true, true, true, 0, 0, 10, 20}}) {
        const VoxelColors colors = hsbColors(
            {kDims, c.hasS ? s : nullptr, c.hasY ? y : nullptr, c.hasH ? h : nullptr, c.a, c.b, c.from, c.to});
        REQUIRE(colors.rgba.size() == voxelCount(kDims));
        const auto valueOf = [](const Volume& v, std::size_t i) { return v.isValid(i) ? v.intensity(i) : 0.0; };
        for (std::size_t i = 0; i < colors.rgba.size(); ++i) {
            const double saturation = c.hasS ? clip(c.a * valueOf(*s, i)) : 1;
            const double brightness = c.hasY ? 1 - clip(c.b * valueOf(*y, i)) : 1;
            const double hue = c.hasH ? c.from + valueOf(*h, i) * (c.to - c.from) : c.from;
            const auto rgb = rgbFromHsb(hue, saturation, brightness);
            const std::uint32_t packed = colors.rgba[i];
            CHECK((packed >> 24) == 255u);
            for (unsigned channelIndex = 0; channelIndex < 3; ++channelIndex)
                CHECK((packed >> (8 * channelIndex) & 255u) == Approx(255 * rgb[channelIndex]).margin(0.5 + 1e-6));
        }
    }
}

TEST_CASE("the automatic scale makes the strongest twentieth full", "[hsb]") {
    // 1000 voxels: 500 of value 0, then 0.001 … 0.5 in steps of 0.001: the 95th percentile of those above 0 is 0.475.
    std::vector<float> values(1000, 0.0f);
    for (int i = 0; i < 500; ++i) values[static_cast<std::size_t>(i)] = static_cast<float>(0.001 * (i + 1));
    Geometry g;
    g.dims = {10, 10, 10};
    const Volume volume = Volume(g, SampleArray<float>(values)).withRange({0, 1});
    CHECK(automaticScale(volume).value() == Approx(1 / 0.475).epsilon(0.005));
    const Volume nothing = Volume(g, SampleArray<float>(std::vector<float>(1000, 0.0f)));
    CHECK_FALSE(automaticScale(nothing));
}
