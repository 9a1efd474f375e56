#include <catch2/catch.hpp>

#include "tf/edit.h"

using namespace pellucid;

// tents(3): centres 1/6, 1/2, 5/6, bottoms at centre ± 0.4/3; points 0..8, each tent bottom, peak, bottom.

TEST_CASE("a moved point stays between its neighbours and within [0,1]", "[edit]") {
    const TransferFunction tf = tents(3);
    const TransferFunction far = withPointMoved(tf, 4, 0.99, 1.7);
    CHECK(far.points[4].x == tf.points[5].x);
    CHECK(far.points[4].opacity == 1.0);
    CHECK(withPointMoved(tf, 4, 0.0, -1).points[4].x == tf.points[3].x);
    CHECK(withPointMoved(tf, 0, -3, 0).points[0].x == 0.0);
    CHECK(withPointMoved(tf, 99, 0.5, 0.5) == tf);
    CHECK_NOTHROW(far.validate());
}

TEST_CASE("the end of a feature goes with its point, and never into another feature", "[edit]") {
    const TransferFunction tf = tents(3);
    const TransferFunction wider = withPointMoved(tf, 3, 0.35, 0);
    CHECK(wider.features[1].a == 0.35);
    CHECK(wider.features[1].b == tf.features[1].b);
    CHECK(wider.features[0] == tf.features[0]);
    // The point may go down to its neighbour, which is the upper end of the first feature.
    const TransferFunction touching = withPointMoved(tf, 3, 0.0, 0);
    CHECK(touching.features[1].a == tf.features[0].b);
    CHECK_NOTHROW(touching.validate());
    // A peak is no end of a feature.
    CHECK(withPointMoved(tf, 4, 0.52, 0.3).features == tf.features);
}

TEST_CASE("a point is added in its place and in the colour that is there", "[edit]") {
    const TransferFunction tf = tents(3);
    const AddedPoint added = withPointAdded(tf, 0.55, 0.4);
    REQUIRE(added.tf.points.size() == 10);
    CHECK(added.index == 5);
    CHECK(added.tf.points[5].x == 0.55);
    CHECK(added.tf.points[5].color == tf.color(0.55));
    CHECK_NOTHROW(added.tf.validate());
    CHECK(withPointRemoved(added.tf, added.index) == tf);
}

TEST_CASE("the colour of a feature is the colour of its points, and of its peak", "[edit]") {
    const TransferFunction tf = tents(3);
    const Rgb violet{0.5, 0.25, 1};
    const TransferFunction recolored = withFeatureColor(tf, 1, violet);
    CHECK(recolored.features[1].color == violet);
    for (int i = 3; i <= 5; ++i) CHECK(recolored.points[static_cast<std::size_t>(i)].color == violet);
    CHECK(recolored.points[2] == tf.points[2]);
    CHECK(recolored.points[6] == tf.points[6]);
    CHECK(withPointColor(tf, 4, violet).features[1].color == violet);
    CHECK(withPointColor(tf, 3, violet).features[1].color == tf.features[1].color); // a bottom, not the peak
}

TEST_CASE("the opacity of one feature leaves the others alone", "[edit]") {
    const TransferFunction changed = withFeatureOpacity(tents(3, 0.5), 2, 0.125);
    CHECK(featureOpacities(changed) == std::vector<double>{0.5, 0.5, 0.125});
}
