// A transfer function in data units: the same function of the data in whatever window it is written.
#include <catch2/catch.hpp>

#include <cmath>

#include "support/random_cases.h"
#include "tf/tf_range.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

constexpr ValueRange kOld{-1000, 2000};

/// Points with all that makes a curve difficult: a step, an opaque start or end, colours that change.
TransferFunction curve(bool opaqueEnds) {
    TransferFunction tf;
    tf.range = kOld;
    if (opaqueEnds) tf.points.push_back({0, 0.25, {0.9, 0.1, 0.3}, false, {}});
    tf.points.push_back({0.1, 0.5, {1, 0, 0}, false, {}});
    tf.points.push_back({0.3, 0.0, {0, 1, 0}, true, R"({"note":1})"});
    tf.points.push_back({0.5, 0.1, {0, 0, 1}, false, {}});
    tf.points.push_back({0.5, 0.7, {1, 1, 0}, false, {}});
    tf.points.push_back({0.85, 0.4, {0.3, 0.2, 0.6}, false, {}});
    if (opaqueEnds) tf.points.push_back({1, 0.6, {0.2, 0.8, 0.5}, true, {}});
    tf.features = {
        {"first", 0, 0.3, {1, 0, 0}, {}}, {"middle", 0.4, 0.6, {0, 0, 1}, {}}, {"last", 0.8, 1, {0, 1, 0}, {}}};
    for (std::size_t i = 0; i < 3; ++i) tf.features[i].id = i + 7;
    return tf;
}

double intensityOf(double value, const ValueRange& range) { return (value - range.lo) / (range.hi - range.lo); }

/// At 1000 data values inside both windows.
void checkSameFunction(const TransferFunction& tf, const ValueRange& to) {
    const TransferFunction other = inRange(tf, to);
    INFO("window " << to.lo << " .. " << to.hi);
    REQUIRE(other.range == to);
    CHECK_NOTHROW(other.validate());
    const double lo = std::max(tf.range->lo, to.lo), hi = std::min(tf.range->hi, to.hi);
    const TfSampler before(tf), after(other);
    double most = 0;
    for (int i = 0; i <= 1000; ++i) {
        const double value = lo + (hi - lo) * i / 1000;
        const double x = intensityOf(value, *tf.range), y = intensityOf(value, to);
        // At a step rounding decides which side a value is on.
        const auto nearStep = [&](double s) { return std::abs(s - 0.5) < 1e-9; };
        if (nearStep(x)) continue;
        const Rgb a = before.color(x), b = after.color(y);
        for (const double d : {before.opacity(x) - after.opacity(y), a.r - b.r, a.g - b.g, a.b - b.b})
            most = std::max(most, std::abs(d));
    }
    CHECK(most < 1e-12);
}

const std::vector<ValueRange> kWindows{{-3000, 5000},                                        // wider
                                       {-1000, 2500}, {-2000, 2000}, {-900, 1900}, {0, 600}, // narrower
                                       {-1000, 0},    {1000, 2000},  {-940, -938}, {-2500, 300},
                                       {700, 9000}}; // to one side

} // namespace

TEST_CASE("in another window a transfer function is the same function of the data", "[tf][range]") {
    for (const bool opaqueEnds : {false, true})
        for (const ValueRange& window : kWindows) {
            INFO("opaque ends " << opaqueEnds);
            checkSameFunction(curve(opaqueEnds), window);
        }
    TransferFunction tents3 = tents(3), none;
    tents3.range = none.range = kOld;
    for (const ValueRange& window : kWindows) {
        checkSameFunction(tents3, window);
        checkSameFunction(none, window);
        CHECK(inRange(none, window).points.empty());
    }
}

TEST_CASE("values beyond the old window are drawn as its ends are", "[tf][range]") {
    for (const bool opaqueEnds : {false, true}) {
        const TransferFunction tf = curve(opaqueEnds), wider = inRange(tf, {-3000, 5000});
        for (const double value : {-3000.0, -2999.0, -1500.0, -1001.0}) {
            const double y = intensityOf(value, *wider.range);
            CHECK(wider.opacity(y) == Approx(tf.opacity(0)).margin(1e-12));
            CHECK(wider.color(y).r == Approx(tf.color(0).r));
        }
        for (const double value : {2001.0, 3000.0, 4999.0, 5000.0}) {
            const double y = intensityOf(value, *wider.range);
            CHECK(wider.opacity(y) == Approx(tf.opacity(1)).margin(1e-12));
            CHECK(wider.color(y).b == Approx(tf.color(1).b));
        }
        // The voxels beyond belonged to the outer features, and still do.
        CHECK(wider.features.front().a == 0);
        CHECK(wider.features.back().b == 1);
    }
}

