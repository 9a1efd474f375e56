// docs/method.md, "Tolerances", on random cases: every kind of volume, camera and transfer function that
// support/random_cases.h draws.
#include <catch2/catch.hpp>

#include "support/accuracy_check.h"
#include "support/engine_checks.h"
#include "volume/loader.h"
#include "volume/procedural.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("the cpu engine keeps its tolerances on 50 random cases", "[visibility][cpu][accuracy]") {
    checkRandomCases([](auto volume, Quality quality) { return makeCpuEngine(volume, quality); }, 50);
}

// Above 128³ voxels all is left to the rays, in every mode of the sweep.
constexpr std::size_t kLarge = 128 * 128 * 128;

/// A slab of a large knee, thin from front to back: the reference follows short lines.
std::shared_ptr<const Volume> slabOfKnee() {
    VolumeSource source;
    source.path = "sample:knee";
    source.sampleSize = 290; // 290 x 175 x 233 voxels
    source.region = VoxelRegion{{0, 70, 0}, {290, 102, 233}};
    return std::make_shared<const Volume>(loadVolume(source));
}

void checkLarge(const std::shared_ptr<const Volume>& volume, double azimuth, Projection projection) {
    REQUIRE(volume->size() > kLarge);
    const TransferFunction tf = tents(3, 0.3);
    const WeightFields weights = saliencyFields(*volume, tf);
    const Camera camera = cameraFromView(volume->geometry(), azimuth, 20, 1, projection);
    const Grid<float> expected = makeReferenceEngine(volume)->field(camera, tf).values;
    const Disagreement d = compareWithField(expected, *makeCpuEngine(volume), camera, tf, weights);
    CHECK(d.visibilityRms < 0.015);
    CHECK(d.visibility < 0.01);
    CHECK(d.vws < 0.01);
    const Disagreement high = compareWithField(expected, *makeCpuEngine(volume, Quality::High), camera, tf, weights);
    CHECK(high.visibilityRms < 0.01);
    CHECK(high.visibility < 0.005);
    CHECK(high.vws < 0.005);
}

TEST_CASE("in volumes too large to follow every line alone the cpu engine keeps the tolerances too",
          "[visibility][cpu][accuracy]") {
    checkLarge(std::make_shared<const Volume>(makeSample("knee", 165)), 30, Projection::Perspective);
    checkLarge(slabOfKnee(), 45, Projection::Orthographic);
}

TEST_CASE("in large volumes eight candidates, and derivatives, are what single sweeps say", "[visibility][cpu]") {
    const auto volume = std::make_shared<const Volume>(makeSample("knee", 165));
    REQUIRE(volume->size() > kLarge);
    const TransferFunction tf = tents(3, 0.3);
    const WeightFields weights = saliencyFields(*volume, tf);
    for (const Quality quality : {Quality::Normal, Quality::High}) {
        const auto engine = makeCpuEngine(volume, quality);
        const Camera camera = cameraFromView(volume->geometry(), 30, 20, 1, Projection::Perspective);
        std::vector<TransferFunction> tfs;
        for (int i = 0; i < 8; ++i) tfs.push_back(withFeatureOpacities(tf, {0.1 * i, 0.3, 1 - 0.12 * i}));
        const auto together = engine->sums(camera, tfs, &weights);
        for (std::size_t i = 0; i < 8; ++i) {
            const FeatureSums alone = engine->sums(camera, {&tfs[i], 1}, &weights)[0];
            for (std::size_t f = 0; f < 3; ++f) {
                const double margin = 1e-5 * alone.allVisibility;
                CHECK(together[i].visibility[f] == Approx(alone.visibility[f]).epsilon(1e-4).margin(margin));
                CHECK(together[i].weighted[0][f] == Approx(alone.weighted[0][f]).epsilon(1e-4).margin(margin));
            }
        }
        // W(x + δ) − W(x − δ) = 2δ ∂W/∂x, up to third derivatives: δ² of 1e-4 times something of the order of 10.
        const SumsJacobian jacobian = engine->jacobian(camera, tf, &weights);
        const auto derivatives = vwsJacobian(jacobian);
        constexpr double kStep = 0.01;
        for (std::size_t j = 0; j < 3; ++j) {
            std::vector<double> less = featureOpacities(tf), more = less;
            less[j] -= kStep;
            more[j] += kStep;
            const std::vector<TransferFunction> both{withFeatureOpacities(tf, less), withFeatureOpacities(tf, more)};
            const auto sums = engine->sums(camera, both, &weights);
            for (std::size_t i = 0; i < 3; ++i)
                CHECK(derivatives[i][j] ==
                      Approx((vwsOf(sums[1])[i] - vwsOf(sums[0])[i]) / (2 * kStep)).epsilon(0.01).margin(2e-3));
        }
    }
}

