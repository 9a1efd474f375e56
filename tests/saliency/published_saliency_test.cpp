#include <catch2/catch.hpp>

#include <cmath>

#include "base/parallel.h"
#include "saliency/published_saliency.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Black at 0, white at 1, in no feature.
TransferFunction greys() {
    TransferFunction tf;
    tf.points = {{0, 0, {0, 0, 0}, false, {}}, {1, 0, {1, 1, 1}, false, {}}};
    return tf;
}

/// The value at one voxel, 0 elsewhere.
std::shared_ptr<const Volume> oneVoxel(Int3 dims, Int3 at) {
    return volumeFrom(geometryOf(dims, {1, 2, 3}),
                      [&](int i, int j, int k) { return Int3(i, j, k) == at ? 1.0 : 0.0; });
}

} // namespace

TEST_CASE("the discrete Gaussian is the modified Bessel function's", "[saliency][published]") {
    // e^(−t)·I_k(t) with t = (2·√2/8)² = 1/8 and (4·√2/8)² = 1/2, over its sum: scipy.special.ive(k, t).
    const std::vector<double> expected2{0.88601223, 0.05526789, 0.00172600};
    const std::vector<double> expected4{0.64504198, 0.15642243, 0.01935226, 0.00160436, 0.00009996};
    const std::vector<double> w2 = discreteGaussian(2), w4 = discreteGaussian(4);
    REQUIRE(w2.size() == 3);
    REQUIRE(w4.size() == 5);
    for (std::size_t k = 0; k < 3; ++k) CHECK(w2[k] == Approx(expected2[k]).margin(1e-8));
    for (std::size_t k = 0; k < 5; ++k) CHECK(w4[k] == Approx(expected4[k]).margin(1e-8));
}

TEST_CASE("published colours are seen in the light of D50", "[saliency][published]") {
    CHECK(publishedAppearanceOf({0, 0, 0}).brightness == Approx(0).margin(1e-12));
    CHECK(publishedAppearanceOf({1, 1, 1}).brightness == Approx(1));
    CHECK(publishedAppearanceOf({1, 1, 1}).saturation == Approx(0).margin(1e-9));
    // sRGB's red is L* 54.29, a* 80.81, b* 69.89 under D50 (and 53.24, 80.09, 67.20 under D65).
    CHECK(publishedAppearanceOf({1, 0, 0}).brightness == Approx(0.5429).margin(1e-4));
    CHECK(publishedAppearanceOf({1, 0, 0}).saturation == Approx(std::hypot(80.81, 69.89) / 100).margin(1e-4));
    // Components are rounded to 8 bits: 0.5 to 128/255, 0.501 too.
    CHECK(publishedAppearanceOf({0.5, 0.5, 0.5}).brightness == publishedAppearanceOf({0.501, 0.501, 0.501}).brightness);
    CHECK(publishedAppearanceOf({0.5, 0.5, 0.5}).brightness < publishedAppearanceOf({0.504, 0.504, 0.504}).brightness);
}

TEST_CASE("published saliency is the difference of two discrete Gaussians", "[saliency][published]") {
    // One white voxel: G_r there is the product of three central weights, one voxel along x w_r[1]·w_r[0]². The spacing
    // does not count.
    const std::vector<double> w2 = discreteGaussian(2), w4 = discreteGaussian(4);
    const auto volume = oneVoxel({40, 37, 35}, {20, 32, 16}); // on a border of the pieces that threads work on
    const WeightFields fields = publishedSaliencyFields(*volume, greys());
    const auto at = [&](int i, int j, int k) {
        return static_cast<double>(fields.brightness(static_cast<std::size_t>(i + 40 * (j + 37 * k))));
    };
    const double tolerance = fields.scale(0); // a unit of what is stored
    const auto expected = [&](std::size_t i, std::size_t j, std::size_t k) {
        const auto of = [](const std::vector<double>& w, std::size_t n) { return n < w.size() ? w[n] : 0.0; };
        return std::abs(of(w2, i) * of(w2, j) * of(w2, k) - of(w4, i) * of(w4, j) * of(w4, k));
    };
    CHECK(at(20, 32, 16) == Approx(expected(0, 0, 0)).margin(tolerance));
    CHECK(at(21, 32, 16) == Approx(expected(1, 0, 0)).margin(tolerance));
    CHECK(at(20, 31, 16) == Approx(expected(0, 1, 0)).margin(tolerance));
    CHECK(at(20, 32, 15) == Approx(expected(0, 0, 1)).margin(tolerance));
    CHECK(at(22, 31, 17) == Approx(expected(2, 1, 1)).margin(tolerance));
    CHECK(at(20, 36, 16) == Approx(expected(0, 4, 0)).margin(tolerance));
    CHECK(at(20, 27, 16) == 0);
    CHECK(fields.saturation(0) == 0);
}

TEST_CASE("published saliency repeats the edge outward", "[saliency][published]") {
    // A white voxel in the corner stands for all voxels beyond it: G_r there is ((1 + w_r[0])/2)³, as the weights of
    // half of the offsets sum to that.
    const WeightFields fields = publishedSaliencyFields(*oneVoxel({9, 9, 9}, {0, 0, 0}), greys());
    const auto corner = [](int radius) { return std::pow((1 + discreteGaussian(radius)[0]) / 2, 3); };
    CHECK(fields.brightness(0) == Approx(corner(2) - corner(4)).margin(fields.scale(0)));
    const WeightFields flat = publishedSaliencyFields(*slab({5, 5, 5}, 0.7), greys());
    for (std::size_t i = 0; i < flat.size(); ++i) CHECK(flat.brightness(i) == 0);
}

TEST_CASE("published saliency sees colours outside features, and invalid voxels as black", "[saliency][published]") {
    std::vector<float> samples(9 * 9 * 9, 1.0f);
    samples[364] = std::nanf(""); // the middle
    const Volume holed = Volume(geometryOf({9, 9, 9}), Samples(std::move(samples))).withRange({0, 1});
    // White but for one black voxel: the same differences as of one white voxel in black.
    const WeightFields fields = publishedSaliencyFields(holed, greys());
    const double centre = std::pow(discreteGaussian(2)[0], 3) - std::pow(discreteGaussian(4)[0], 3);
    CHECK(fields.brightness(364) == Approx(centre).margin(2 * fields.scale(0)));
}

TEST_CASE("published saliency has the same bits on any number of threads", "[saliency][published]") {
    std::mt19937 random(5);
    const auto volume = roughVolume(random, {30, 40, 50}, Vec3(1));
    setThreadCount(1);
    const WeightFields one = publishedSaliencyFields(*volume, tents(3));
    setThreadCount(4);
    const WeightFields four = publishedSaliencyFields(*volume, tents(3));
    setThreadCount(0);
    CHECK(one == four);
}
