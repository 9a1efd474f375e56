#include <catch2/catch.hpp>

#include <cmath>

#include "base/error.h"
#include "support/random_tfs.h"
#include "tf/part_names.h"
#include "tf/shapes.h"

using namespace pellucid;
using test::mostDifference;

namespace {

Shape shape(ShapeKind kind, double a, double b, double peak = 0.8) {
    Shape s;
    s.kind = kind;
    s.a = a;
    s.b = b;
    s.peak = peak;
    s.color = {0.25, 0.5, 0.75};
    return s;
}

/// α of the feature over its own interval at u in (0,1) of it.
double within(const TransferFunction& tf, int feature, double u) {
    const Feature& f = tf.features.at(static_cast<std::size_t>(feature));
    return tf.opacity(f.a + u * (f.b - f.a));
}

constexpr double kInside[] = {0.01, 0.13, 0.25, 0.4, 0.5, 0.63, 0.75, 0.87, 0.99};

} // namespace

TEST_CASE("each kind of shape has its formula, and nothing outside its interval", "[shapes]") {
    const auto bell = [](double u) { // z = ±3 at the ends
        const double z = 6 * u - 3;
        return (std::exp(-z * z / 2) - std::exp(-4.5)) / (1 - std::exp(-4.5));
    };
    for (const ShapeKind kind : allOf<ShapeKind>()) {
        INFO(name(kind));
        const AddedFeature added = withShapeAdded({}, shape(kind, 0.2, 0.6));
        REQUIRE(added.tf.features.size() == 1);
        CHECK(added.tf.features[0].name == name(kind));
        CHECK(added.tf.opacity(0.19) == 0);
        CHECK(added.tf.opacity(0.6) == 0);
        CHECK(featureOpacities(added.tf)[0] == 0.8);
        for (int i = 1; i < 1000; ++i) {
            const double u = i / 1000.0;
            double expected = 0;
            double error = 1e-12;
            switch (kind) {
            case ShapeKind::Tent:
                expected = 1 - std::abs(2 * u - 1);
                break;
            case ShapeKind::Trapezoid: // shoulders halfway between the ends and the middle
                expected = std::min({1.0, 4 * u, 4 * (1 - u)});
                break;
            case ShapeKind::Gaussian:
                expected = bell(u);
                error = 0.8 * 0.005;
                break;
            case ShapeKind::Ramp:
                expected = u;
                break;
            case ShapeKind::Step:
                expected = 1;
                break;
            }
            REQUIRE(std::abs(within(added.tf, 0, u) - 0.8 * expected) <= error);
        }
    }
    // Halving finds few chords: the second derivative 1/σ² at the peak allows chords of 0.2 σ of the 6 σ, flat parts
    // longer ones.
    CHECK(pointsOfShape(shape(ShapeKind::Gaussian, 0, 1)).size() < 30);
}

TEST_CASE("a shape that reaches the end of the axis holds there too", "[shapes]") {
    // s = 1 belongs to [a,1]; a step must not fall to 0 at its last voxel.
    CHECK(withShapeAdded({}, shape(ShapeKind::Step, 0.5, 1)).tf.opacity(1) == 0.8);
    CHECK(withShapeAdded({}, shape(ShapeKind::Ramp, 0.5, 1)).tf.opacity(1) == 0.8);
    CHECK(withShapeAdded({}, shape(ShapeKind::Step, 0, 0.5)).tf.opacity(0) == 0.8);
    const TransferFunction back = withFeatureMoved(withShapeAdded({}, shape(ShapeKind::Step, 0.5, 1)).tf, 0, -0.25);
    CHECK(back.opacity(0.76) == 0);
    CHECK(back.opacity(0.74) == 0.8);
    CHECK(back.features[0].b == 0.75);
}

