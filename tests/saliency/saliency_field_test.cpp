#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "saliency/appearance.h"
#include "saliency/ball_plan.h"
#include "saliency/saliency_direct.h"
#include "saliency/saliency_field.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

double largestDifference(const WeightFields& a, const WeightFields& b, int attribute) {
    REQUIRE(a.dims() == b.dims());
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        worst = std::max(worst, static_cast<double>(std::abs(a.at(attribute, i) - b.at(attribute, i))));
    return worst;
}

/// Weights are stored in steps of 1.5e-5 and 2e-5: they are off by half of that.
constexpr double kRounding = 1.1e-5;

void checkAgainst(const WeightFields& expected, const WeightFields& fields) {
    CHECK(largestDifference(expected, fields, 0) < 1e-4);
    CHECK(largestDifference(expected, fields, 1) < 1e-4);
}

WeightFields direct(const Volume& volume, const TransferFunction& tf, const SaliencyOptions& options) {
    WeightFields fields;
    updateSaliencyFieldsDirect(fields, volume, tf, options);
    return fields;
}

} // namespace

TEST_CASE("nothing stands out of a homogeneous volume", "[saliency]") {
    const auto volume = slab({9, 8, 7}, 0.5);
    const WeightFields fields = saliencyFields(*volume, tents(3));
    for (std::size_t i = 0; i < fields.size(); ++i) { // both means are the same colour
        CHECK(fields.brightness(i) == 0);
        CHECK(fields.saturation(i) == 0);
    }
}

TEST_CASE("a single coloured voxel has the saliency of (4.6)–(4.8)", "[saliency]") {
    // Background black: O = 0. One voxel of colour c in the middle, far from every side. With σ = 1 the centre ball
    // holds only the voxel itself (|j−i| < 1), G = O. The surround, radius 2, weights exp(−d²/16): 1 voxel at d² = 0, 6
    // at 1, 12 at 2, 8 at 3. At the voxel itself L = O·(1 − 1/N); beside it only the surround sees it: L =
    // O·exp(−1/16)/N.
    const auto volume = volumeFrom(geometryOf({11, 11, 11}),
                                   [](int i, int j, int k) { return i == 5 && j == 5 && k == 5 ? 0.5 : 0.0; });
    SaliencyOptions options;
    options.sigma = 1;
    const TransferFunction tf = tents(1);
    const Appearance o = appearanceOf(tf.features[0].color);
    const double n = 1 + 6 * std::exp(-1.0 / 16) + 12 * std::exp(-2.0 / 16) + 8 * std::exp(-3.0 / 16);
    const auto at = [&](int i, int j, int k) { return static_cast<std::size_t>(i + 11 * (j + 11 * k)); };
    for (const auto& fields : {saliencyFields(*volume, tf, options), saliencyFieldsReference(*volume, tf, options)}) {
        CHECK(fields.brightness(at(5, 5, 5)) == Approx(o.brightness * (1 - 1 / n)).margin(kRounding));
        CHECK(fields.saturation(at(5, 5, 5)) == Approx(o.saturation * (1 - 1 / n)).margin(kRounding));
        CHECK(fields.brightness(at(6, 5, 5)) == Approx(o.brightness * std::exp(-1.0 / 16) / n).margin(kRounding));
        CHECK(fields.brightness(at(7, 5, 5)) == 0); // d = 2 is not inside: the truncation is strict
    }
}

TEST_CASE("at the border weights are normalised over the neighbours inside", "[saliency]") {
    // σ = 1, a voxel in a corner: of the surround 1 + 3 + 3 + 1 voxels are inside.
    const auto volume =
        volumeFrom(geometryOf({8, 8, 8}), [](int i, int j, int k) { return i + j + k == 0 ? 0.5 : 0.0; });
    SaliencyOptions options;
    options.sigma = 1;
    const double n = 1 + 3 * std::exp(-1.0 / 16) + 3 * std::exp(-2.0 / 16) + std::exp(-3.0 / 16);
    const double o = appearanceOf(tents(1).features[0].color).brightness;
    CHECK(saliencyFields(*volume, tents(1), options).brightness(0) == Approx(o * (1 - 1 / n)).margin(kRounding));
}

