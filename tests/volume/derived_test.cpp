#include "volume/derived.h"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "volume/noise.h"
#include "volume/orientation.h"

using namespace pellucid;
using Catch::Matchers::Contains;

namespace {

constexpr Int3 kDims{7, 5, 4};

/// Frames of noise in [−3, 5] or so; the value of voxel i in frame f is valueAt(f, i). Frame `missing` cannot be read.
double valueAt(int frame, std::size_t i) {
    return 1 + 4 * smoothNoise({0.37 * static_cast<double>(i), 0.61 * frame, 0.5}, 3);
}

std::shared_ptr<TimeSeries> noise(int frames, int missing = -1, int invalidFrame = -1) {
    SeriesListing listing;
    listing.title = "noise";
    for (int f = 0; f < frames; ++f) listing.frames.push_back({{}, static_cast<double>(f), "step"});
    return std::make_shared<TimeSeries>(std::move(listing), [=](int frame, const JobControl&) {
        if (frame == missing) throw FileError("the file is cut off", "noise", "copy it again");
        std::vector<float> values(voxelCount(kDims));
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(valueAt(frame, i));
        if (frame == invalidFrame) values[11] = std::nanf("");
        Geometry g;
        g.dims = kDims;
        return Volume(g, SampleArray<float>(std::move(values)));
    });
}

Derivation volatility(int frames) { return {Derivation::Kind::Volatility, "x", frames, 0}; }

/// By the definition: the population standard deviation of normalised values, two passes in double.
double deviation(TimeSeries& base, int frame, int n, std::size_t voxel, int missing = -1) {
    const ValueRange range = base.range();
    std::vector<double> s;
    for (int f = std::max(0, frame - n + 1); f <= frame; ++f)
        if (f != missing) s.push_back((base.load(f)->value(voxel) - range.lo) / (range.hi - range.lo));
    double mean = 0, sum = 0;
    for (const double v : s) mean += v / static_cast<double>(s.size());
    for (const double v : s) sum += (v - mean) * (v - mean);
    return std::sqrt(sum / static_cast<double>(s.size()));
}

} // namespace

TEST_CASE("volatility is the population deviation over the latest frames", "[derived]") {
    const auto base = noise(12);
    for (const int n : {2, 5, 10, 40}) {
        const auto series = derive(base, volatility(n));
        REQUIRE(series->size() == 12);
        for (const int frame : {0, 1, 4, 11}) { // the first have fewer frames before them
            const auto volume = series->load(frame);
            for (std::size_t i = 0; i < volume->size(); ++i)
                CHECK(volume->value(i) == Approx(deviation(*base, frame, n, i)).margin(1e-6));
        }
    }
    const auto one = derive(base, volatility(1));
    CHECK(one->load(7)->dataRange() == ValueRange{0, 0});
    CHECK(derive(base, volatility(10))->load(0)->dataRange() == ValueRange{0, 0});
    // As that of any series: of the values of all its frames.
    const auto ten = derive(base, volatility(10));
    double most = 0;
    for (int frame = 0; frame < 12; ++frame)
        for (std::size_t i = 0; i < voxelCount(kDims); ++i) most = std::max(most, deviation(*base, frame, 10, i));
    CHECK(ten->range().lo == 0); // the first frame
    CHECK(ten->range().hi == Approx(most).margin(1e-6));
}

TEST_CASE("volatility has the same bits on every way to a frame", "[derived]") {
    const auto valuesOf = [](TimeSeries& series, const std::vector<int>& way) {
        series.setBudget(0); // nothing is kept from before
        std::shared_ptr<const Volume> last;
        for (const int frame : way) last = series.load(frame);
        return std::get<SampleArray<float>>(last->samples());
    };
    const auto fresh = [] { return derive(noise(30), volatility(8)); };
    const auto direct = valuesOf(*fresh(), {20});
    CHECK(valuesOf(*fresh(), {17, 18, 19, 20}) == direct);
    CHECK(valuesOf(*fresh(), {24, 23, 22, 21, 20}) == direct);
    CHECK(valuesOf(*fresh(), {0, 29, 3, 20}) == direct);
    CHECK_FALSE(valuesOf(*fresh(), {21}) == direct);
}

TEST_CASE("a frame that cannot be read is left out of volatility, an invalid voxel makes it invalid", "[derived]") {
    const auto base = noise(10, 4);
    const auto series = derive(base, volatility(5));
    const auto volume = series->load(6); // of 2, 3, 5 and 6
    for (std::size_t i = 0; i < volume->size(); ++i)
        CHECK(volume->value(i) == Approx(deviation(*base, 6, 5, i, 4)).margin(1e-6));
    CHECK_THROWS_AS(series->load(4), Error);

    const auto holed = derive(noise(10, -1, 3), volatility(3));
    for (const int frame : {2, 3, 4, 5, 6}) {
        const auto v = holed->load(frame);
        CHECK(v->isValid(11) == (frame < 3 || frame > 5)); // while frame 3 is among the latest three
        CHECK(v->isValid(12));
    }
}

