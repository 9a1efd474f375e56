// What the fast engines read: intensity codes and histograms.
#include <limits>
#include <numeric>

#include <catch2/catch.hpp>

#include "base/parallel.h"
#include "volume/histogram.h"
#include "volume/intensity_grid.h"
#include "volume/procedural.h"

using namespace pellucid;

namespace {

template <class T>
Volume lineOf(std::vector<T> values) {
    const int n = static_cast<int>(values.size());
    return Volume({{n, 1, 1}, {1, 1, 1}, {0, 0, 0}}, std::move(values));
}

} // namespace

TEST_CASE("codes of 8-bit data are exact multiples of the value", "[intensity]") {
    std::vector<std::uint8_t> values(256);
    std::iota(values.begin(), values.end(), std::uint8_t{0});
    const IntensityGrid grid = makeIntensityGrid(lineOf(values));
    CHECK(grid.maxCode == 65535); // 257 · 255
    CHECK(grid.valid.empty());
    for (std::size_t i = 0; i < 256; ++i) CHECK(grid.codes[i] == 257 * i);
}

TEST_CASE("codes of an integer window are exact", "[intensity]") {
    // Window −1000 … 2000 spans 3000 values: ⌊65535 / 3000⌋ = 21 codes a value, maxCode 63000.
    const Volume volume =
        lineOf(std::vector<std::int16_t>{-1024, -1000, -999, 0, 1234, 2000, 3000}).withRange({-1000, 2000});
    const IntensityGrid grid = makeIntensityGrid(volume);
    CHECK(grid.maxCode == 63000);
    const std::uint16_t expected[] = {0, 0, 21, 21000, 46914, 63000, 63000}; // 46914 = 21 · 2234
    for (std::size_t i = 0; i < 7; ++i) CHECK(grid.codes[i] == expected[i]);
}

TEST_CASE("codes of 16-bit data over its whole range are the values themselves", "[intensity]") {
    std::vector<std::uint16_t> values(65536);
    std::iota(values.begin(), values.end(), std::uint16_t{0});
    const IntensityGrid grid = makeIntensityGrid(lineOf(values));
    CHECK(grid.maxCode == 65535);
    CHECK(std::equal(values.begin(), values.end(), grid.codes.wide()));
}

TEST_CASE("codes of floats are intensities rounded to 1/64000, invalid voxels are marked", "[intensity]") {
    const Volume volume = lineOf(std::vector<float>{0, 1, 0.25f, NAN, 0.7071f});
    const IntensityGrid grid = makeIntensityGrid(volume);
    CHECK(grid.maxCode == 64000);
    CHECK(grid.codes[0] == 0);
    CHECK(grid.codes[1] == 64000);
    CHECK(grid.codes[2] == 16000);
    CHECK(grid.codes[3] == 0);
    CHECK(std::abs(grid.codes[4] / 64000.0 - static_cast<double>(0.7071f)) <= 0.5 / 64000.0 + 1e-12);
    CHECK(grid.valid == std::vector<std::uint8_t>{1, 1, 1, 0, 1});
}

TEST_CASE("borders of bins and decimals of three digits are codes of floats", "[intensity]") {
    // A label map stored as floats: whoever makes a feature begin at a label finds the label in it.
    std::vector<float> values{0, 1};
    std::vector<double> wanted{0, 1};
    for (int i = 1; i < 256; ++i) wanted.push_back(i / 256.0);
    for (int i = 1; i < 1000; ++i) wanted.push_back(i / 1000.0);
    for (std::size_t i = 2; i < wanted.size(); ++i) values.push_back(static_cast<float>(wanted[i]));
    const IntensityGrid grid = makeIntensityGrid(lineOf(values));
    for (std::size_t i = 0; i < wanted.size(); ++i)
        CHECK(static_cast<double>(grid.codes[i]) / grid.maxCode == wanted[i]);
}

TEST_CASE("a constant volume has intensity 0 everywhere", "[intensity]") {
    const IntensityGrid grid = makeIntensityGrid(lineOf(std::vector<std::uint8_t>{9, 9, 9}));
    CHECK(grid.codes[0] == 0);
    CHECK(grid.codes[2] == 0);
    CHECK(grid.maxCode >= 1);
}

