#include "tf/emphasis.h"

#include <cmath>

#include <catch2/catch.hpp>

using namespace pellucid;

namespace {

double extinction(double alpha) { return -std::log1p(-alpha); }

} // namespace

TEST_CASE("more of a feature: its extinction times 1.5, that of what hides it divided by 1.25", "[emphasis]") {
    const TransferFunction tf = tents(4, 0.4);
    const Emphasis more = withEmphasis(tf, 2, 1, {0.5, 0, 9, 0.1}, {false, false, false, true});
    // Tent i has its peak at (i + ½)/4. The second hides nothing, the fourth is held.
    CHECK(extinction(more.tf.opacity(2.5 / 4)) == Approx(1.5 * extinction(0.4)));
    CHECK(extinction(more.tf.opacity(0.5 / 4)) == Approx(extinction(0.4) / 1.25));
    CHECK(more.tf.opacity(1.5 / 4) == 0.4);
    CHECK(more.tf.opacity(3.5 / 4) == 0.4);
    REQUIRE(more.changes.size() == 2);
    CHECK(more.changes[0].feature == 2);
    CHECK(more.changes[1].feature == 0);
    CHECK(emphasisText(more) == "f3 × 1.5, f1 ÷ 1.25");
    CHECK(more.tf.features == tf.features);
    CHECK(more.tf.points.size() == tf.points.size());

    // Less is the inverse.
    const Emphasis back = withEmphasis(more.tf, 2, -1, {0.5, 0, 9, 0.1}, {false, false, false, true});
    for (const double s : {0.125, 0.3, 0.375, 0.6, 0.625, 0.875})
        CHECK(back.tf.opacity(s) == Approx(tf.opacity(s)).margin(1e-12));
    CHECK(emphasisText(back) == "f3 ÷ 1.5, f1 × 1.25");
    // Two steps at once are two.
    const Emphasis two = withEmphasis(tf, 2, 2, {0, 0, 0, 0}, std::vector<bool>(4, false));
    CHECK(extinction(two.tf.opacity(2.5 / 4)) == Approx(2.25 * extinction(0.4)));
    CHECK(emphasisText(two) == "f3 × 2.25");
}

TEST_CASE("nothing outside an emphasized feature moves, and fixed points stay", "[emphasis]") {
    // Two features side by side under one curve; the border is in the middle of a slope.
    TransferFunction tf;
    const Rgb grey{0.5, 0.5, 0.5};
    tf.points = {
        {0, 0.2, grey, false, {}}, {0.4, 0.2, grey, true, {}}, {0.8, 0.6, grey, false, {}}, {1, 0.6, grey, false, {}}};
    tf.features = {{"low", 0, 0.6, grey, {}}, {"high", 0.6, 1, grey, {}}};
    const Emphasis more = withEmphasis(tf, 1, 1, {0, 0}, {false, false});
    for (const double s : {0.0, 0.2, 0.4, 0.5, 0.5999}) CHECK(more.tf.opacity(s) == Approx(tf.opacity(s)));
    // At the border α was 0.4, on the plateau 0.6.
    CHECK(extinction(more.tf.opacity(0.6)) == Approx(1.5 * extinction(0.4)));
    CHECK(extinction(more.tf.opacity(0.9)) == Approx(1.5 * extinction(0.6)));
    const Emphasis low = withEmphasis(tf, 0, 1, {0, 0}, {false, false});
    CHECK(low.tf.opacity(0.4) == 0.2); // fixed
    CHECK(extinction(low.tf.opacity(0)) == Approx(1.5 * extinction(0.2)));
    CHECK(low.tf.opacity(0.7) == Approx(tf.opacity(0.7)));
    low.tf.validate();
}

TEST_CASE("what is held, hidden, fixed or transparent is not emphasized", "[emphasis]") {
    TransferFunction tf = tents(2, 0.4);
    const std::vector<double> none{0, 0};
    CHECK(withEmphasis(tf, 0, 1, none, {true, false}).changes.empty());
    TransferFunction hidden = tf;
    hidden.features[0].hidden = true;
    CHECK(withEmphasis(hidden, 0, 1, none, {false, false}).changes.empty());
    TransferFunction fixed = tf;
    fixed.points[1].fixed = true;
    CHECK(withEmphasis(fixed, 0, 1, none, {false, false}).changes.empty());
    const Emphasis others = withEmphasis(fixed, 0, 1, {0, 1}, {false, false});
    CHECK(emphasisText(others) == "f2 ÷ 1.25");
    CHECK(others.tf.points[1] == fixed.points[1]);
    const Emphasis nothing = withEmphasis(tents(2, 0.0), 0, 1, none, {false, false});
    CHECK(nothing.changes.empty());
    CHECK(nothing.tf == tents(2, 0.0));
    CHECK(emphasisText(nothing).empty());
    // The largest opacity can get less, too.
    CHECK(withEmphasis(tents(2, 1.0), 0, -1, none, {false, false}).tf.opacity(0.25) < 1);
}