namespace {

/// By the published definition: each frame scaled to [0,1] by its own values, the sample deviation of the frames, two
/// passes in double, then all voxels scaled to [0,1].
std::vector<double> publishedVolatility(TimeSeries& base, int frame, int n, int missing = -1) {
    std::vector<std::vector<double>> frames;
    for (int f = std::max(0, frame - n + 1); f <= frame; ++f) {
        if (f == missing) continue;
        const auto volume = base.load(f);
        const ValueRange range = volume->dataRange();
        std::vector<double>& scaled = frames.emplace_back();
        for (std::size_t i = 0; i < volume->size(); ++i)
            scaled.push_back((volume->value(i) - range.lo) / (range.hi - range.lo));
    }
    std::vector<double> deviations;
    for (std::size_t i = 0; i < frames.front().size(); ++i) {
        double mean = 0, sum = 0;
        for (const auto& f : frames) mean += f[i] / static_cast<double>(frames.size());
        for (const auto& f : frames) sum += (f[i] - mean) * (f[i] - mean);
        deviations.push_back(std::sqrt(sum / static_cast<double>(frames.size() - 1)));
    }
    const auto [lo, hi] = std::minmax_element(deviations.begin(), deviations.end());
    const double from = *lo, width = *hi - *lo;
    for (double& d : deviations) d = (d - from) / width;
    return deviations;
}

} // namespace

TEST_CASE("published volatility is the sample deviation of frames scaled each, stretched", "[derived][published]") {
    for (const int missing : {-1, 3}) {
        const auto base = noise(12, missing);
        for (const int n : {2, 5, 10, 40}) {
            const auto series = derive(base, volatility(n), {}, VolatilityKind::Published);
            CHECK(series->range() == ValueRange{0, 1});
            for (const int frame : {1, 4, 11}) {
                const auto volume = series->load(frame);
                const auto expected = publishedVolatility(*base, frame, n, missing);
                if (frame == 4 && n == 2 && missing == 3) continue; // one frame alone, below
                for (std::size_t i = 0; i < volume->size(); ++i)
                    CHECK(volume->value(i) == Approx(expected[i]).margin(1e-5));
                CHECK(volume->dataRange() == ValueRange{0, 1});
            }
        }
    }
    // A single frame does not deviate.
    CHECK(derive(noise(5), volatility(4), {}, VolatilityKind::Published)->load(0)->dataRange() == ValueRange{0, 0});
    CHECK(derive(noise(5, 3), volatility(2), {}, VolatilityKind::Published)->load(4)->dataRange() == ValueRange{0, 0});
}

TEST_CASE("published volatility of three voxels by hand", "[derived][published]") {
    // Frames (0, 1, 4) and (10, 14, 14), each scaled by itself: (0, 1/4, 1) and (0, 1, 1). Two values a and b have the
    // sample deviation |a - b|/√2: (0, 3/4, 0)/√2, stretched (0, 1, 0). The third frame (2, 0, 1) is (1, 0, 1/2): of
    // the latest three the voxels have (0, 0, 1), (1/4, 1, 0), (1, 1, 1/2). Their means are 1/3, 5/12 and 5/6, the
    // sums of squares 2/3, (1/36 + 49/144 + 25/144) = 13/24 and 1/6, the variances over n - 1 = 2: 1/3, 13/48, 1/12.
    const std::vector<std::vector<float>> frames{{0, 1, 4}, {10, 14, 14}, {2, 0, 1}};
    SeriesListing listing;
    listing.title = "three voxels";
    for (int f = 0; f < 3; ++f) listing.frames.push_back({{}, static_cast<double>(f), "step"});
    const auto base = std::make_shared<TimeSeries>(std::move(listing), [frames](int f, const JobControl&) {
        Geometry g;
        g.dims = {3, 1, 1};
        return Volume(g, SampleArray<float>(std::vector<float>(frames[static_cast<std::size_t>(f)])));
    });
    const auto series = derive(base, volatility(3), {}, VolatilityKind::Published);
    const auto second = series->load(1), third = series->load(2);
    for (const std::size_t i : {0u, 2u}) CHECK(second->value(i) == Approx(0).margin(1e-6));
    CHECK(second->value(1) == Approx(1));
    const double a = std::sqrt(1.0 / 3), b = std::sqrt(13.0 / 48), c = std::sqrt(1.0 / 12);
    CHECK(third->value(0) == Approx(1));
    CHECK(third->value(1) == Approx((b - c) / (a - c)).margin(1e-6));
    CHECK(third->value(2) == Approx(0).margin(1e-6));
}