TEST_CASE("a window that shares no value with the old one shows its end all over", "[tf][range]") {
    const TransferFunction tf = curve(true);
    const TransferFunction above = inRange(tf, {3000, 4000}), below = inRange(tf, {-9000, -8000});
    for (const double s : {0.0, 0.3, 1.0}) {
        CHECK(above.opacity(s) == 0.6);
        CHECK(above.color(s) == tf.color(1));
        CHECK(below.opacity(s) == 0.25);
        CHECK(below.color(s) == tf.color(0));
    }
    REQUIRE(above.features.size() == 1);
    CHECK(above.features[0].name == "last");
    REQUIRE(below.features.size() == 1);
    CHECK(below.features[0].name == "first");
    // Where nothing lies beyond, nothing is left.
    CHECK(inRange(tents(3), {3000, 4000}).features.size() == 3); // these say of no data values at all
    TransferFunction bare = tents(3);
    bare.range = kOld;
    CHECK(inRange(bare, {3000, 4000}).features.empty());
    CHECK(inRange(bare, {3000, 4000}).opacity(0.5) == 0);
}

TEST_CASE("features keep their data values, and are cut at the window", "[tf][range]") {
    const TransferFunction tf = curve(false);
    // 0.4 and 0.6 of −1000 … 2000 are 200 and 800.
    const TransferFunction half = inRange(tf, {500, 2000});
    REQUIRE(half.features.size() == 2);
    CHECK(half.features[0].name == "middle");
    CHECK(half.features[0].a == 0);
    CHECK(half.features[0].b == Approx((800 - 500) / 1500.0).epsilon(1e-12));
    CHECK(half.features[0].id == 8); // who they are stays with them
    CHECK(half.features[1].a == Approx((1400 - 500) / 1500.0).epsilon(1e-12));
    CHECK(half.features[1].b == 1);
    const TransferFunction between = inRange(tf, {850, 1300}); // middle ends at 800, last begins at 1400
    CHECK(between.features.empty());
}

TEST_CASE("points that need not move stay bit for bit", "[tf][range]") {
    TransferFunction tf = curve(true);
    CHECK(inRange(tf, kOld) == tf);
    TransferFunction free = tf;
    free.range.reset();
    const TransferFunction placed = inRange(free, {3, 4});
    CHECK(placed.points == tf.points);
    CHECK(placed.features == tf.features);
    CHECK(placed.range == ValueRange{3, 4});
    // Keys of other programs and marks go along.
    const TransferFunction wider = inRange(tf, {-2000, 3000});
    const auto marked = std::find_if(wider.points.begin(), wider.points.end(),
                                     [](const ControlPoint& p) { return p.extraJson == R"({"note":1})"; });
    REQUIRE(marked != wider.points.end());
    CHECK(marked->fixed);
}

TEST_CASE("ends that the windows share are met exactly, and no point is added that says nothing", "[tf][range]") {
    TransferFunction tf = tents(3);
    for (const ValueRange& range : {ValueRange{0.1, 0.7}, ValueRange{-1.0 / 3, 1e7}, ValueRange{-0.3, 1.1}}) {
        tf.range = range;
        const TransferFunction wider = inRange(tf, {range.lo - 1, range.hi}), same = inRange(wider, range);
        CHECK(wider.points.size() == tf.points.size());
        CHECK(same.points.size() == tf.points.size());
        TransferFunction solid = curve(true);
        solid.range = range;
        CHECK(inRange(solid, {range.lo - 1, range.hi}).points.back().x == 1.0);
        CHECK(inRange(solid, {range.lo, range.hi + 1}).points.front().x == 0.0);
    }
}

TEST_CASE("random transfer functions are the same in random windows", "[tf][range]") {
    Random random(20);
    for (int n = 0; n < 300; ++n) {
        TransferFunction tf;
        tf.range = ValueRange{random.between(-5, 0), random.between(1, 5)};
        double x = 0;
        for (int i = random.below(7); i > 0 && x < 0.98; --i) {
            x = random.chance(0.15) ? x : std::min(1.0, x + random.between(0.02, 0.5));
            if (std::abs(x - 0.5) < 1e-3) continue;
            if (!tf.points.empty() && tf.points.back().x == x) continue; // steps are tested above
            tf.points.push_back({x,
                                 random.chance(0.4) ? 0 : random.unit(),
                                 {random.unit(), random.unit(), random.unit()},
                                 random.chance(0.5),
                                 {}});
        }
        const double lo = random.between(-6, 4);
        checkSameFunction(tf, {lo, lo + random.between(0.5, 8)});
    }
}