TEST_CASE("a shape may not meet a feature, nor leave the axis", "[shapes]") {
    const TransferFunction tf = tents(3); // features at (i + ½ ± 0.4)/3
    CHECK_THROWS_AS(withShapeAdded(tf, shape(ShapeKind::Tent, 0.25, 0.4)), Error);
    CHECK_THROWS_AS(withShapeAdded({}, shape(ShapeKind::Tent, 0.25, 1.1)), Error);
    CHECK_THROWS_AS(withShapeAdded({}, shape(ShapeKind::Tent, 0.25, 0.25)), Error);
    CHECK_THROWS_AS(withShapeAdded({}, shape(ShapeKind::Tent, 0.25, 0.5, 1.5)), Error);
    // Between the bottoms 0.3 and 0.3667 there is room; the other features stay what they are.
    const AddedFeature added = withShapeAdded(tf, shape(ShapeKind::Trapezoid, 0.31, 0.36));
    CHECK(added.index == 1);
    CHECK(added.tf.features[0] == tf.features[0]);
    CHECK(added.tf.features[2] == tf.features[1]);
    for (const double u : kInside) {
        CHECK(within(added.tf, 0, u) == within(tf, 0, u));
        CHECK(within(added.tf, 2, u) == within(tf, 1, u));
    }
}

TEST_CASE("a feature moves with its points as far as its neighbours let it", "[shapes]") {
    const TransferFunction tf = tents(3);
    // The gap to the next tent is 2 · 0.1/3.
    const TransferFunction near = withFeatureMoved(tf, 1, 0.02), far = withFeatureMoved(tf, 1, 0.5);
    CHECK(near.features[1].a == tf.features[1].a + 0.02);
    CHECK(near.points[4].x == Approx(0.52).margin(1e-15));
    CHECK(near.points[4].opacity == 0.5);
    CHECK(far.features[1].b == tf.features[2].a);
    CHECK(far.features[1].b - far.features[1].a == Approx(0.8 / 3));
    CHECK(far.points.size() == tf.points.size());
    for (const int other : {0, 2})
        CHECK(far.features[static_cast<std::size_t>(other)] == tf.features[static_cast<std::size_t>(other)]);
    CHECK(withFeatureMoved(tf, 0, -1).features[0].a == 0);
    CHECK(withFeatureMoved(tf, 1, 0) == tf);
    CHECK(mostDifference(withFeatureMoved(near, 1, -0.02), tf) < 1e-9);
}

TEST_CASE("a feature that touches its neighbour leaves it by a step", "[shapes]") {
    // α = 0.5 over [0.2, 0.8]; two features that touch at 0.5, where no point lies.
    TransferFunction tf;
    const Rgb grey{0.5, 0.5, 0.5};
    tf.points = {
        {0.2, 0, grey, true, {}}, {0.2, 0.5, grey, false, {}}, {0.8, 0.5, grey, false, {}}, {0.8, 0, grey, true, {}}};
    tf.features = {{"low", 0.2, 0.5, grey, {}}, {"high", 0.5, 0.8, grey, {}}};
    const TransferFunction moved = withFeatureMoved(tf, 0, -0.1);
    CHECK(moved.features[0].a == Approx(0.1));
    CHECK(moved.features[0].b == Approx(0.4));
    CHECK(moved.features[1] == tf.features[1]);
    for (const double x : {0.05, 0.41, 0.45, 0.4999, 0.81}) CHECK(moved.opacity(x) == 0);
    for (const double x : {0.11, 0.25, 0.39, 0.5, 0.65, 0.79}) CHECK(moved.opacity(x) == 0.5);
    CHECK(mostDifference(withFeatureMoved(moved, 0, 0.1), tf) < 1e-9);
    // It cannot go where its neighbour is.
    CHECK(withFeatureMoved(tf, 0, 0.1) == tf);
}

TEST_CASE("a feature is widened affinely, and keeps a width", "[shapes]") {
    const TransferFunction tf = withShapeAdded({}, shape(ShapeKind::Gaussian, 0.4, 0.6)).tf;
    const TransferFunction wide = withFeatureWidened(tf, 0, 0.2, 0.9);
    CHECK(wide.features[0].a == 0.2);
    CHECK(wide.features[0].b == 0.9);
    for (const double u : kInside) CHECK(within(wide, 0, u) == Approx(within(tf, 0, u)).margin(1e-12));
    const TransferFunction none = withFeatureWidened(tf, 0, 0.4, 0.4);
    CHECK(none.features[0].a == 0.4);
    CHECK(none.features[0].b == 0.4 + kSmallestFeature);
    CHECK(withFeatureWidened(tf, 0, -1, 2).features[0].b == 1);
}