TEST_CASE("the fast fields equal the direct sums", "[saliency]") {
    std::mt19937 random(7);
    for (const auto kernel : {SaliencyKernel::Thesis, SaliencyKernel::Narrow})
        for (const double sigma : {0.4, 0.6, 2.0, 3.3, 8.0})
            for (const Vec3 spacing : {Vec3(1), Vec3(0.7, 1.1, 2.3), Vec3(2, 0.5, 1)}) {
                const auto volume = roughVolume(random, {17, 21, 13}, spacing);
                SaliencyOptions options{sigma, kernel, 1.0, 0.8, {0.2, 0.1, 0.4}};
                const TransferFunction tf = tents(4);
                const WeightFields slow = saliencyFieldsReference(*volume, tf, options);
                checkAgainst(slow, saliencyFields(*volume, tf, options));
                checkAgainst(slow, direct(*volume, tf, options));
            }
}

TEST_CASE("integer volumes give the same fields through their table of colours", "[saliency]") {
    std::vector<std::int16_t> samples;
    for (int i = 0; i < 12 * 12 * 12; ++i) samples.push_back(static_cast<std::int16_t>(-300 + (i * 37) % 1000));
    const Geometry geometry{{12, 12, 12}, Vec3(1), Vec3(0)};
    const Volume volume(geometry, Samples(samples));
    checkAgainst(saliencyFieldsReference(volume, tents(3)), saliencyFields(volume, tents(3)));
    // A window inside the range, bounds that are no integers, a missing value; and 8 bits with a sign.
    const Volume window = Volume(geometry, Samples(samples), 33.0).withRange({-150.5, 420.25});
    checkAgainst(saliencyFieldsReference(window, ramp(5)), saliencyFields(window, ramp(5)));
    std::vector<std::int8_t> bytes;
    for (const std::int16_t s : samples) bytes.push_back(static_cast<std::int8_t>(s / 8));
    const Volume small(geometry, Samples(bytes));
    checkAgainst(saliencyFieldsReference(small, tents(5)), saliencyFields(small, tents(5)));
}

TEST_CASE("large volumes of real numbers give the same fields through their table of intensities", "[saliency]") {
    // More than 4·16384 voxels. Colours that bend, a step, a feature that begins between two of them, a thin one.
    TransferFunction tf;
    tf.points = {{0.1, 0.5, {1, 0, 0}, false, {}},      {0.3003, 0.5, {0.2, 0.9, 0.1}, false, {}},
                 {0.3003, 0.5, {0, 0, 1}, false, {}},   {0.5, 0.5, {0.5, 0.5, 0.5}, false, {}},
                 {0.5007, 0.5, {0, 1, 1}, false, {}},   {0.5008, 0.5, {1, 1, 0}, false, {}},
                 {0.9, 0.5, {0.9, 0.1, 0.8}, false, {}}};
    tf.features = {{"low", 0.05, 0.47, {}, {}}, {"thin", 0.5004, 0.50055, {}, {}}, {"high", 0.7123, 1, {}, {}}};
    std::mt19937 random(10);
    auto volume = roughVolume(random, {48, 44, 40}, Vec3(1));
    checkAgainst(saliencyFieldsReference(*volume, tf), saliencyFields(*volume, tf));
    // Values drawn where the table is hardest.
    std::uniform_real_distribution<double> near(0.4995, 0.5015);
    volume = volumeFrom(geometryOf({48, 44, 40}), [&](int, int, int) { return near(random); });
    checkAgainst(saliencyFieldsReference(*volume, tf), saliencyFields(*volume, tf));
}

TEST_CASE("regions of one colour that are left out hold what the sums would", "[saliency]") {
    // Wider, deeper and longer than a tile (192 × 32 × 96), with large regions of one colour: a few balls of other
    // colours, at the sides of the volume and of tiles, and some lone voxels.
    struct Ball {
        Vec3 at;
        double radius, value;
    };
    const std::vector<Ball> balls{{{0, 0, 0}, 5, 0.4},      {{199, 69, 109}, 7, 0.6}, {{104, 35, 55}, 9, 0.15},
                                  {{96, 31, 95}, 3, 0.85},  {{32, 34, 97}, 0.5, 0.5}, {{111, 2, 20}, 0.5, 0.5},
                                  {{112, 60, 21}, 0.5, 0.5}};
    const auto volume = volumeFrom(geometryOf({200, 70, 110}), [&](int i, int j, int k) {
        double s = i < 150 ? 0.5 : 0.05; // a tent, and the gap in front of the first
        for (const Ball& b : balls)
            if (glm::length(Vec3(i, j, k) - b.at) <= b.radius) s = b.value;
        return s;
    });
    for (const double w2 : {1.0, 0.25})
        for (const double sigma : {1.0, 2.0, 4.5}) {
            SaliencyOptions options{sigma, SaliencyKernel::Thesis, 1.0, w2, {0.1, 0.3, 0.2}};
            checkAgainst(direct(*volume, tents(3), options), saliencyFields(*volume, tents(3), options));
        }
}

