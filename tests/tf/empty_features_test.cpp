// Features that no voxel belongs to.
#include <catch2/catch.hpp>

#include <cmath>

#include "tf/empty_features.h"
#include "tf/proposal.h"

using namespace pellucid;

namespace {

template <class T>
Volume lineOf(std::vector<T> values) {
    const Geometry geometry{{static_cast<int>(values.size()), 1, 1}}; // before they are moved
    return Volume(geometry, Samples(std::move(values)));
}

Feature between(double a, double b) { return {"f", a, b, {}, {}}; }

} // namespace

TEST_CASE("a feature has a voxel where one of its intensities occurs, however narrow it is", "[empty]") {
    // Intensities 0, 0.25, 0.5 and 1 of the window 0 … 100.
    const Histogram h = makeHistogram(lineOf(std::vector<std::uint8_t>{0, 25, 50, 100}));
    CHECK(hasVoxel(between(0, 0.1), h));
    CHECK_FALSE(hasVoxel(between(0.01, 0.25), h)); // the upper end is not its own
    CHECK(hasVoxel(between(0.25, 0.2501), h));     // 1/25 of a bin
    CHECK_FALSE(hasVoxel(between(0.2501, 0.2502), h));
    CHECK_FALSE(hasVoxel(between(0.51, 0.99), h));
    CHECK(hasVoxel(between(0.99, 1), h)); // but of the last one it is
    // Beyond the window values count at its ends, as in pictures and figures; what is not valid does not count.
    const Histogram cut = makeHistogram(lineOf(std::vector<float>{-5, 0.5f, 9, NAN, INFINITY}).withRange({0, 1}));
    CHECK(hasVoxel(between(0, 0.001), cut));
    CHECK(hasVoxel(between(0.999, 1), cut));
    CHECK_FALSE(hasVoxel(between(0.001, 0.499), cut));
    CHECK_FALSE(hasVoxel(between(0, 1), makeHistogram(lineOf(std::vector<float>{NAN, NAN}))));
}

TEST_CASE("empty features are told by name, and count as hidden where targets are", "[empty]") {
    const Histogram h = makeHistogram(lineOf(std::vector<std::uint8_t>{0, 10, 85, 100}));
    TransferFunction tf = tents(4); // 0.1 lies in the first, [0.025, 0.225), and 0.85 in the last, [0.775, 0.975)
    CHECK(emptyFeatures(tf, h) == std::vector<bool>{false, true, true, false});
    tf.features[0].name = "a", tf.features[1].name = "b", tf.features[2].name = "c", tf.features[3].name = "d";
    CHECK(namesWithEmpty(tf, h) == std::vector<std::string>{"a", "b (empty)", "c (empty)", "d"});
    tf.features[3].hidden = true;
    const TransferFunction wanted = withEmptyHidden(tf, h);
    for (std::size_t f = 0; f < 4; ++f) CHECK(wanted.features[f].hidden == (f > 0));
    CHECK(wanted.points == tf.points);
    CHECK(emptyTargetText(tf, h, {1, 0, 0, 1}).empty());
    CHECK(emptyTargetText(tf, h, {1, 0.5, 0, 1}) == "'b' has no voxel: its target counts as 0");
    CHECK(emptyTargetText(tf, h, {1, 0.5, 2, 1}) == "'b' and 'c' have no voxels: their targets count as 0");
}

TEST_CASE("no feature without a voxel is proposed", "[empty][proposal]") {
    // Signed, as a t-map: to −3 on one side, to 12 on the other. The window is symmetric, and half way to −12 is
    // nothing.
    std::vector<float> values(40 * 40 * 40);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double x = std::sin(12.9898 * static_cast<double>(i)) * 43758.5453;
        const double noise = 2 * (x - std::floor(x)) - 1; // [−1, 1)
        values[i] = static_cast<float>(3 * noise);
        if (i % 40 < 4) values[i] = static_cast<float>(9 + 3 * noise);
    }
    const Volume volume(Geometry{{40, 40, 40}}, Samples(std::move(values)));
    const Proposal p = propose(volume);
    REQUIRE(p.kind == DataKind::Signed);
    CHECK(p.window.lo == -p.window.hi);
    const Histogram seen = makeHistogram(volume.withRange(p.window));
    for (const Feature& f : p.tf.features) {
        INFO(f.name);
        CHECK(hasVoxel(f, seen));
    }
    CHECK(p.features.size() == p.tf.features.size());
    CHECK(p.features.size() < 4);               // of four, the strongest negative one is not there
    CHECK(p.features.back().hi == p.window.hi); // the strongest positive one is
}