TEST_CASE("a copy stands beside its original, or says why not", "[shapes]") {
    const TransferFunction tf = withShapeAdded({}, shape(ShapeKind::Trapezoid, 0.2, 0.4)).tf;
    const AddedFeature copy = withFeatureDuplicated(tf, 0);
    REQUIRE(copy.tf.features.size() == 2);
    CHECK(copy.index == 1);
    CHECK(copy.tf.features[1].a == Approx(0.4));
    CHECK(copy.tf.features[1].b == Approx(0.6));
    CHECK(copy.tf.features[1].name == "trapezoid 2");
    CHECK(copy.tf.features[1].id == 0);
    for (const double u : kInside) CHECK(within(copy.tf, 1, u) == Approx(within(tf, 0, u)).margin(1e-12));
    // tents(3) leaves gaps of 0.2/3 = 0.067 only: the copy is as narrow.
    const AddedFeature narrow = withFeatureDuplicated(tents(3), 0);
    CHECK(narrow.tf.features[static_cast<std::size_t>(narrow.index)].b -
              narrow.tf.features[static_cast<std::size_t>(narrow.index)].a ==
          Approx(0.2 / 3));
    const TransferFunction full = withShapeAdded({}, shape(ShapeKind::Step, 0, 1)).tf;
    CHECK_THROWS_WITH(withFeatureDuplicated(full, 0), Catch::Contains("no room"));
}

TEST_CASE("a split changes no opacity, and a merge undoes it", "[shapes]") {
    TransferFunction tf = tents(3);
    for (std::size_t i = 0; i < 3; ++i) tf.features[i].id = i + 7;
    const TransferFunction split = withFeatureSplit(tf, 1, 0.45);
    REQUIRE(split.features.size() == 4);
    CHECK(split.features[1].b == 0.45);
    CHECK(split.features[2].a == 0.45);
    CHECK(split.features[2].b == tf.features[1].b);
    CHECK(split.features[1].id == 8);
    CHECK(split.features[2].id == 0);
    CHECK(split.features[1].name == "f2 up to 0.45"); // of a function without a range: intensities
    CHECK(split.features[2].name == "f2 from 0.45");
    CHECK_FALSE(split.features[2].color == split.features[1].color);
    CHECK(mostDifference(split, tf) < 1e-12);
    // Each side owns a point at the border: raising one leaves the other.
    const TransferFunction raised = withFeatureOpacities(split, {0.5, featureOpacities(split)[1], 1, 0.5});
    CHECK(raised.opacity(0.44) == tf.opacity(0.44));
    CHECK(raised.opacity(0.45) == Approx(2 * tf.opacity(0.45)));
    CHECK_THROWS_AS(withFeatureSplit(tf, 1, 0.2), Error);
    CHECK_THROWS_AS(withFeatureSplit(tf, 1, tf.features[1].a), Error);

    const AddedFeature merged = withFeaturesMerged(split, 1);
    REQUIRE(merged.tf.features.size() == 3);
    CHECK(merged.tf.features[1].a == tf.features[1].a);
    CHECK(merged.tf.features[1].b == tf.features[1].b);
    CHECK(merged.tf.features[1].name == "f2");
    CHECK(merged.tf.features[1].id == 0); // the upper part was wider
    CHECK(mostDifference(merged.tf, tf) < 1e-12);
    CHECK_THROWS_AS(withFeaturesMerged(tf, 2), Error);
}

TEST_CASE("a feature is split in the deepest valley of its histogram", "[shapes]") {
    Feature f;
    f.a = 0.25;
    f.b = 0.75;
    std::vector<std::uint64_t> counts(256, 100);
    CHECK(splitPlace(f, counts) == 0.5); // flat: the middle
    CHECK(splitPlace(f, {}) == 0.5);
    for (std::size_t i = 80; i <= 84; ++i) counts[i] = 50;  // a shallow one
    for (std::size_t i = 150; i <= 154; ++i) counts[i] = 2; // a deep one, its middle at bin 152
    for (std::size_t i = 200; i < 256; ++i) counts[i] = 0;  // outside the feature
    CHECK(splitPlace(f, counts) == Approx(152.5 / 256).margin(1e-12));
    // A slope that goes on to the end is no valley.
    for (std::size_t i = 0; i < 256; ++i) counts[i] = 1000 - 2 * i;
    CHECK(splitPlace(f, counts) == 0.5);
}