TEST_CASE("in large volumes too voxels without a value hide and show nothing", "[visibility][cpu]") {
    // Rods of 1 in 0, the near half of each and a shell around it missing: three values, so that codes are few and
    // their tables have many entries for each. A slab that is seen through its thin side: the reference follows short
    // lines.
    const Int3 dims(12, 430, 440);
    std::vector<std::uint8_t> samples;
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) {
                const double r = glm::length(glm::dvec2(j % 110 - 55, k % 110 - 55));
                samples.push_back(static_cast<std::uint8_t>(r > 50 && r < 54 ? 255 : r < 40 ? (i < 6 ? 255 : 1) : 0));
            }
    const auto volume = std::make_shared<const Volume>(geometryOf(dims), Samples(std::move(samples)), 255.0);
    REQUIRE(volume->size() > kLarge);
    REQUIRE(volume->range() == ValueRange{0, 1});
    TransferFunction tf = tents(2, 0.3);
    tf.points = {{0, 0.02, {1, 0, 0}, false, {}}, {1, 0.3, {0, 0, 1}, false, {}}};
    tf.features = {{"low", 0, 0.5, {1, 0, 0}, {}}, {"high", 0.5, 1, {0, 0, 1}, {}}};
    const WeightFields weights = saliencyFields(*volume, tf);
    const Camera camera = cameraFromView(volume->geometry(), -60, 25, 1, Projection::Perspective);
    const auto engine = makeCpuEngine(volume);
    const Grid<float> field = engine->field(camera, tf).values;
    for (std::size_t i = 0; i < volume->size(); ++i)
        if (std::isnan(volume->intensity(i))) REQUIRE(field[i] == 0);
    const Grid<float> expected = makeReferenceEngine(volume)->field(camera, tf).values;
    const Disagreement d = compareWithField(expected, *engine, camera, tf, weights);
    CHECK(d.visibilityRms < 0.015);
    CHECK(d.visibility < 0.01);
    CHECK(d.vws < 0.01);
}

TEST_CASE("random cases are what they promise", "[visibility][accuracy]") {
    // Measurable, and no measure is trivial in most: more than one feature with a share of what is seen.
    int telling = 0;
    for (std::uint32_t n = 0; n < 50; ++n) {
        const RandomCase c = randomCase(n), again = randomCase(n);
        INFO(c.describe());
        CHECK(c.describe() == again.describe());
        CHECK(c.camera == again.camera);
        CHECK(c.tf == again.tf);
        const auto& opacities = featureOpacities(c.tf);
        REQUIRE(!opacities.empty());
        CHECK(opacities.size() <= 5);
        for (int a = 0; a < 3; ++a) {
            CHECK(c.volume->dims()[a] >= 12);
            CHECK(c.volume->dims()[a] <= 48);
        }
        const auto measures = featureMeasures(makeCpuEngine(c.volume)->sums(c.camera, {&c.tf, 1}, nullptr)[0]);
        int shown = 0;
        for (const FeatureMeasures& m : measures) shown += m.visibility > 0.02;
        CHECK(std::any_of(measures.begin(), measures.end(), [](const auto& m) { return m.visibility > 0; }));
        telling += shown > 1;
    }
    CHECK(telling >= 35);
}
