// The automatic start: kinds of data, windows, borders, and a transfer function that can be used as it is.
#include "tf/proposal.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <utility>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "tf/formats/tf_json.h"
#include "volume/loader.h"
#include "volume/procedural.h"

using namespace pellucid;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A cube of n³ voxels of T: valueAt(r, p), p in [−1, 1]³, r its length.
template <class T, class ValueAt>
Volume cubeOf(int n, ValueAt&& valueAt) {
    std::vector<T> values;
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const Vec3 p = (Vec3(i, j, k) + 0.5) / static_cast<double>(n) * 2.0 - 1.0;
                values.push_back(static_cast<T>(valueAt(std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z), p)));
            }
    return Volume(Geometry{{n, n, n}, {1, 1, 1}, {0, 0, 0}}, Samples(std::move(values)));
}

/// A ball of radius 0.7 of value 0.5 with a core of radius 0.4 of value 0.9, edges over a few voxels, soft noise.
class Ball {
public:
    double operator()(double r, const Vec3&) {
        const auto inside = [r](double radius) { return 1 / (1 + std::exp((r - radius) * 40)); };
        return std::clamp(0.5 * inside(0.7) + 0.4 * inside(0.4) + m_noise(m_random), 0.0, 1.0);
    }

private:
    std::mt19937 m_random{5};
    std::normal_distribution<double> m_noise{0, 0.01};
};

/// What holds for every proposal.
void checkSound(const Proposal& p) {
    CHECK_NOTHROW(p.tf.validate());
    CHECK(p.window.lo < p.window.hi);
    REQUIRE(p.tf.range);
    CHECK(*p.tf.range == p.window);
    CHECK(p.outside >= 0);
    CHECK(p.outside <= 1);
    CHECK_FALSE(p.why.empty());
    REQUIRE_FALSE(p.features.empty());
    for (const ControlPoint& point : p.tf.points) CHECK(point.fixed == (point.opacity == 0)); // out stays out
    CHECK(p.features.size() <= (p.kind == DataKind::Labels ? 12u : 5u));
    REQUIRE(p.tf.features.size() == p.features.size());
    const auto intensity = [&](double v) { return (v / 2 - p.window.lo / 2) / (p.window.hi / 2 - p.window.lo / 2); };
    const std::vector<double> peaks = featureOpacities(p.tf);
    for (std::size_t f = 0; f < p.features.size(); ++f) {
        const ProposedFeature& x = p.features[f];
        CAPTURE(f, x.name, x.lo, x.mode, x.hi);
        CHECK_FALSE(x.name.empty());
        CHECK(x.name == p.tf.features[f].name);
        CHECK(x.lo < x.hi);
        CHECK(x.mode >= x.lo);
        CHECK(x.mode <= x.hi);
        CHECK(x.inside >= 0);
        CHECK(x.inside <= 1);
        CHECK(peaks[f] > 0);
        CHECK(peaks[f] < 1);
        CHECK(p.tf.features[f].a == Approx(intensity(x.lo)).margin(1e-9));
        CHECK(p.tf.features[f].b == Approx(intensity(x.hi)).margin(1e-9));
        // No hole in it, and its typical value has its full opacity.
        const double a = p.tf.features[f].a, b = p.tf.features[f].b;
        for (int i = 1; i < 20; ++i) CHECK(p.tf.opacity(a + (b - a) * i / 20) > 0);
        CHECK(p.tf.opacity(intensity(x.mode)) == Approx(peaks[f]));
        if (f == 0) continue;
        const bool meets = p.features[f - 1].hi == x.lo;
        const bool about = p.background && p.features[f - 1].hi == p.background->lo && x.lo == p.background->hi;
        CHECK((meets || about));
        if (meets) CHECK(p.tf.opacity(a) > 0);
    }
    if (p.background) {
        CHECK(p.background->lo < p.background->hi);
        for (int i = 0; i <= 20; ++i) {
            const double a = intensity(p.background->lo), b = intensity(p.background->hi);
            CHECK(p.tf.opacity(a + (b - a) * i / 20) == Approx(0).margin(1e-12));
        }
    } else {
        CHECK(p.features.front().lo == p.window.lo);
        CHECK(p.features.back().hi == p.window.hi);
    }
    // As a file it is the same.
    CHECK(tfFromJson(jsonFromTf(p.tf), "proposal") == p.tf);
}

