#include "volume/samples/time_samples.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "base/parallel.h"
#include "volume/procedural.h"
#include "volume/samples/cubic_zoom.h"
#include "volume/series.h"

using namespace pellucid;

namespace {

Volume frame(const std::string& name, int step, int size = 24, std::uint32_t seed = 1) {
    return makeSample(name, size, seed, {}, {}, step);
}

/// Mean of |a − b| over voxels that are valid in both, in widths of the declared range.
double distance(const Volume& a, const Volume& b, const ValueRange& range) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!a.isValid(i) || !b.isValid(i)) continue;
        sum += std::abs(a.value(i) - b.value(i));
        ++count;
    }
    return sum / static_cast<double>(count) / (range.hi - range.lo);
}

} // namespace

TEST_CASE("samples over time have the same bits in any order of frames and on any number of threads", "[samples]") {
    for (const SampleInfo& info : samples()) {
        if (info.frames == 1) continue;
        INFO(info.name);
        const int late = std::min(info.frames - 1, 30);
        setThreadCount(1);
        const Volume first = frame(info.name, late);
        setThreadCount(0);
        frame(info.name, 2, 24, 5); // another seed in between
        frame(info.name, 0);
        // NaN is not equal to itself: by the bytes.
        const Volume again = frame(info.name, late);
        REQUIRE(again.size() == first.size());
        for (std::size_t i = 0; i < first.size(); ++i) {
            REQUIRE(first.isValid(i) == again.isValid(i));
            if (first.isValid(i)) REQUIRE(first.value(i) == again.value(i));
        }
        CHECK_FALSE(frame(info.name, late, 24, 2).samples() == first.samples());
        CHECK_THROWS_AS(frame(info.name, info.frames), UsageError);
    }
}

TEST_CASE("samples over time stay in their range and change little by little", "[samples]") {
    for (const SampleInfo& info : samples()) {
        if (info.frames == 1) continue;
        INFO(info.name);
        const int middle = info.frames / 2;
        const Volume a = frame(info.name, middle), b = frame(info.name, middle + 1), last = frame(info.name, 0);
        for (const Volume* v : {&a, &b, &last}) {
            CHECK(v->dataRange().lo >= info.range.lo);
            CHECK(v->dataRange().hi <= info.range.hi);
            CHECK(v->range() == info.range);
        }
        const double step = distance(a, b, info.range), apart = distance(a, last, info.range);
        CHECK(step > 1e-5);        // it moves
        CHECK(step < 0.6 * apart); // from frame to frame less than over half of all frames
        VolumeSource source;
        source.path = "sample:" + info.name;
        const SeriesListing listing = listSeries(source);
        CHECK(static_cast<int>(listing.frames.size()) == info.frames);
        CHECK(listing.declaredRange == info.range);
        CHECK(listing.frames[3].source.step == 3);
    }
}

TEST_CASE("nothing of the storm is below the ground", "[samples]") {
    const Volume ground = frame("hurricane/ground", 0, 40), cloud = frame("hurricane", 20, 40);
    REQUIRE(ground.dims() == Int3(40, 40, 1));
    REQUIRE(cloud.dims() == Int3(40, 40, 8));
    CHECK(ground.dataRange().lo == 0); // the sea
    CHECK(ground.dataRange().hi > 500);
    // Layer k is (k + ½)·2500 m high: the first is missing where the land is higher than 1250 m.
    for (std::size_t i = 0; i < ground.size(); ++i) CHECK(cloud.isValid(i) == (ground.value(i) <= 1250));
}

TEST_CASE("a cubic zoom goes through straight lines and repeats where it should", "[samples]") {
    Grid<float> ramp(Int3(6, 5, 4));
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 5; ++j)
            for (int i = 0; i < 6; ++i) ramp.at(i, j, k) = static_cast<float>(i + 10 * j + 100 * k);
    const Grid<float> fine = cubicZoom(ramp, {18, 15, 12}, false, {});
    // Fine voxel n lies at (n + ½)/3 − ½; a line is met where all four neighbours are inside.
    const auto at = [](int n) { return (n + 0.5) / 3 - 0.5; };
    for (int k = 5; k < 7; ++k)
        for (int j = 5; j < 10; ++j)
            for (int i = 5; i < 13; ++i)
                CHECK(fine.at(i, j, k) == Approx(at(i) + 10 * at(j) + 100 * at(k)).epsilon(1e-5));
    Grid<float> wave(Int3(4, 1, 1));
    for (int i = 0; i < 4; ++i) wave.at(i, 0, 0) = i % 2 == 0 ? 1.0f : -1.0f;
    const Grid<float> repeated = cubicZoom(wave, {8, 1, 1}, true, {});
    for (int i = 0; i < 8; ++i) CHECK(repeated.at(i, 0, 0) == Approx(repeated.at((i + 4) % 8, 0, 0)).margin(1e-6));
}