TEST_CASE("neither half of a split is next to nothing", "[shapes]") {
    TransferFunction tf;
    tf.range = ValueRange{0, 256};
    tf.points = {{0.25, 0.5, {}, false, {}}, {0.75, 0.5, {}, false, {}}};
    tf.features.push_back({"bone", 0.25, 0.75, {}, {}});
    const Feature f = tf.features[0];
    const auto partBelow = [](const std::vector<std::uint64_t>& counts, double place) {
        double below = 0, all = 0; // `place` at the end or in the middle of a bin
        for (std::size_t i = 64; i < 192; ++i) {
            const double c = static_cast<double>(counts[i]), bin = static_cast<double>(i);
            below += c * std::clamp(256 * place - bin, 0.0, 1.0);
            all += c;
        }
        return below / all;
    };
    // Two peaks, the deepest valley before the first few voxels: 10 of 12 490 lie below it, 0.08 %.
    std::vector<std::uint64_t> counts(256, 0);
    counts[64] = 10;
    for (std::size_t i = 70; i < 134; ++i) counts[i] = 100;
    for (std::size_t i = 140; i < 192; ++i) counts[i] = i < 144 ? 50 : 120; // a shallower one between these
    for (std::size_t i = 134; i < 140; ++i) counts[i] = 20;
    const double place = splitPlace(f, counts);
    CHECK(place == 137.0 / 256); // three bins at a time the bottom is 135 to 138
    CHECK(partBelow(counts, place) >= kSmallestPart);
    CHECK(partBelow(counts, place) <= 1 - kSmallestPart);
    CHECK_NOTHROW(withFeatureSplit(tf, 0, place, counts));
    // No valley, and nearly all in the first tenth: where the voxels are halved, not the interval.
    std::fill(counts.begin(), counts.end(), 0);
    for (std::size_t i = 64; i < 74; ++i) counts[i] = 1000 - 50 * (i - 64); // 1000, 950 … 550: 7750
    const double half = splitPlace(f, counts);
    CHECK(half == 68.0 / 256); // 3700 below and 4050 above; a bin farther it would be 4500 and 3250
    // What somebody points at is refused with the reason.
    CHECK_THROWS_WITH(withFeatureSplit(tf, 0, 0.6, counts),
                      Catch::Contains("almost no voxel of 'bone' would lie above 15"));
    CHECK_NOTHROW(withFeatureSplit(tf, 0, 0.6));
    CHECK(withFeatureSplit(tf, 0, half, counts).features[0].name == "bone up to 68");
}

TEST_CASE("halves have names that say what they are", "[shapes]") {
    using Names = std::pair<std::string, std::string>;
    CHECK(namesOfParts("bone", "700") == Names("bone up to 700", "bone from 700"));
    CHECK(namesOfParts("bone from 700", "900") == Names("bone from 700 to 900", "bone from 900"));
    CHECK(namesOfParts("bone up to 700", "-3.5") == Names("bone up to -3.5", "bone from -3.5 to 700"));
    CHECK(namesOfParts("soft tissue from 1 to 2", "1.5") ==
          Names("soft tissue from 1 to 1.5", "soft tissue from 1.5 to 2"));
    CHECK(namesOfParts("22.2 to 86.2", "50") == Names("22.2 to 50", "50 to 86.2"));
    CHECK(namesOfParts("", "5") == Names("up to 5", "from 5"));
    CHECK(namesOfParts("from 3", "5") == Names("from 3 up to 5", "from 3 from 5")); // a name like any other
    for (const char* name : {"bone", "bone from 700", "bone up to 900", "fat from -3 to 1e+06", "0 to 1000", "a b c"}) {
        INFO(name);
        const auto [lower, upper] = namesOfParts(name, "800");
        CHECK(nameOfWhole(lower, upper) == name);
    }
    CHECK(nameOfWhole("fat", "bone") == "fat + bone");
    CHECK(nameOfWhole("22 to 86", "86 to 169") == "22 to 169");
    CHECK(nameOfWhole("22 to 80", "86 to 169") == "22 to 80 + 86 to 169");
}

