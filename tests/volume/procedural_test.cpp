#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "volume/analytic.h"
#include "volume/noise.h"
#include "volume/procedural.h"

using namespace pellucid;
using Catch::Matchers::Contains;

namespace {

double valueAt(const Volume& volume, int i, int j, int k) {
    const Int3 d = volume.dims();
    return volume.value(static_cast<std::size_t>(i) +
                        static_cast<std::size_t>(d.x) * (static_cast<std::size_t>(j) +
                                                         static_cast<std::size_t>(d.y) * static_cast<std::size_t>(k)));
}

/// Share of the voxels whose value lies in [lo, hi).
double share(const Volume& volume, double lo, double hi) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < volume.size(); ++i) count += volume.value(i) >= lo && volume.value(i) < hi ? 1 : 0;
    return static_cast<double>(count) / static_cast<double>(volume.size());
}

} // namespace

TEST_CASE("the samples are listed and made in their default size", "[samples]") {
    std::vector<std::string> names;
    for (const SampleInfo& info : samples()) names.push_back(info.name);
    CHECK(names == std::vector<std::string>{"disks", "shells", "knee", "vortex", "smoke", "hurricane",
                                            "hurricane/precipitation", "hurricane/wind", "hurricane/ground"});
    CHECK(makeSample("disks").dims() == Int3(64));
    CHECK(makeSample("shells").dims() == Int3(96));
    CHECK(samples()[2].defaultDims == Int3(379, 229, 305));
    CHECK_THROWS_WITH(makeSample("cow"), Contains("disks, shells, knee"));
    for (const int bad : {-1, 7, 1 << 20}) CHECK_THROWS_AS(makeSample("disks", bad), UsageError);
}

TEST_CASE("samples come in any size, in proportion", "[samples]") {
    for (const SampleInfo& info : samples()) {
        for (const int size : {8, 17, 50}) {
            CAPTURE(info.name, size);
            const Volume volume = makeSample(info.name, size);
            const Int3 d = volume.dims();
            CHECK(std::max({d.x, d.y, d.z}) == size);
            const Int3 usual = info.defaultDims;
            const double scale = size / double(std::max({usual.x, usual.y, usual.z}));
            for (int a = 0; a < 3; ++a) // one layer stays one
                CHECK(std::abs(d[a] - std::max(1.0, usual[a] * scale)) <= 0.5);
            CHECK(!volume.isConstant());
            // Below its ground a hurricane has no values.
            if (!info.name.starts_with("hurricane")) CHECK(volume.invalidCount() == 0);
            CHECK(volume.format == "sample");
            CHECK(volume.title == info.name);
        }
    }
    // The knee is as large in mm as ever: 379 voxels of 0.5 mm.
    CHECK(makeSample("knee", 50).geometry().spacing.x == Approx(0.5 * 379 / 50));
}

TEST_CASE("a sample has the same bits with one thread and with three, others with another seed", "[samples]") {
    for (const char* name : {"disks", "shells", "knee"}) {
        CAPTURE(name);
        setThreadCount(1);
        const Volume one = makeSample(name, 40, 5);
        setThreadCount(3);
        const Volume three = makeSample(name, 40, 5);
        setThreadCount(0);
        CHECK(one.samples() == three.samples());
        if (std::string(name) != "disks") CHECK(makeSample(name, 40, 6).samples() != one.samples());
    }
}

TEST_CASE("three disks stand one behind the other along x, at the centres of three tents", "[samples]") {
    const Volume disks = makeSample("disks");
    CHECK(disks.sampleType() == SampleType::U8);
    std::vector<double> seen; // along the middle row, each run of equal values once
    for (int i = 0; i < 64; ++i)
        if (const double v = valueAt(disks, i, 32, 32); seen.empty() || seen.back() != v) seen.push_back(v);
    CHECK(seen == std::vector<double>{0, 42, 0, 126, 0, 210, 0});
    CHECK(disks.intensityOfValue(42) == Approx(1.0 / 6));
    CHECK(disks.intensityOfValue(126) == Approx(0.5));
    CHECK(disks.intensityOfValue(210) == Approx(5.0 / 6));
    // Equal disks: the same voxels in each of the three, nothing between.
    CHECK(share(disks, 42, 43) == share(disks, 126, 127));
    CHECK(share(disks, 42, 43) == share(disks, 210, 211));
    CHECK(share(disks, 0, 1) + 3 * share(disks, 42, 43) == Approx(1.0));
    CHECK(valueAt(disks, 16, 32, 32) == 42); // the disk in front from the left, −x
    CHECK(valueAt(disks, 16, 2, 32) == 0);
}