TEST_CASE("histogram bins are floor(256 s), the last one closed", "[histogram]") {
    CHECK(histogramBin(0.0, 256) == 0);
    CHECK(histogramBin(std::nextafter(1.0 / 256, 0.0), 256) == 0);
    CHECK(histogramBin(1.0 / 256, 256) == 1);
    CHECK(histogramBin(0.5, 256) == 128);
    CHECK(histogramBin(1.0, 256) == 255);
    // s = v/255: 254 → ⌊254.996⌋ = 254, so that only 255 shares no bin.
    std::vector<std::uint8_t> values(256);
    std::iota(values.begin(), values.end(), std::uint8_t{0});
    const Histogram all = makeHistogram(lineOf(values));
    for (std::size_t b = 0; b < 256; ++b) CHECK(all.counts[b] == 1);
    CHECK(all.total == 256);
    CHECK(all.p(7) == 1.0 / 256);
}

TEST_CASE("the histogram counts valid voxels only, in the window", "[histogram]") {
    const Volume volume = lineOf(std::vector<float>{-5, 0, 0.5f, 1, 7, NAN, INFINITY}).withRange({0, 1});
    const Histogram histogram = makeHistogram(volume, 4);
    CHECK(histogram.counts == std::vector<std::uint64_t>{2, 0, 1, 2});
    CHECK(histogram.total == 5);
    const Histogram empty = makeHistogram(lineOf(std::vector<float>{NAN, NAN}));
    CHECK(empty.total == 0);
    CHECK(empty.p(0) == 0.0);
}

TEST_CASE("histogram and codes are the same with one thread and with three", "[histogram][intensity]") {
    const Volume volume = makeSample("shells", 40);
    setThreadCount(1);
    const Histogram one = makeHistogram(volume, 1000);
    const IntensityGrid gridOne = makeIntensityGrid(volume);
    setThreadCount(3);
    const Histogram three = makeHistogram(volume, 1000);
    const IntensityGrid gridThree = makeIntensityGrid(volume);
    setThreadCount(0);
    CHECK(one.counts == three.counts);
    CHECK(one.total == volume.size());
    CHECK(std::equal(gridOne.codes.wide(), gridOne.codes.wide() + gridOne.codes.size(), gridThree.codes.wide()));
}

TEST_CASE("a window wider than the largest double has finite intensities", "[volume]") {
    const double most = std::numeric_limits<double>::max(); // hi − lo overflows
    const Volume volume(Geometry{{3, 1, 1}}, Samples(std::vector<double>{-most, 0, most}));
    CHECK(volume.intensity(0) == 0.0);
    CHECK(volume.intensity(1) == 0.5);
    CHECK(volume.intensity(2) == 1.0);
}

TEST_CASE("codes of large and of small volumes of 8 and 16 bits are the same", "[intensity]") {
    // A large volume has its codes from a table of all values.
    const auto check = [](const auto& values, const ValueRange& window, std::optional<double> missing) {
        using Values = std::decay_t<decltype(values)>;
        const int n = static_cast<int>(values.size());
        const Volume small = Volume({{n, 1, 1}, {1, 1, 1}, {0, 0, 0}}, values, missing).withRange(window);
        Values many;
        const int copies = 70000 / n + 1;
        for (int c = 0; c < copies; ++c) many.insert(many.end(), values.begin(), values.end());
        const Volume large = Volume({{n, copies, 1}, {1, 1, 1}, {0, 0, 0}}, many, missing).withRange(window);
        const IntensityGrid one = makeIntensityGrid(small, CodeWidth::Wide),
                            all = makeIntensityGrid(large, CodeWidth::Wide);
        REQUIRE(one.maxCode == all.maxCode);
        REQUIRE(one.valid.empty() == all.valid.empty());
        bool same = true;
        for (std::size_t i = 0; i < many.size(); ++i) {
            same = same && all.codes[i] == one.codes[i % values.size()];
            if (!one.valid.empty()) same = same && all.valid[i] == one.valid[i % values.size()];
        }
        CHECK(same);
    };
    const std::vector<std::int16_t> ct{-32768, -1024, -1000, -1, 0, 1, 40, 1234, 32767};
    check(ct, {-1000, 1234}, {});
    check(ct, {-1000.5, 2000.25}, {});
    check(ct, {-1000, 1234}, 40.0);
    check(std::vector<std::uint16_t>{0, 1, 999, 32768, 65535}, {0, 65535}, {});
    check(std::vector<std::int8_t>{-128, -1, 0, 1, 127}, {-100, 100}, -1.0);
    check(std::vector<std::uint8_t>{0, 1, 128, 255}, {0, 255}, {});
}