TEST_CASE("a feature that is removed leaves nothing, and nothing else changes", "[shapes]") {
    const TransferFunction tf = tents(3);
    const TransferFunction less = withFeatureRemoved(tf, 1);
    REQUIRE(less.features.size() == 2);
    CHECK(less.points.size() == 6);
    CHECK(less.opacity(0.5) == 0);
    for (const double u : kInside) {
        CHECK(within(less, 0, u) == within(tf, 0, u));
        CHECK(within(less, 1, u) == within(tf, 2, u));
    }
}

TEST_CASE("a change of kind keeps interval, peak and its place", "[shapes]") {
    Shape s = shape(ShapeKind::Tent, 0.2, 0.6);
    s.top = 0.25; // peak at 0.3
    const TransferFunction tf = withShapeAdded({}, s).tf;
    const TransferFunction trapezoid = withFeatureKind(tf, 0, ShapeKind::Trapezoid);
    CHECK(trapezoid.features == tf.features);
    // Shoulders halfway from 0.2 to 0.3 and from 0.3 to 0.6.
    REQUIRE(trapezoid.points.size() == 4);
    CHECK(trapezoid.points[1].x == Approx(0.25));
    CHECK(trapezoid.points[2].x == Approx(0.45));
    CHECK(featureOpacities(trapezoid) == featureOpacities(tf));
    const TransferFunction bell = withFeatureKind(tf, 0, ShapeKind::Gaussian);
    CHECK(bell.opacity(0.3) == 0.8);
}

TEST_CASE("eyes change nothing but what is hidden", "[shapes]") {
    const TransferFunction tf = tents(3);
    const TransferFunction only = withOthersHidden(tf, 1);
    CHECK(only.points == tf.points);
    CHECK(only.features[0].hidden);
    CHECK_FALSE(only.features[1].hidden);
    CHECK(only.features[2].hidden);
    CHECK(withAllShown(only) == tf);
    CHECK(withFeatureHidden(tf, 0, true).features[0].hidden);
}

TEST_CASE("whatever is done to random transfer functions, they stay valid and others keep their shape", "[shapes]") {
    test::Random random(11);
    int done = 0;
    for (int round = 0; round < 400; ++round) {
        TransferFunction tf = test::randomTf(random);
        for (int step = 0; step < 6 && !tf.features.empty(); ++step) {
            const int f = random.below(static_cast<int>(tf.features.size()));
            const Feature before = tf.features[static_cast<std::size_t>(f)];
            TransferFunction next = tf;
            const int what = random.below(8);
            INFO("round " << round << ", step " << step << ", operation " << what);
            try {
                if (what == 0) next = withFeatureMoved(tf, f, random.between(-0.5, 0.5));
                if (what == 1) next = withFeatureWidened(tf, f, random.unit(), random.unit());
                if (what == 2) next = withFeatureDuplicated(tf, f).tf;
                if (what == 3) next = withFeatureSplit(tf, f, random.between(before.a, before.b));
                if (what == 4) next = withFeaturesMerged(tf, f).tf;
                if (what == 5) next = withFeatureRemoved(tf, f);
                if (what == 6) next = withFeatureKind(tf, f, allOf<ShapeKind>()[random.below(5)]);
                if (what == 7) {
                    const ValueRange room = roomFor(tf, 0.1, random.unit());
                    next = withShapeAdded(tf, shape(allOf<ShapeKind>()[random.below(5)], room.lo, room.hi)).tf;
                }
            } catch (const Error&) {
                continue; // no room, no neighbour, too narrow: said, and nothing has changed
            }
            ++done;
            REQUIRE_NOTHROW(next.validate());
            if (what == 3 || what == 4) REQUIRE(mostDifference(next, tf) < 1e-9);
            // Every other feature that is still there has the α that it had.
            for (const Feature& other : tf.features) {
                if (other.a == before.a) continue;
                const auto same = std::find(next.features.begin(), next.features.end(), other);
                if (same == next.features.end()) continue;
                for (const double u : kInside) {
                    const double x = other.a + u * (other.b - other.a);
                    REQUIRE(next.opacity(x) == Approx(tf.opacity(x)).margin(1e-9));
                }
            }
            tf = next;
            REQUIRE(tf.points.size() < 400); // they do not pile up
        }
    }
    CHECK(done > 1000);
}
