#include <catch2/catch.hpp>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "render/published_engine.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// The same opacity everywhere, one feature over everything.
TransferFunction constant(double opacity) {
    TransferFunction tf;
    tf.points = {{0, opacity, {1, 1, 1}, false, {}}, {1, opacity, {1, 1, 1}, false, {}}};
    tf.features = deriveFeatures(tf);
    return tf;
}

Camera along(const Volume& volume, Vec3 direction) { return lookingAlong(volume.geometry(), direction); }

const Vec3 kDownX{-1, 0, 0}, kUpX{1, 0, 0}, kDownY{0, -1, 0}, kUpY{0, 1, 0}, kDownZ{0, 0, -1}, kUpZ{0, 0, 1};

} // namespace

TEST_CASE("published visibility is the growth of an opacity of 8 bits", "[render][published]") {
    // α = ½ is 128/255. A grows by 128, then by 127·128/255 = 63.75, rounded 64, then by 63·128/255 = 31.6, rounded 32.
    const std::vector<float> expected{128 / 255.0f, 64 / 255.0f, 32 / 255.0f};
    for (const auto& [direction, axis] :
         {std::pair{kDownX, 0}, {kUpX, 0}, {kDownY, 1}, {kUpY, 1}, {kDownZ, 2}, {kUpZ, 2}}) {
        Int3 dims(2);
        dims[axis] = 3;
        const auto volume = slab(dims, 0.5, {1, 2, 0.5}); // no opacity correction: the spacing does not count
        const auto engine = makePublishedEngine(volume);
        const Camera camera = along(*volume, direction);
        const VisibilityField field = engine->field(camera, constant(0.5));
        for (int k = 0; k < dims.z; ++k)
            for (int j = 0; j < dims.y; ++j)
                for (int i = 0; i < dims.x; ++i) {
                    const int place = Int3(i, j, k)[axis];
                    const bool downward = direction[axis] < 0;
                    CHECK(field.values.at(i, j, k) == expected[static_cast<std::size_t>(downward ? 2 - place : place)]);
                }
        const TransferFunction tf = constant(0.5);
        const FeatureSums sums = engine->sums(camera, {&tf, 1}, nullptr)[0];
        CHECK(sums.allVisibility == Approx(4 * 224 / 255.0)); // four rays of 128 + 64 + 32
        CHECK(sums.visibility[0] == sums.allVisibility);
    }
}

TEST_CASE("an opacity below half of 1/255 is none, the last one fills what is left", "[render][published]") {
    const auto volume = slab({1, 4, 1}, 0.5);
    const auto engine = makePublishedEngine(volume);
    const Camera camera = along(*volume, kDownY);
    const TransferFunction faint = constant(0.0019), opaque = constant(1);
    CHECK(engine->sums(camera, {&faint, 1}, nullptr)[0].allVisibility == 0);
    const VisibilityField field = engine->field(camera, opaque);
    CHECK(field.values.at(0, 3, 0) == 1);
    CHECK(field.values.at(0, 2, 0) == 0);
}

TEST_CASE("published sums weigh each voxel and know closed features", "[render][published]") {
    // From y = 3 down: 0.25, 0.5, 0.75, 1. Opacity 1/5 everywhere: 51/255; A grows by 51, 204·51/255 = 40.8: 41,
    // 163·51/255 = 32.6: 33, 130·51/255 = 26.
    const auto volume = volumeFrom(geometryOf({1, 4, 1}), [](int, int j, int) { return (4 - j) / 4.0; });
    TransferFunction tf = constant(0.2);
    tf.features = {{"low", 0.1, 0.5, {}, {}}, {"middle", 0.6, 0.75, {}, {}}, {"high", 0.75, 1, {}, {}}};
    WeightFields weights({1, 4, 1}, 1, 1);
    for (std::size_t i = 0; i < 4; ++i) weights.set(i, 1.0f, i == 2 ? 1.0f : 0.0f);
    const auto engine = makePublishedEngine(volume);
    const FeatureSums sums = engine->sums(along(*volume, kDownY), {&tf, 1}, &weights)[0];
    CHECK(sums.visibility[0] == Approx((51 + 41) / 255.0)); // 0.5 is low's upper end and in no other
    CHECK(sums.visibility[1] == 0);                         // 0.75 is where high begins
    CHECK(sums.visibility[2] == Approx((33 + 26) / 255.0));
    CHECK(sums.allVisibility == Approx(151 / 255.0));
    CHECK(sums.weighted[0][2] == Approx(sums.visibility[2]));
    CHECK(sums.weighted[1][0] == Approx(41 / 255.0)); // the voxel of index 2, intensity 0.5
    CHECK(sums.allWeighted[1] == Approx(41 / 255.0));
}