TEST_CASE("the gradient's magnitude of a ramp is its slope, of normalised values per d0", "[derived]") {
    // X = 3x + 4y in a world of spacing (2, 1, 0.5): a slope of 5 per world unit everywhere, 2.5 per d0 = 0.5.
    Geometry g;
    g.dims = {6, 5, 4};
    g.spacing = {2, 1, 0.5};
    SeriesListing listing;
    listing.frames.resize(1);
    const auto base = std::make_shared<TimeSeries>(listing, [g](int, const JobControl&) {
        std::vector<float> values;
        for (int k = 0; k < 4; ++k)
            for (int j = 0; j < 5; ++j)
                for (int i = 0; i < 6; ++i) values.push_back(static_cast<float>(3 * 2 * i + 4 * j));
        return Volume(g, SampleArray<float>(std::move(values)));
    });
    const double range = 3 * 10 + 4 * 4; // of all values
    const auto volume = derive(base, {Derivation::Kind::Gradient, "x", 10, 0})->load(0);
    for (std::size_t i = 0; i < volume->size(); ++i) CHECK(volume->value(i) == Approx(2.5 / range).epsilon(1e-6));
}

TEST_CASE("the difference to a frame has zero in the middle of its window", "[derived]") {
    const auto base = noise(6);
    const auto series = derive(base, {Derivation::Kind::Difference, "x", 10, 2});
    const auto volume = series->load(5);
    for (std::size_t i = 0; i < volume->size(); ++i)
        CHECK(volume->value(i) == Approx(base->load(5)->value(i) - base->load(2)->value(i)).margin(1e-6));
    CHECK(series->load(2)->dataRange() == ValueRange{0, 0});
    const ValueRange range = series->range();
    CHECK(range.lo == -range.hi);
    CHECK(range.hi == Approx(base->range().hi - base->range().lo));
    CHECK_THROWS_WITH(derive(base, {Derivation::Kind::Difference, "x", 10, 6}), Contains("no frame 6"));
}

TEST_CASE("derivations are named as they are written", "[derived]") {
    for (const char* text : {"gradient:x", "volatility:x:10", "difference:rain:0", "volatility:gradient:x:3"}) {
        const auto derivation = parseDerivation(text);
        REQUIRE(derivation);
        CHECK(derivation->text() == text);
    }
    CHECK(parseDerivation("volatility:gradient:x:3")->of == "gradient:x");
    CHECK_FALSE(parseDerivation("x"));
    CHECK_FALSE(parseDerivation("cloud:1"));
    for (const char* wrong : {"gradient:", "volatility:x", "volatility:x:0", "volatility::3", "difference:x:-1"})
        CHECK_THROWS_AS(parseDerivation(wrong), UsageError);
}

TEST_CASE("a volume is resampled where its voxels lie in the world", "[derived]") {
    // X = x + 10y in the world; on another grid, turned by a quarter and finer, it is the same function.
    Geometry coarse;
    coarse.dims = {5, 5, 3};
    std::vector<float> values;
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 5; ++j)
            for (int i = 0; i < 5; ++i) values.push_back(static_cast<float>(i + 10 * j));
    const Volume volume(coarse, SampleArray<float>(std::move(values)));
    Geometry fine;
    fine.dims = {6, 7, 4};
    fine.spacing = {0.5, 0.5, 0.5};
    fine.origin = {3.5, 0.25, 0.5};
    fine.directions = Mat3(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
    const Volume out = resampledTo(volume, fine);
    CHECK(onSameGrid(out.geometry(), fine));
    CHECK_FALSE(onSameGrid(coarse, fine));
    std::size_t index = 0;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 7; ++j)
            for (int i = 0; i < 6; ++i, ++index) {
                const Vec3 at = fine.worldFromVoxel({i, j, k});
                INFO(at.x << ' ' << at.y << ' ' << at.z);
                CHECK(out.value(index) == Approx(at.x + 10 * at.y).margin(1e-5));
            }
    // The same grid in micrometres, of data in millimetres.
    Geometry inMm = coarse, inMicrons = inUnit(fine, LengthUnit::Micrometre);
    inMm.lengthUnit = LengthUnit::Millimetre;
    CHECK(inMicrons.spacing == fine.spacing); // of no unit: nothing to convert
    inMicrons.lengthUnit = LengthUnit::Micrometre;
    inMicrons.spacing *= 1000;
    inMicrons.origin *= 1000;
    const Volume same = resampledTo(volume.withGeometry(inMm), inMicrons);
    for (std::size_t i = 0; i < same.size(); ++i) CHECK(same.value(i) == Approx(out.value(i)).margin(1e-5));
    CHECK(onSameGrid(inUnit(inMicrons, LengthUnit::Millimetre), fine));
    fine.origin.x = -2; // the columns of the last ones lie beyond the box
    CHECK(resampledTo(volume, fine).invalidCount() > 0);
}