TEST_CASE("the loops for every instruction set make the same weights", "[saliency]") {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0, 1);
    constexpr int kFloats = 2 * (16 + 64 + 16), kFrom = 32, kTo = 160;
    for (const double sigma : {2.0, 5.0}) {
        SaliencyOptions options;
        options.sigma = sigma;
        const BallPair balls = ballsOf(geometryOf({100, 100, 100}, Vec3(1, 1, 1.5)), options);
        const BallPlan plan(balls, kFloats);
        const auto reachY = static_cast<std::size_t>(balls[1].reach(1)),
                   reachZ = static_cast<std::size_t>(balls[1].reach(2));
        std::vector<std::vector<float>> rows(2 * reachZ + 2 * reachY + 1, std::vector<float>(kFloats));
        for (auto& row : rows)
            for (float& v : row) v = unit(random);
        const std::vector<float> centre(kFloats, 900.0f), surround(kFloats, 100.0f);
        std::vector<std::vector<std::uint32_t>> results;
        for (const BallSumsKernel* kernel : ballSumsKernels()) {
            // Row y + dy of slice z + dz is rows[reachY + reachZ + dy + dz]: any will do.
            const auto floats = static_cast<std::size_t>(plan.sums().zSumCount) * kFloats;
            std::vector<std::vector<float>> zSums(2 * reachY + 1, std::vector<float>(floats));
            std::vector<const float*> of(2 * reachZ + 1), sums;
            for (std::size_t y = 0; y < zSums.size(); ++y) {
                for (std::size_t z = 0; z < of.size(); ++z) of[z] = rows[y + z].data();
                kernel->sumAlongZ(plan.sums(), of.data() + reachZ, kFrom, kTo, zSums[y].data());
                sums.push_back(zSums[y].data());
            }
            std::vector<float> scratch(static_cast<std::size_t>(plan.sums().profileCount) * kFloats);
            auto& packed = results.emplace_back(kFloats / 2);
            kernel->packRow(plan.sums(), sums.data() + reachY, {centre.data(), surround.data()}, kFrom, kTo,
                            scratch.data(), packed.data());
        }
        std::size_t different = 0, largest = 0;
        for (const auto& result : results)
            for (std::size_t x = kFrom / 2; x < kTo / 2; ++x)
                for (const int shift : {0, 16}) {
                    const auto a = static_cast<int>(result[x] >> shift & 0xffffu),
                               b = static_cast<int>(results.back()[x] >> shift & 0xffffu);
                    largest = std::max(largest, static_cast<std::size_t>(b));
                    if (std::abs(a - b) > 1) ++different; // sums in another order: another rounding
                }
        CHECK(different == 0);
        CHECK(largest > 100);
    }
}

TEST_CASE("greys are nowhere salient by their saturation", "[saliency]") {
    std::mt19937 random(12);
    const auto volume = roughVolume(random, {20, 20, 20}, Vec3(1));
    TransferFunction tf = ramp(4);
    for (ControlPoint& p : tf.points) p.color = {p.x, p.x, p.x};
    const WeightFields fields = saliencyFields(*volume, tf);
    double brightness = 0;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        brightness += static_cast<double>(fields.brightness(i));
        CHECK(fields.saturation(i) == 0);
    }
    CHECK(brightness > 0);
}