void checkBorder(double found, double known, double range) {
    CAPTURE(found, known, range);
    CHECK(std::abs(found - known) <= 0.02 * range);
}

/// Borders from below: of the background with the first feature, then between features.
std::vector<double> bordersOf(const Proposal& p) {
    std::vector<double> borders;
    for (const ProposedFeature& f : p.features) borders.push_back(f.lo);
    return borders;
}

} // namespace

TEST_CASE("two materials before a background, borders half-way", "[proposal]") {
    const Proposal p = propose(cubeOf<float>(48, Ball()));
    checkSound(p);
    CHECK(p.kind == DataKind::Continuous);
    CHECK(p.unit.empty());
    REQUIRE(p.background);
    REQUIRE(p.features.size() == 2);
    checkBorder(p.features[0].lo, 0.25, 1);
    checkBorder(p.features[1].lo, 0.7, 1);
    checkBorder(p.features[0].mode, 0.5, 1);
    checkBorder(p.features[1].mode, 0.9, 1);
    // Volumes of balls: π/6·r³ of the cube.
    CHECK(p.features[1].share == Approx(0.5236 * 0.4 * 0.4 * 0.4).margin(0.01));
    CHECK(p.features[0].share == Approx(0.5236 * (0.343 - 0.064)).margin(0.02));
    // The core is inside and rarer: a d0 of it hides more.
    CHECK(p.features[0].inside == 0);
    CHECK(p.features[1].inside == 1);
    const std::vector<double> opacity = featureOpacities(p.tf);
    CHECK(opacity[1] > 2 * opacity[0]);
}

TEST_CASE("a proposal is the same with any number of threads", "[proposal]") {
    const Volume volume = cubeOf<float>(80, Ball()); // more voxels than the survey has cells
    setThreadCount(1);
    const Proposal one = propose(volume);
    setThreadCount(3);
    const Proposal three = propose(volume);
    setThreadCount(0);
    CHECK(one.tf == three.tf);
    CHECK(one.why == three.why);
    CHECK(one.window == three.window);
}

TEST_CASE("values upside down: the background is the highest", "[proposal]") {
    Ball ball;
    const Proposal p = propose(cubeOf<float>(48, [&](double r, const Vec3& v) { return 1 - ball(r, v); }));
    checkSound(p);
    REQUIRE(p.background);
    CHECK(p.background->hi == p.window.hi);
    checkBorder(p.background->lo, 0.75, 1);
    REQUIRE(p.features.size() == 2);
    checkBorder(p.features[0].hi, 0.3, 1);
}

TEST_CASE("one voxel of a million changes nothing but the range", "[proposal]") {
    Ball ball;
    bool first = true;
    const Proposal p = propose(cubeOf<float>(48, [&](double r, const Vec3& v) {
        const double value = ball(r, v);
        return std::exchange(first, false) ? 1e6 : value;
    }));
    checkSound(p);
    CHECK(p.window.hi < 1.2);
    CHECK(p.outside == Approx(1.0 / (48 * 48 * 48)));
    REQUIRE(p.features.size() == 2);
    checkBorder(p.features[0].lo, 0.25, 1);
    checkBorder(p.features[1].lo, 0.7, 1);
}

TEST_CASE("invalid voxels count nowhere, a filler is background", "[proposal]") {
    Ball ball;
    const Proposal holes =
        propose(cubeOf<float>(48, [&](double r, const Vec3& v) { return v.x < -0.3 ? kNaN : ball(r, v); }));
    checkSound(holes);
    REQUIRE(holes.features.size() == 2);
    checkBorder(holes.features[1].lo, 0.7, 1);

    const Proposal filled =
        propose(cubeOf<float>(48, [&](double r, const Vec3& v) { return r > 0.8 ? -9999 : 1 + ball(r, v); }));
    checkSound(filled);
    CHECK(filled.window.lo > 0.5);
    CHECK(filled.window.hi < 2.2);
    CHECK(filled.outside > 0.5);
    REQUIRE(filled.background);
    CHECK(filled.background->lo == filled.window.lo);
}

