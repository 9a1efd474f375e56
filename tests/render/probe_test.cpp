#include "render/probe.h"

#include <array>
#include <numeric>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "render/image_renderer.h"
#include "support/random_cases.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

double sum(const RayProbe& p) { return std::accumulate(p.shares.begin(), p.shares.end(), p.rest); }

/// The middle pixel of a picture of 9 × 9.
RayProbe probeMiddle(const Volume& volume, const TransferFunction& tf, View view) {
    return probe(volume, tf, view, 4.5, 4.5, 9, 9);
}

} // namespace

TEST_CASE("shares of slabs one behind the other are known", "[probe]") {
    // Along y: 4 planes of intensity 1/6 with α = 0.2 (feature 1 of three tents), 6 of 5/6 with the same (feature 3).
    // Between centres the intensity crosses features in no length to speak of: the border is sharp at 1000 : 1.
    const auto volume =
        volumeFrom(geometryOf({5, 2000, 5}, {1, 0.01, 1}), [](int, int j, int) { return j < 800 ? 1.0 / 6 : 5.0 / 6; });
    // d0 is 0.01: α = 1 − 0.8^0.01 of a plane makes 0.2 of 100 planes.
    const TransferFunction tf = tents(3, 1 - std::pow(0.8, 0.01));
    const RayProbe p = probeMiddle(*volume, tf, lookingAlong(volume->geometry(), {0, 1, 0}));
    REQUIRE(p.hit);
    // 1 − 0.8^8, then 0.8^8·(1 − 0.8^12); the crossing of one plane adds less than 0.003.
    CHECK(p.shares[0] == Approx(1 - std::pow(0.8, 8)).margin(0.003));
    CHECK(p.shares[2] == Approx(std::pow(0.8, 8) * (1 - std::pow(0.8, 12))).margin(0.003));
    CHECK(p.alpha == Approx(1 - std::pow(0.8, 20)).margin(0.003));
    CHECK(sum(p) == Approx(p.alpha).margin(1e-12));
    CHECK(p.feature == 0);
    CHECK(p.intensity == Approx(1.0 / 6).margin(1e-6));
    CHECK(glm::length(p.entry - Vec3(2, -0.005, 2)) < 1e-9);
    CHECK(glm::length(p.exit - Vec3(2, 19.995, 2)) < 1e-9);
    CHECK(glm::length(p.position - p.entry) < 0.01); // nothing hides the first plane
    REQUIRE(p.runs.size() >= 2);
    CHECK(p.runs.front().feature == 0);
    CHECK(p.runs.front().begin == 0);
    CHECK(p.runs.front().opticalDepth == Approx(-8 * std::log(0.8)).epsilon(0.002));
    CHECK(p.runs.back().feature == 2);
    CHECK(p.runs.back().end == Approx(20));
    for (std::size_t i = 1; i < p.runs.size(); ++i) CHECK(p.runs[i].begin == p.runs[i - 1].end);
    CHECK(p.samples.front().t == 0);
    CHECK(p.samples.front().opacity == 0);
    CHECK(p.samples.back().t == Approx(20));
    CHECK(p.samples.back().opacity == p.alpha);
    for (const ProbeSample& s : p.samples)
        if (s.t < 7.9) {
            CHECK(s.intensity == Approx(1.0 / 6).margin(1e-6));
            CHECK(s.opacity == Approx(1 - std::pow(0.8, s.t)).margin(1e-6));
        }
    // Drawn alone, the second is what the first would hide.
    const RayProbe alone = probe(*volume, tf, lookingAlong(volume->geometry(), {0, 1, 0}), 4.5, 4.5, 9, 9, 2);
    CHECK(alone.alpha == Approx(1 - std::pow(0.8, 12)).margin(0.003));
    CHECK(alone.shares[0] == 0);
    CHECK(alone.feature == 2);
}