TEST_CASE("invalid and clipped voxels have no part in published visibility", "[render][published]") {
    std::vector<float> samples{0.5f, 0.5f, std::nanf(""), 0.5f};
    const auto volume =
        std::make_shared<const Volume>(Volume(geometryOf({1, 4, 1}), Samples(std::move(samples))).withRange({0, 1}));
    const auto engine = makePublishedEngine(volume);
    View view(along(*volume, kDownY));
    const VisibilityField holed = engine->field(view, constant(0.5));
    CHECK(holed.values[3] == 128 / 255.0f);
    CHECK(holed.values[2] == 0);
    CHECK(holed.values[1] == 64 / 255.0f); // as though the hole were air
    view.clipping.hi = {1, 0.75, 1};       // the first plane
    const VisibilityField clipped = engine->field(view, constant(0.5));
    CHECK(clipped.values[3] == 0);
    CHECK(clipped.values[1] == 128 / 255.0f);
}

TEST_CASE("the published engine refuses a camera that looks along no axis", "[render][published]") {
    const auto volume = slab({4, 4, 4}, 0.5);
    const auto engine = makePublishedEngine(volume);
    const TransferFunction tf = constant(0.5);
    const Camera oblique = along(*volume, {0.3, 1, 0});
    CHECK_THROWS_AS(engine->sums(oblique, {&tf, 1}, nullptr), UsageError);
    const Camera perspective = cameraFromView(volume->geometry(), 0, 0, 1, Projection::Perspective);
    CHECK_THROWS_AS(engine->field(perspective, tf), UsageError);
}

TEST_CASE("published sums are those of the field, for many candidates, on any number of threads",
          "[render][published]") {
    std::mt19937 random(3);
    const auto volume = roughVolume(random, {17, 20, 23}, Vec3(1));
    const WeightFields weights = saliencyFields(*volume, tents(3));
    const auto engine = makePublishedEngine(volume);
    const std::vector<TransferFunction> tfs{tents(3, 0.1), tents(3, 0.5), tents(3, 1)};
    for (const Vec3& direction : {kDownX, kUpY, kDownZ}) {
        const Camera camera = along(*volume, direction);
        setThreadCount(1);
        const auto one = engine->sums(camera, tfs, &weights);
        setThreadCount(4);
        const auto four = engine->sums(camera, tfs, &weights);
        setThreadCount(0);
        for (std::size_t c = 0; c < tfs.size(); ++c) {
            CHECK(one[c].weighted == four[c].weighted);
            const VisibilityField field = engine->field(camera, tfs[c]);
            FeatureSums expected = emptySums(3);
            for (std::size_t i = 0; i < volume->size(); ++i)
                addVoxel(expected, featureAt(tfs[c].features, volume->intensity(i)), field.values[i],
                         weights.brightness(i), weights.saturation(i));
            for (std::size_t f = 0; f < 3; ++f) {
                CHECK(one[c].visibility[f] == Approx(expected.visibility[f]));
                for (std::size_t w = 0; w < 2; ++w) CHECK(one[c].weighted[w][f] == Approx(expected.weighted[w][f]));
            }
        }
    }
}

TEST_CASE("published derivatives are those of the shares without rounding", "[render][published]") {
    std::mt19937 random(9);
    const auto volume = roughVolume(random, {15, 16, 17}, Vec3(1));
    const TransferFunction tf = withFeatureOpacities(tents(3), {0.2, 0.4, 0.7});
    const WeightFields weights = saliencyFields(*volume, tf);
    const auto engine = makePublishedEngine(volume);
    const Camera camera = along(*volume, kDownZ);
    const SumsJacobian jacobian = engine->jacobian(camera, tf, &weights);
    CHECK(jacobian.sums.weighted == engine->sums(camera, {&tf, 1}, &weights)[0].weighted);

    const auto vwsWithoutRounding = [&](const TransferFunction& at) {
        const TfSampler sampler(at);
        FeatureSums sums = emptySums(3);
        for (int j = 0; j < 16; ++j)
            for (int i = 0; i < 15; ++i) {
                double transmittance = 1;
                for (int k = 16; k >= 0; --k) {
                    const auto voxel = static_cast<std::size_t>(i + 15 * (j + 16 * k));
                    const double s = volume->intensity(voxel), alpha = sampler.opacity(s);
                    addVoxel(sums, featureAt(at.features, s), alpha * transmittance, weights.brightness(voxel),
                             weights.saturation(voxel));
                    transmittance *= 1 - alpha;
                }
            }
        return vwsOf(sums);
    };
    const auto found = vwsJacobian(jacobian);
    const std::vector<double> x = featureOpacities(tf);
    for (std::size_t j = 0; j < 3; ++j) {
        constexpr double kStep = 1e-4;
        std::vector<double> more = x, less = x;
        more[j] += kStep;
        less[j] -= kStep;
        const auto high = vwsWithoutRounding(withFeatureOpacities(tf, more));
        const auto low = vwsWithoutRounding(withFeatureOpacities(tf, less));
        for (std::size_t i = 0; i < 3; ++i) // the shares that the quotient rule takes are rounded ones
            CHECK(found[i][j] == Approx((high[i] - low[i]) / (2 * kStep)).margin(5e-3));
    }
}