TEST_CASE("a tiny range about a large value", "[proposal]") {
    Ball ball;
    const Proposal p = propose(cubeOf<double>(48, [&](double r, const Vec3& v) { return 1 + 1e-9 * ball(r, v); }));
    checkSound(p);
    REQUIRE(p.features.size() == 2);
    checkBorder(p.features[0].lo - 1, 0.25e-9, 1e-9);
    checkBorder(p.features[1].lo - 1, 0.7e-9, 1e-9);
    CHECK(p.features[0].name == "low");
    CHECK(p.features[1].name == "high");
}

TEST_CASE("constant, empty and binary volumes", "[proposal]") {
    const Proposal constant = propose(cubeOf<float>(8, [](double, const Vec3&) { return 7; }));
    checkSound(constant);
    CHECK(constant.kind == DataKind::Constant);
    CHECK(constant.features.front().name == "value 7");
    CHECK(constant.window.lo < 7);
    CHECK(constant.window.hi > 7);

    const Proposal empty = propose(cubeOf<float>(8, [](double, const Vec3&) { return kNaN; }));
    checkSound(empty);
    CHECK(empty.kind == DataKind::Empty);

    const Proposal binary = propose(cubeOf<std::uint8_t>(24, [](double r, const Vec3&) { return r < 0.6 ? 200 : 40; }));
    checkSound(binary);
    CHECK(binary.kind == DataKind::Binary);
    REQUIRE(binary.features.size() == 1);
    CHECK(binary.features[0].mode == 200);
    CHECK(binary.features[0].lo == 120);
    REQUIRE(binary.background);
    CHECK(*binary.background == ValueRange{40, 120});
}

TEST_CASE("labels have a feature each, borders half-way between them", "[proposal]") {
    const auto shells = [](double r, const Vec3& p) {
        return r > 0.85 ? 0 : r > 0.6 ? 1 : r > 0.3 ? (p.x < 0 ? 2 : 3) : 9;
    };
    const Proposal p = propose(cubeOf<std::int16_t>(40, shells));
    checkSound(p);
    CHECK(p.kind == DataKind::Labels);
    CHECK(bordersOf(p) == std::vector<double>{0.5, 1.5, 2.5, 6});
    CHECK(p.features[3].name == "value 9");
    CHECK(p.features[3].inside == 1);
    CHECK(*p.background == ValueRange{0, 0.5});

    // One voxel of a label of its own: no survey is needed to meet it.
    bool first = true;
    const Proposal rare = propose(cubeOf<std::uint8_t>(
        80, [&](double r, const Vec3& v) { return std::exchange(first, false) ? 40 : shells(r, v); }));
    checkSound(rare);
    CHECK(rare.kind == DataKind::Labels);
    CHECK(rare.features.back().mode == 40);

    // One wild voxel beside them, so far away that no picture could tell 0, 1, 2 and 3 apart: it lies beyond the
    // window.
    first = true;
    const Proposal wild = propose(cubeOf<float>(
        40, [&](double r, const Vec3& v) { return std::exchange(first, false) ? 1e6 : std::min(shells(r, v), 3); }));
    checkSound(wild);
    CHECK(wild.kind == DataKind::Labels);
    CHECK(wild.window == ValueRange{0, 3});
    CHECK(wild.outside == Approx(1.0 / (40 * 40 * 40)));
    CHECK(bordersOf(wild) == std::vector<double>{0.5, 1.5, 2.5});

    // More labels than features: neighbours share one.
    // 26 labels in slabs five voxels thick: three to each of nine features.
    const Proposal many = propose(cubeOf<std::uint8_t>(
        64, [](double, const Vec3& v) { return std::floor((v.x + 1) * 6.5) + 13 * (v.y > 0 ? 1 : 0); }));
    checkSound(many);
    CHECK(many.kind == DataKind::Labels);
    CHECK(many.features.size() == 9);
    CHECK(many.features.front().name == "values 0 to 2");
}

