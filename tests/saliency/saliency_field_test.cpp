#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "saliency/lch.h"
#include "saliency/saliency_field.h"
#include "support/volumes.h"
#include "volume/error.h"
#include "volume/parallel.h"

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
        for (const double sigma : {0.6, 2.0, 3.3})
            for (const Vec3 spacing : {Vec3(1), Vec3(0.7, 1.1, 2.3), Vec3(2, 0.5, 1)}) {
                const auto volume = roughVolume(random, {17, 21, 13}, spacing);
                SaliencyOptions options{sigma, kernel, 1.0, 0.8, {0.2, 0.1, 0.4}};
                const TransferFunction tf = tents(4);
                const WeightFields fast = saliencyFields(*volume, tf, options),
                                   slow = saliencyFieldsReference(*volume, tf, options);
                CHECK(largestDifference(fast, slow, 0) < 1e-4);
                CHECK(largestDifference(fast, slow, 1) < 1e-4);
            }
}

TEST_CASE("integer volumes give the same fields through their table of colours", "[saliency]") {
    std::vector<std::int16_t> samples;
    for (int i = 0; i < 12 * 12 * 12; ++i) samples.push_back(static_cast<std::int16_t>(-300 + (i * 37) % 1000));
    const Volume volume({{12, 12, 12}, Vec3(1), Vec3(0)}, Samples(samples));
    const WeightFields fast = saliencyFields(volume, tents(3)), slow = saliencyFieldsReference(volume, tents(3));
    CHECK(largestDifference(fast, slow, 0) < 1e-4);
    CHECK(largestDifference(fast, slow, 1) < 1e-4);
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
    const auto volume = roughVolume(random, {30, 40, 50}, Vec3(1));
    setThreadCount(1);
    const WeightFields one = saliencyFields(*volume, tents(3));
    setThreadCount(3);
    const WeightFields three = saliencyFields(*volume, tents(3));
    setThreadCount(0);
    CHECK(one == three);
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
