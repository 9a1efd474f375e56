// What is done to large volumes to save memory, on small ones: narrow codes and compact weights.
#include <catch2/catch.hpp>

#include <cmath>

#include "render/camera_motion.h"
#include "render/cpu/cpu_engine.h"
#include "render/cpu/sweep.h"
#include "saliency/saliency_field.h"
#include "saliency/vws.h"
#include "support/random_cases.h"
#include "volume/intensity_grid.h"
#include "volume/procedural.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// A volume whose codes are narrow for as long as this lives.
struct Narrow {
    explicit Narrow(const Volume& like)
        : volume(std::make_shared<const Volume>(like.withRange(like.range()))),
          codes(std::make_shared<const IntensityGrid>(makeIntensityGrid(*volume, CodeWidth::Narrow))) {
        volume->sharedCodes().grid = codes;
    }
    std::shared_ptr<const Volume> volume;
    std::shared_ptr<const IntensityGrid> codes;
};

/// 8-bit noise over a slope; odd sizes, so that rows end inside vectors. `high`: the largest value.
std::shared_ptr<const Volume> eightBit(const Int3& dims, int low, int high) {
    Random random(7);
    std::vector<std::uint8_t> values(voxelCount(dims));
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<std::uint8_t>(low + (high - low) * random.unit() * static_cast<double>(i % 37) / 36);
    values[0] = static_cast<std::uint8_t>(low);
    values[1] = static_cast<std::uint8_t>(high);
    return std::make_shared<const Volume>(Geometry{dims, {1, 1.3, 0.8}, {3, 2, 1}}, Samples(std::move(values)));
}

void checkSame(const FeatureSums& a, const FeatureSums& b) {
    CHECK(a.visibility == b.visibility);
    CHECK(a.weighted == b.weighted);
    CHECK(a.allVisibility == b.allVisibility);
    CHECK(a.allWeighted == b.allWeighted);
}

} // namespace

TEST_CASE("narrow codes are those of 16 bits without their gaps", "[lean]") {
    const auto volume = eightBit({13, 7, 5}, 20, 200);
    const IntensityGrid wide = makeIntensityGrid(*volume, CodeWidth::Wide),
                        narrow = makeIntensityGrid(*volume, CodeWidth::Narrow);
    REQUIRE(narrow.codes.isNarrow());
    CHECK(!makeIntensityGrid(*volume).codes.isNarrow()); // it is small
    CHECK(narrow.maxCode == 180);                        // 200 − 20
    CHECK(narrow.codeStep == 1);
    for (std::size_t i = 0; i < volume->size(); ++i) CHECK(narrow.codes[i] * wide.codeStep == wide.codes[i]);
    // Not where 8 bits do not hold all intensities, or some voxel has none.
    const Geometry line{{3, 1, 1}, {1, 1, 1}, {0, 0, 0}};
    CHECK(!makeIntensityGrid(Volume(line, std::vector<std::uint16_t>{0, 1, 256}), CodeWidth::Narrow).codes.isNarrow());
    CHECK(!makeIntensityGrid(Volume(line, std::vector<std::uint8_t>{0, 1, 9}, 1), CodeWidth::Narrow).codes.isNarrow());
    CHECK(!makeIntensityGrid(Volume(line, std::vector<float>{0, 1, 2}), CodeWidth::Narrow).codes.isNarrow());
    const IntensityGrid windowed =
        makeIntensityGrid(Volume(line, std::vector<std::int16_t>{-9, 7, 30000}).withRange({0, 10}), CodeWidth::Narrow);
    REQUIRE(windowed.codes.isNarrow());
    CHECK(windowed.codes[0] == 0);
    CHECK(windowed.codes[1] == 7);
    CHECK(windowed.codes[2] == 10);
}

TEST_CASE("the cpu engine has the same bits from narrow codes", "[lean]") {
    for (const Int3& dims : {Int3(37, 30, 25), Int3(9, 1, 20), Int3(1, 17, 9), Int3(5, 4, 1)}) {
        const auto wide = eightBit(dims, 3, 203);
        const Narrow narrow(*wide);
        const TransferFunction tf = tents(3, 0.3);
        std::vector<TransferFunction> batch{tf, tents(3, 0.1), tents(3, 0.9)};
        const WeightFields weights = saliencyFields(*wide, tf);
        for (const SweepKernel kernel : sweepKernels())
            for (const Quality quality : {Quality::Normal, Quality::High}) {
                const auto a = makeCpuEngine(wide, quality, kernel), b = makeCpuEngine(narrow.volume, quality, kernel);
                for (const ViewAngles& view : {ViewAngles{0, 0}, ViewAngles{90, 0}, ViewAngles{-80, 10},
                                               ViewAngles{0, 90}, ViewAngles{40, 35}, ViewAngles{200, -70}})
                    for (const Projection projection : {Projection::Orthographic, Projection::Perspective}) {
                        CAPTURE(dims.x, view.azimuth, view.elevation, projection, quality);
                        const Camera camera =
                            cameraFromView(wide->geometry(), view.azimuth, view.elevation, 1, projection);
                        const auto sumsA = a->sums(camera, batch, &weights, {}),
                                   sumsB = b->sums(camera, batch, &weights, {});
                        for (std::size_t i = 0; i < batch.size(); ++i) checkSame(sumsA[i], sumsB[i]);
                        checkSame(a->sums(camera, {&tf, 1}, &weights, {})[0],
                                  b->sums(camera, {&tf, 1}, &weights, {})[0]);
                        const auto fieldA = a->field(camera, tf, {}), fieldB = b->field(camera, tf, {});
                        CHECK(std::equal(fieldA.values.begin(), fieldA.values.end(), fieldB.values.begin()));
                        checkSame(a->jacobian(camera, tf, &weights, {}).byOpacity[1],
                                  b->jacobian(camera, tf, &weights, {}).byOpacity[1]);
                    }
            }
    }
}

