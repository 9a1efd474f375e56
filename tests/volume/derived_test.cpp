#include "volume/derived.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "volume/noise.h"

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
    CHECK(derive(base, volatility(10))->range() == ValueRange{0, 0.5}); // without reading a frame
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
    fine.origin.x = -2; // the columns of the last ones lie beyond the box
    CHECK(resampledTo(volume, fine).invalidCount() > 0);
}
