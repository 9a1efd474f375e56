// Colours that all eyes can tell apart.
#include "tf/palette.h"

#include <array>
#include <cmath>

#include <catch2/catch.hpp>

using namespace pellucid;

namespace {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

Triple times(const Matrix& m, const Triple& v) {
    Triple r{};
    for (std::size_t i = 0; i < 3; ++i) r[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return r;
}

// Machado, Oliveira and Fernandes 2009, severity 1, linear sRGB.
constexpr Matrix kNormal{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr Matrix kProtanopia{
    {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}};
constexpr Matrix kDeuteranopia{
    {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}};

/// CIELAB (D65) of a colour as such eyes see it.
Triple labOf(const Rgb& c, const Matrix& eyes) {
    const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
    Triple seen = times(eyes, {linear(c.r), linear(c.g), linear(c.b)});
    for (double& v : seen) v = std::clamp(v, 0.0, 1.0);
    const Matrix xyz{
        {{0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}}};
    Triple f = times(xyz, seen);
    const Triple white{0.95047, 1, 1.08883};
    for (std::size_t i = 0; i < 3; ++i) {
        const double t = f[i] / white[i];
        f[i] = t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
    }
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

double distance(const Rgb& a, const Rgb& b, const Matrix& eyes) {
    const Triple p = labOf(a, eyes), q = labOf(b, eyes);
    return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

void checkNeighbours(const std::vector<Rgb>& colors) {
    for (std::size_t i = 0; i + 1 < colors.size(); ++i)
        for (const Matrix& eyes : {kNormal, kProtanopia, kDeuteranopia}) {
            INFO(hexFromRgb(colors[i]) << " and " << hexFromRgb(colors[i + 1]));
            CHECK(distance(colors[i], colors[i + 1], eyes) >= kLeastNeighbourDistance);
        }
}

} // namespace

TEST_CASE("the distances of this test are those of CIELAB", "[palette]") {
    CHECK(distance({0, 0, 0}, {1, 1, 1}, kNormal) == Approx(100).margin(0.01));
    CHECK(labOf({1, 0, 0}, kNormal)[0] == Approx(53.24).margin(0.01));
    CHECK(labOf({1, 0, 0}, kNormal)[1] == Approx(80.09).margin(0.02));
    // Pure red and a dark green, of which deuteranopes see little difference.
    CHECK(distance({0.8, 0.2, 0}, {0.4, 0.5, 0}, kDeuteranopia) < kLeastNeighbourDistance);
}

TEST_CASE("neighbouring colours differ for all eyes", "[palette]") {
    for (int n = 1; n <= 12; ++n) {
        const std::vector<Rgb> colors = classColors(n);
        REQUIRE(colors.size() == static_cast<std::size_t>(n));
        checkNeighbours(colors);
    }
    checkNeighbours(divergingColors());
    const TissueColors t = tissueColors();
    checkNeighbours({t.lung, t.fat, t.soft, t.bone, t.dense});
}

TEST_CASE("of up to five classes the highest is the lightest, and all show on black", "[palette]") {
    for (int n = 1; n <= 5; ++n) {
        const std::vector<Rgb> colors = classColors(n);
        for (const Rgb& c : colors) {
            CHECK(labOf(c, kNormal)[0] >= 50);
            CHECK(labOf(c, kNormal)[0] <= labOf(colors.back(), kNormal)[0]);
        }
    }
}