TEST_CASE("a ramp of intensities is cut where the transfer function and its features have their borders", "[probe]") {
    // One voxel to the next goes from 0 to 1, so that every border lies within one cell. τ over s of a tent with the
    // peak p at c and half width h: ∫ = 2h/p·(p + (1 − p)·ln(1 − p)), twice the integral of −ln(1 − α) over one side.
    const auto volume = volumeFrom(geometryOf({3, 2, 3}), [](int, int j, int) { return static_cast<double>(j); });
    const double peak = 0.9;
    const TransferFunction tf = tents(4, peak);
    const double depth = 2 * 0.1 / peak * (peak + (1 - peak) * std::log(1 - peak));
    const RayProbe p = probeMiddle(*volume, tf, lookingAlong(volume->geometry(), {0, 1, 0}));
    for (int f = 0; f < 4; ++f)
        CHECK(p.shares[static_cast<std::size_t>(f)] ==
              Approx(std::exp(-f * depth) * (1 - std::exp(-depth))).margin(1e-4));
    CHECK(p.rest == 0);
    // The same seen from the other side.
    const RayProbe back = probeMiddle(*volume, tf, lookingAlong(volume->geometry(), {0, -1, 0}));
    CHECK(back.shares[3] == Approx(p.shares[0]).margin(1e-9));
    CHECK(back.alpha == Approx(p.alpha).margin(1e-12));
}

TEST_CASE("both sides of a step count for their own part, and what is in no feature for the rest", "[probe]") {
    const auto volume = volumeFrom(geometryOf({3, 2, 3}), [](int, int j, int) { return static_cast<double>(j); });
    TransferFunction tf;
    tf.points = {{0, 0.1, {1, 0, 0}, false, {}},
                 {0.3, 0.1, {1, 0, 0}, false, {}},
                 {0.3, 0.5, {0, 1, 0}, false, {}},
                 {1, 0.5, {0, 1, 0}, false, {}}};
    tf.features = {{"low", 0, 0.3, {1, 0, 0}, {}}};
    const RayProbe p = probeMiddle(*volume, tf, lookingAlong(volume->geometry(), {0, 1, 0}));
    // The half voxels beyond the centres have s = 0 and 1: 0.5 + 0.3 voxels of 0.1, then 0.7 + 0.5 of 0.5.
    CHECK(p.shares[0] == Approx(1 - std::pow(0.9, 0.8)).margin(1e-9));
    CHECK(p.rest == Approx(std::pow(0.9, 0.8) * (1 - std::pow(0.5, 1.2))).margin(1e-9));
    CHECK(p.color.r == Approx(p.shares[0] / p.alpha).margin(1e-9));
    CHECK(p.color.g == Approx(p.rest / p.alpha).margin(1e-9));
}

TEST_CASE("what is faint is in no feature", "[probe]") {
    // Along y 10 planes of α = 0.2, all in one feature; of the first four 0.25 of the optical depth counts.
    const auto volume = slab({5, 10, 5}, 0.5);
    View view(lookingAlong(volume->geometry(), {0, 1, 0}));
    view.clipping.rest = {{{0, 0.4, 0}, {1, 1, 1}, {}}, 0.25};
    const RayProbe p = probeMiddle(*volume, homogeneous(0.2), view);
    CHECK(p.rest == Approx(1 - 0.8).margin(1e-3)); // (1 − 0.2)^(4 · 0.25)
    CHECK(p.shares[0] == Approx(0.8 * (1 - std::pow(0.8, 6))).margin(1e-3));
    CHECK(p.alpha == Approx(1 - std::pow(0.8, 7)).margin(1e-3));
    CHECK(glm::length(p.exit - p.entry) == Approx(10));
    REQUIRE(p.runs.size() == 2);
    CHECK(p.runs[0].feature == -1);
    CHECK(p.runs[0].end == Approx(4).margin(1e-6));
    CHECK(p.runs[1].feature == 0);
    // Left out, it is not on the ray.
    view.clipping.rest.density = 0;
    CHECK(glm::length(probeMiddle(*volume, homogeneous(0.2), view).exit -
                      probeMiddle(*volume, homogeneous(0.2), view).entry) == Approx(6));
}