TEST_CASE("smooth whole numbers are no labels", "[proposal]") {
    // 0 … 60: each voxel differs from some neighbour.
    const Proposal p =
        propose(cubeOf<std::uint8_t>(32, [](double r, const Vec3&) { return std::max(0.0, 60 - 60 * r); }));
    checkSound(p);
    CHECK(p.kind == DataKind::Continuous);
}

TEST_CASE("values of both signs diverge about 0", "[proposal]") {
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, 1);
    const Proposal p = propose(cubeOf<float>(48, [&](double r, const Vec3& v) {
        if (r > 0.9) return 0.0;
        return noise(random) + (v.x > 0.4 ? 7 : v.x < -0.4 ? -6 : 0);
    }));
    checkSound(p);
    CHECK(p.kind == DataKind::Signed);
    CHECK(p.window.lo == -p.window.hi);
    REQUIRE(p.background);
    CHECK(p.background->lo == -p.background->hi);
    CHECK(p.tf.opacity(0.5) == 0);
    REQUIRE(p.features.size() == 4);
    CHECK(p.features[0].name == "strongly negative");
    CHECK(p.features[2].name == "positive");
    const auto isBlue = [](const Rgb& c) { return c.b > c.r + 0.2; };
    const auto isRed = [](const Rgb& c) { return c.r > c.b + 0.2; };
    CHECK(isBlue(p.tf.features[0].color));
    CHECK(isBlue(p.tf.features[1].color));
    CHECK(isRed(p.tf.features[2].color));
    CHECK(isRed(p.tf.features[3].color));
    const std::vector<double> opacity = featureOpacities(p.tf);
    CHECK(opacity[0] > opacity[1]);
    CHECK(opacity[3] > opacity[2]);
}

TEST_CASE("of a statistical map spots are drawn, and next to nothing of its noise", "[proposal]") {
    // The noise has a standard deviation of 1: 0.27 % of it lies beyond three, 4.6 % beyond two.
    std::mt19937 random(12);
    std::normal_distribution<double> noise(0, 1);
    std::vector<double> spot, rest;
    const Proposal p = propose(cubeOf<float>(48, [&](double r, const Vec3& v) {
        if (r > 0.9) return 0.0;
        const bool isSpot = glm::length(v - Vec3(0.3, 0, 0.2)) < 0.2;
        (isSpot ? spot : rest).push_back(isSpot ? 8 + 0.2 * noise(random) : noise(random));
        return (isSpot ? spot : rest).back();
    }));
    REQUIRE(p.kind == DataKind::Signed);
    const auto isDrawn = [&](double value) {
        return p.tf.opacity((value - p.window.lo) / (p.window.hi - p.window.lo)) > 0;
    };
    CHECK(std::ranges::all_of(spot, isDrawn));
    CHECK(static_cast<double>(std::ranges::count_if(rest, isDrawn)) < 0.005 * static_cast<double>(rest.size()));
}

TEST_CASE("CT: tissues between half-way borders, air left out, metal beyond the window", "[proposal][ct]") {
    std::mt19937 random(2);
    std::normal_distribution<double> noise(0, 12);
    const Proposal p = propose(cubeOf<std::int16_t>(64, [&](double r, const Vec3& v) {
        double hu = -1000;
        if (r < 0.9) hu = -100;
        if (r < 0.8) hu = 50;
        if (r < 0.5) hu = 1200;
        if (r < 0.42) hu = 300;
        if (glm::length(v - Vec3(0.6, 0, 0)) < 0.03) return 3071.0;
        return std::clamp(std::round(hu + noise(random)), -1024.0, 3071.0);
    }));
    checkSound(p);
    CHECK(p.kind == DataKind::Ct);
    CHECK(p.unit == "HU");
    CHECK(p.window.lo == -1024);
    CHECK(p.window.hi > 1200);
    CHECK(p.window.hi < 3000);
    CHECK(p.outside > 0);
    REQUIRE(p.features.size() == 4);
    CHECK(p.features[0].name == "skin and fat");
    CHECK(p.features[1].name == "soft tissue");
    CHECK(p.features[2].name == "bone");
    CHECK(p.features[3].name == "dense bone");
    const std::vector<double> known{-550, -25, 175, 750};
    for (std::size_t f = 0; f < 4; ++f) checkBorder(p.features[f].lo, known[f], 2300);
    const std::vector<double> opacity = featureOpacities(p.tf);
    CHECK(opacity[2] > 5 * opacity[1]);
}