TEST_CASE("shells are nested: brighter toward the middle, the core inside all", "[samples]") {
    const Volume shells = makeSample("shells");
    CHECK(shells.range() == ValueRange{0, 255});
    CHECK(shells.dataRange() == ValueRange{0, 255});
    // Feature ranges of three tents: 1/30 … 0.3, 11/30 … 19/30, 0.7 … 29/30 of 255; each holds something.
    const double outer = share(shells, 8.5, 76.5), middle = share(shells, 93.5, 161.5),
                 core = share(shells, 178.5, 246.5);
    CHECK(core > 0.004);
    CHECK(middle > core);
    CHECK(outer > middle);
    // Mean value by distance from the middle, in steps of 0.2 of the half width: falls all the way to nothing.
    std::array<double, 6> sum{}, count{};
    for (int k = 0; k < 96; ++k)
        for (int j = 0; j < 96; ++j)
            for (int i = 0; i < 96; ++i) {
                const double r = std::sqrt(std::pow(i - 47.5, 2) + std::pow(j - 47.5, 2) + std::pow(k - 47.5, 2)) / 48;
                if (r >= 1.2) continue;
                sum[static_cast<std::size_t>(r / 0.2)] += valueAt(shells, i, j, k);
                ++count[static_cast<std::size_t>(r / 0.2)];
            }
    for (std::size_t ring = 1; ring < sum.size(); ++ring)
        CHECK(sum[ring] / count[ring] < sum[ring - 1] / count[ring - 1]);
    CHECK(sum[5] == 0.0);
    CHECK(valueAt(shells, 48, 48, 48) > 178);
    CHECK(valueAt(shells, 0, 0, 0) == 0);
}

TEST_CASE("the knee has its tissues", "[samples]") {
    const Volume knee = makeSample("knee", 120);
    CHECK(knee.sampleType() == SampleType::I16);
    CHECK(share(knee, -1024, -900) > 0.3); // air
    CHECK(share(knee, -150, -40) > 0.04);  // fat
    CHECK(share(knee, 0, 110) > 0.2);      // muscle
    CHECK(share(knee, 200, 400) > 0.02);   // cancellous bone
    CHECK(share(knee, 900, 1400) > 0.004); // cortical bone
    // Noise of 15 HU in the air of a corner: standard deviation over 10³ voxels within 10 %; clipping at −1024 takes
    // some.
    double sum = 0, squares = 0;
    for (int k = 0; k < 10; ++k)
        for (int j = 0; j < 10; ++j)
            for (int i = 0; i < 10; ++i) {
                const double v = valueAt(knee, i, j, k) + 1000;
                sum += v / 1000;
                squares += v * v / 1000;
            }
    CHECK(std::abs(sum) < 2);
    CHECK(std::sqrt(squares - sum * sum) == Approx(15).epsilon(0.1));
}

TEST_CASE("noise has the mean and deviation it says, and depends on place and seed", "[samples]") {
    double sum = 0, squares = 0, lag = 0;
    constexpr int n = 100000; // standard error of the mean 1/√n = 0.0032
    for (int i = 0; i < n; ++i) {
        const double v = whiteNoise(i, -3, 7, 1);
        sum += v;
        squares += v * v;
        lag += v * whiteNoise(i + 1, -3, 7, 1);
    }
    CHECK(std::abs(sum / n) < 0.015);
    CHECK(squares / n == Approx(1).epsilon(0.02));
    CHECK(std::abs(lag / n) < 0.015);
    CHECK(whiteNoise(1, 2, 3, 1) != whiteNoise(1, 2, 3, 2));
    std::set<double> values;
    for (int i = 0; i < 200; ++i) {
        const double v = smoothNoise({0.1 * i, -0.3, 5}, 1);
        CHECK(std::abs(v) <= 1);
        CHECK(std::abs(v - smoothNoise({0.1 * i + 1e-6, -0.3, 5}, 1)) < 1e-5); // continuous, across the lattice too
        values.insert(v);
    }
    CHECK(values.size() > 190);
}

TEST_CASE("the gradients of the analytic fields match central differences", "[samples]") {
    const auto ball = [](const Vec3& p) { return gaussianBall(p, {1, -2, 0.5}, 1.7); };
    const auto wave = [](const Vec3& p) { return planeWave(p, {0.8, -1.1, 0.3}); };
    constexpr double h = 1e-4; // error of the difference about h²·f''' < 1e-8
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, -2, 0.5), Vec3(2.5, -1, 1)})
        for (int a = 0; a < 3; ++a) {
            Vec3 step(0);
            step[a] = h;
            CHECK(ball(p).gradient[a] == Approx((ball(p + step).value - ball(p - step).value) / (2 * h)).margin(1e-7));
            CHECK(wave(p).gradient[a] == Approx((wave(p + step).value - wave(p - step).value) / (2 * h)).margin(1e-7));
        }
    const Volume volume = sampleField({{3, 1, 1}, {0.5, 1, 1}, {1, -2, 0.5}}, ball);
    CHECK(volume.value(0) == 1.0);
    CHECK(volume.value(2) == Approx(std::exp(-1 / (2 * 1.7 * 1.7)))); // one unit from the middle
}