TEST_CASE("shares and rest make the picture's alpha", "[probe]") {
    // Rays of the cpu renderer read intensities as codes and sum over a table: the two meet within 1/255.
    constexpr int kWidth = 23, kHeight = 17;
    int visible = 0;
    for (std::uint32_t number = 0; number < 30; ++number) {
        const RandomCase c = randomCase(number, 0.6, {number % 3 == 1, number % 2 == 1, number % 4 == 3});
        INFO(c.describe());
        RenderSettings settings;
        settings.width = kWidth, settings.height = kHeight;
        settings.background = {};
        settings.stepInD0 = 1.0 / 64;
        settings.clipping = c.clipping;
        const Image image = makeCpuRenderer(c.volume)->render(c.camera, c.tf, settings);
        for (int y = 1; y < kHeight; y += 3)
            for (int x = 1; x < kWidth; x += 3) {
                const RayProbe p = probe(*c.volume, c.tf, c.view(), x + 0.5, y + 0.5, kWidth, kHeight);
                const float* pixel = image.pixel(x, y);
                INFO("pixel " << x << ", " << y);
                CHECK(std::abs(sum(p) - static_cast<double>(pixel[3])) < 1.0 / 255);
                CHECK(sum(p) == Approx(p.alpha).margin(1e-12));
                CHECK(p.hit == !p.samples.empty());
                if (p.alpha == 0) continue;
                ++visible;
                const double red = p.color.r * p.alpha - static_cast<double>(pixel[0] * pixel[3]);
                CHECK(std::abs(red) < 2.0 / 255);
                CHECK(glm::length(p.position - p.at(p.t)) < 1e-9);
            }
    }
    CHECK(visible > 300);
}

TEST_CASE("a ray that meets nothing says so", "[probe]") {
    const auto volume = slab({5, 5, 5}, 0.5);
    Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    camera.height = 100;
    const RayProbe beside = probe(*volume, tents(3), camera, 0.5, 0.5, 9, 9);
    CHECK_FALSE(beside.hit);
    CHECK(beside.alpha == 0);
    CHECK(beside.feature == -1);
    CHECK(beside.shares == std::vector<double>(3, 0.0));
    // Through the volume, but nothing is opaque: in the second of three tents' gaps.
    const RayProbe clear = probeMiddle(*slab({5, 5, 5}, 0.0), tents(3), camera);
    CHECK(clear.hit);
    CHECK(clear.alpha == 0);
    CHECK(clear.feature == -1);
    CHECK(std::isnan(clear.intensity));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto hollow = volumeFrom(geometryOf({5, 8, 5}), [&](int, int j, int) { return j < 4 ? nan : 0.5; });
    const RayProbe half = probeMiddle(*hollow, homogeneous(0.1), camera);
    CHECK(std::isnan(half.samples.front().intensity));
    // Four voxels, and half of the cell in between: the interpolated opacity goes from 0 to full along it.
    CHECK(half.alpha == Approx(1 - std::pow(0.9, 4)).margin(1e-6));
}

TEST_CASE("what is in front of a feature is what hides it", "[probe]") {
    // f1, f3, f1, f2 and f3 of four tents, two planes each along y, as sharp as a plane is thin.
    const std::array<double, 5> along{0.125, 0.625, 0.125, 0.375, 0.625};
    const auto volume = volumeFrom(geometryOf({5, 1000, 5}, {1, 0.01, 1}),
                                   [&](int, int j, int) { return along[static_cast<std::size_t>(j / 200)]; });
    TransferFunction tf = tents(4, 1 - std::pow(0.8, 0.01));
    RayProbe p = probeMiddle(*volume, tf, lookingAlong(volume->geometry(), {0, 1, 0}));
    const double each = -2 * std::log(0.8); // two units of length of α = 0.8 each
    // f3 adds most in its first run, behind one of f1.
    CHECK(depthInFront(p, 2)[0] == Approx(each).epsilon(0.01));
    CHECK(depthInFront(p, 2)[1] < 0.01);
    CHECK(depthInFront(p, 0) == std::vector<double>(4, 0.0)); // nothing is in front of the first
    const auto second = depthInFront(p, 1);
    CHECK(second[0] == Approx(2 * each).epsilon(0.01));
    CHECK(second[1] == 0);
    CHECK(second[2] == Approx(each).epsilon(0.02));
    CHECK(depthInFront(p, 3) == std::vector<double>(4, 0.0)); // not on the ray
}