TEST_CASE("CT of a chest has lungs, foam around a head is none", "[proposal][ct]") {
    const auto chest = [](double r, const Vec3& v) {
        if (r > 0.9) return -1000;
        if (std::abs(std::abs(v.x) - 0.4) < 0.25 && r < 0.75) return -850;
        return r < 0.3 ? 300 : 40;
    };
    const Proposal lungs = propose(cubeOf<std::int16_t>(48, [&](double r, const Vec3& v) {
        return chest(r, v) + 10 * std::sin(50 * v.y) + 10 * std::sin(70 * v.z + v.x);
    }));
    checkSound(lungs);
    CHECK(lungs.kind == DataKind::Ct);
    CHECK(lungs.features.front().name == "lung");
    const Proposal head = propose(cubeOf<std::int16_t>(48, [&](double r, const Vec3& v) {
        const double hu = r < 0.6 ? 40 : v.y > 0.5 && r < 1 ? -850 : -1000;
        return hu + 10 * std::sin(50 * v.y) + 10 * std::sin(70 * v.z + v.x);
    }));
    checkSound(head);
    CHECK(head.kind == DataKind::Ct);
    CHECK(head.features.front().name == "soft tissue"); // no voxel is skin or fat
    CHECK(head.features.back().name == "soft tissue");  // and no bone
}

TEST_CASE("a window that somebody has chosen stays", "[proposal]") {
    const Proposal p = propose(cubeOf<float>(32, Ball()).withRange({0.3, 0.8}));
    checkSound(p);
    CHECK(p.window == ValueRange{0.3, 0.8});
    CHECK(p.outside > 0.3);
}

TEST_CASE("odd volumes have an answer", "[proposal]") {
    const double inf = std::numeric_limits<double>::infinity();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1, 1);
    checkSound(propose(Volume(Geometry{{1, 1, 1}}, Samples(std::vector<float>{3}))));
    checkSound(propose(Volume(Geometry{{2, 1, 1}}, Samples(std::vector<float>{3, 4}))));
    checkSound(propose(Volume(Geometry{{3, 1, 1}}, Samples(std::vector<double>{-1.7e308, 0.5, 1.7e308}))));
    checkSound(propose(cubeOf<double>(12, [&](double, const Vec3&) { return 1.7e308 * any(random); })));
    checkSound(propose(cubeOf<double>(12, [&](double, const Vec3&) { return 1e-310 * any(random); })));
    checkSound(propose(cubeOf<double>(12, [&](double r, const Vec3&) { return r < 0.5 ? inf : any(random); })));
    checkSound(propose(cubeOf<float>(12, [&](double r, const Vec3&) { return r < 1.7 ? kNaN : 1.0f; })));
    checkSound(propose(cubeOf<std::uint8_t>(24, [&](double, const Vec3&) { return 255 * std::abs(any(random)); })));
    checkSound(propose(cubeOf<std::int8_t>(24, [&](double r, const Vec3&) { return 100 * std::cos(9 * r); })));
    checkSound(propose(cubeOf<std::uint32_t>(24, [](double r, const Vec3&) { return 4e9 / (1 + r); })));
    checkSound(propose(cubeOf<float>(24, [](double r, const Vec3&) { return r < 0.1 ? 1 + r : 0; })));
    std::vector<float> flat;
    for (int i = 0; i < 64 * 64; ++i) flat.push_back(static_cast<float>(any(random)));
    checkSound(propose(Volume(Geometry{{64, 64, 1}}, Samples(flat))));
    std::vector<float> neighbours; // three values that no float lies between
    for (int i = 0; i < 1000; ++i)
        neighbours.push_back(std::nextafter(1.0f, i % 3 == 0 ? 0.0f : i % 3 == 1 ? 1.0f : 2.0f));
    checkSound(propose(Volume(Geometry{{10, 10, 10}}, Samples(neighbours))));
}