TEST_CASE("compact weights are right on average, and the same each time", "[lean]") {
    constexpr int kCount = 1 << 16;
    WeightFields fields({kCount, 1, 1}, 1, 1.34, WeightForm::Compact);
    REQUIRE(fields.isCompact());
    for (const double weight : {0.0, 1e-4, 0.001, 0.01, 0.03, 0.2, 0.7, 1.0}) {
        CAPTURE(weight);
        for (std::size_t i = 0; i < kCount; ++i)
            fields.set(i, static_cast<float>(weight), static_cast<float>(1 - weight));
        double sum[2] = {0, 0}, products = 0;
        for (std::size_t i = 0; i < kCount; ++i) {
            for (int a = 0; a < 2; ++a) sum[a] += static_cast<double>(fields.at(a, i));
            products +=
                (static_cast<double>(fields.at(0, i)) - weight) * (static_cast<double>(fields.at(1, i)) - (1 - weight));
        }
        // σ of the mean: at most 0.24·w/√65536 = 0.001·w above the lowest level (0.0014), √(0.0014·w)/256 below it.
        // Four of them, and half a unit of 16 bits that any weight may be off.
        const auto tolerance = [](double w) {
            return 4 * std::max(0.001 * w, w < 0.0014 ? std::sqrt(0.0014 * w) / 256 : 0.0) + 1.34 / 65535;
        };
        CHECK(std::abs(sum[0] / kCount - weight) <= tolerance(weight));
        CHECK(std::abs(sum[1] / kCount - (1 - weight)) <= tolerance(1 - weight));
        CHECK(std::abs(products / kCount) <= 4 * 0.24 * 0.24 / 256); // the two are drawn apart
    }
    CHECK(fields.at(0, 5) == 1.0f); // levels themselves are exact
    CHECK(fields.at(1, 5) == 0.0f);
    fields.clear(2, 5);
    CHECK(fields.units(1) != 0);
    CHECK(fields.units(2) == 0);
    WeightFields one({9, 1, 1}, 1, 1, WeightForm::Compact), two({9, 1, 1}, 1, 1, WeightForm::Compact);
    for (const std::size_t i : {0u, 4u, 8u}) one.set(i, 0.37f, 0.11f);
    for (const std::size_t i : {8u, 0u, 4u}) two.set(i, 0.37f, 0.11f);
    CHECK(one == two);
}

TEST_CASE("VWS from compact weights is that from exact ones, the closer the larger the volume", "[lean]") {
    const auto volume = std::make_shared<const Volume>(makeSample("shells", 96, 1));
    const TransferFunction tf = tents(3, 0.2);
    const WeightFields exact = saliencyFields(*volume, tf);
    const SaliencyOptions options;
    WeightFields compact(volume->dims(), 1, 1.34, WeightForm::Compact);
    updateSaliencyFields(compact, *volume, tf, options);
    REQUIRE(compact.isCompact());
    const auto engine = makeCpuEngine(volume);
    for (const ViewAngles& view : {ViewAngles{0, 0}, ViewAngles{90, 20}, ViewAngles{30, 60}}) {
        const Camera camera =
            cameraFromView(volume->geometry(), view.azimuth, view.elevation, 1, Projection::Perspective);
        const FeatureSums a = engine->sums(camera, {&tf, 1}, &exact, {})[0],
                          b = engine->sums(camera, {&tf, 1}, &compact, {})[0];
        CHECK(a.visibility == b.visibility);
        const std::vector<double> wa = vwsOf(a), wb = vwsOf(b);
        // Some 10⁴ voxels are seen: 0.24/√10⁴ = 0.0024 of a share below 1 is one σ.
        for (std::size_t f = 0; f < wa.size(); ++f) CHECK(std::abs(wa[f] - wb[f]) < 0.004);
    }
}