TEST_CASE("what saliency depends on are colours and the bounds of features", "[saliency]") {
    const TransferFunction tf = ramp(4);
    // Scaling half of a ramp inserts points at the feature's end, between which no colour bends.
    TransferFunction half = tf;
    half.features = {{"half", 0.3, 0.6, {}, {}}};
    const TransferFunction scaled = withFeatureOpacities(half, {0.7});
    REQUIRE(scaled.points.size() > half.points.size());
    CHECK(colorsOf(scaled) == colorsOf(half));
    std::mt19937 random(13);
    const auto volume = roughVolume(random, {20, 20, 20}, Vec3(1));
    checkAgainst(saliencyFields(*volume, half), saliencyFields(*volume, colorsOf(half)));

    TransferFunction renamed = half;
    renamed.features[0].name = "other";
    CHECK(colorsOf(renamed) == colorsOf(half));
    TransferFunction moved = half;
    moved.features[0].b = 0.61;
    CHECK_FALSE(colorsOf(moved) == colorsOf(half));
    TransferFunction recoloured = half;
    recoloured.points[1].color.g += 0.01;
    CHECK_FALSE(colorsOf(recoloured) == colorsOf(half));
    // A step of colour stays, in its order.
    TransferFunction step = half;
    step.points = {{0.5, 0, {1, 0, 0}, false, {}}, {0.5, 0, {0, 1, 0}, false, {}}};
    TransferFunction turned = step;
    std::swap(turned.points[0].color, turned.points[1].color);
    CHECK_FALSE(colorsOf(step) == colorsOf(turned));
    CHECK(colorsOf(colorsOf(step)) == colorsOf(step));
}

TEST_CASE("opacity plays no part in saliency, colour does", "[saliency]") {
    std::mt19937 random(8);
    const auto volume = roughVolume(random, {12, 12, 12}, Vec3(1));
    const TransferFunction tf = tents(3);
    const WeightFields a = saliencyFields(*volume, tf),
                       b = saliencyFields(*volume, withFeatureOpacities(tf, {0.1, 0.9, 0.0}));
    CHECK(a == b);
    TransferFunction recoloured = tf;
    for (ControlPoint& p : recoloured.points) p.color = {0.3, 0.3, 0.3};
    CHECK(largestDifference(a, saliencyFields(*volume, recoloured), 0) > 0.01);
}

TEST_CASE("invalid voxels take the background's colour", "[saliency]") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto inside = [](int i, int j, int k) { return i >= 3 && i < 6 && j >= 3 && j < 6 && k >= 3 && k < 6; };
    const auto withNan =
        volumeFrom(geometryOf({9, 9, 9}), [&](int i, int j, int k) { return inside(i, j, k) ? nan : 0.5; });
    const auto withGap =
        volumeFrom(geometryOf({9, 9, 9}), [&](int i, int j, int k) { return inside(i, j, k) ? 0.0 : 0.5; });
    CHECK(saliencyFields(*withNan, tents(3)) == saliencyFields(*withGap, tents(3)));
}

TEST_CASE("saliency has the same bits for any number of threads", "[saliency]") {
    std::mt19937 random(9);
    const auto volume = roughVolume(random, {210, 70, 40}, Vec3(1)); // six tiles
    setThreadCount(1);
    const WeightFields one = saliencyFields(*volume, tents(3));
    setThreadCount(3);
    const WeightFields three = saliencyFields(*volume, tents(3));
    setThreadCount(8);
    const WeightFields eight = saliencyFields(*volume, tents(3));
    setThreadCount(0);
    CHECK(one == three);
    CHECK(three == eight);
}

TEST_CASE("impossible options are refused, and a stop is heard", "[saliency]") {
    const auto volume = slab({8, 8, 8}, 0.5);
    for (const double sigma : {0.0, -1.0, 9.0, std::nan("")}) {
        SaliencyOptions options;
        options.sigma = sigma;
        CHECK_THROWS_AS(saliencyFields(*volume, tents(3), options), UsageError);
    }
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(saliencyFields(*volume, tents(3), {}, {stop.get_token(), {}}), Cancelled);
}

TEST_CASE("fields made in used memory are those made in new memory", "[saliency]") {
    std::mt19937 random(8);
    const auto volume = roughVolume(random, {40, 24, 20}, Vec3(1));
    for (const double w2 : {1.0, 0.5}) { // where w1 = w2, blocks of one colour are left out
        SaliencyOptions options;
        options.w2 = w2;
        WeightFields fields = saliencyFields(*volume, tents(9), options);
        const std::uint32_t* const memory = fields.data();
        updateSaliencyFields(fields, *volume, tents(1), options);
        CHECK(fields == saliencyFields(*volume, tents(1), options));
        CHECK(fields.data() == memory);
        options.w1 = 2; // another scale
        updateSaliencyFields(fields, *volume, tents(1), options);
        CHECK(fields == saliencyFields(*volume, tents(1), options));
    }
    const auto other = roughVolume(random, {10, 24, 20}, Vec3(1));
    WeightFields fields = saliencyFields(*volume, tents(3));
    updateSaliencyFields(fields, *other, tents(3));
    CHECK(fields == saliencyFields(*other, tents(3)));
}