// The samples' borders as procedural.cpp makes them: half-way between neighbouring materials.

TEST_CASE("disks: 42, 126, 210 of 0 … 252", "[proposal][samples]") {
    const Proposal p = propose(makeSample("disks", 0, 1));
    checkSound(p);
    CHECK(p.window == ValueRange{0, 252});
    CHECK(bordersOf(p) == std::vector<double>{21, 84, 168});
}

TEST_CASE("shells: plateaus at 1/6, 1/2, 5/6", "[proposal][samples]") {
    const Proposal p = propose(makeSample("shells", 0, 1));
    checkSound(p);
    const std::vector<double> borders = bordersOf(p);
    REQUIRE(borders.size() == 3);
    for (std::size_t b = 0; b < 3; ++b) checkBorder(borders[b], std::vector<double>{21.25, 85, 170}[b], 255);
    const std::vector<double> opacity = featureOpacities(p.tf);
    CHECK(opacity[0] < opacity[1]);
    CHECK(opacity[1] < opacity[2]);
}

TEST_CASE("knee: air, fat, muscle, spongy and compact bone", "[proposal][samples]") {
    const Volume knee = makeSample("knee", 200, 1);
    const Proposal p = propose(knee);
    checkSound(p);
    CHECK(p.kind == DataKind::Ct);
    REQUIRE(p.features.size() == 4);
    // −1000, −100, 55, 290 and 1120 HU.
    const std::vector<double> known{-550, -22.5, 172.5, 705};
    const double range = knee.dataRange().hi - knee.dataRange().lo;
    for (std::size_t f = 0; f < 4; ++f) checkBorder(p.features[f].lo, known[f], range);
    CHECK(p.features[2].name == "bone");
}

TEST_CASE("real volumes: enamel, dentine and background of the tooth, the skull in HU", "[proposal][real]") {
    const std::string folder = std::string(PELLUCID_SHARED_DIR) + "/data/real/";
    const auto load = [&](const std::string& file) {
        VolumeSource source;
        source.path = folder + file;
        return loadVolume(source);
    };
    if (!std::filesystem::is_directory(folder)) {
        WARN("SKIPPED: there is no folder " << folder);
        return;
    }
    const Proposal tooth = propose(load("tooth/tooth.mhd"));
    checkSound(tooth);
    // Peaks of the histogram: about 1 and 18 (air and what the scanner makes of it), 163 (dentine), 234 (enamel).
    REQUIRE(tooth.features.size() == 2);
    REQUIRE(tooth.background);
    CHECK(tooth.background->hi > 30);
    CHECK(tooth.background->hi < 130);
    CHECK(tooth.features[0].mode == Approx(163).margin(5));
    CHECK(tooth.features[1].mode == Approx(234).margin(5));
    CHECK(tooth.features[1].lo == Approx(198.5).margin(5));

    const Proposal skull = propose(load("cranium_ct/cranium_ct.nrrd"));
    checkSound(skull);
    CHECK(skull.kind == DataKind::Ct);
    CHECK(skull.window.lo == -1024);
    const std::vector<double> opacity = featureOpacities(skull.tf);
    REQUIRE(opacity.size() == 4);
    CHECK(skull.features[1].name == "soft tissue");
    CHECK(opacity[2] > 5 * opacity[1]);

    for (const char* file :
         {"nucleon/nucleon.mhd", "vortex/vorts1.mhd", "walnut/walnut.mhd", "nifti/ch2.nii.gz",
          "nifti/mpld_asl_4d.nii.gz", "nrrd/FLAIR.nrrd", "mha/epi_short.mha", "viscous_fingers/density_045.mhd"}) {
        INFO(file);
        const Proposal p = propose(load(file));
        checkSound(p);
        CHECK(p.kind == DataKind::Continuous);
        CHECK(p.features.size() >= 2);
    }
}
