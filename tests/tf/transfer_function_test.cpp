#include <catch2/catch.hpp>

#include <cmath>

#include "base/error.h"
#include "tf/opacity.h"
#include "tf/tf_table.h"
#include "tf/transfer_function.h"

using namespace pellucid;

TEST_CASE("opacity of a step follows 1 − (1 − α)^(d/d0)", "[tf]") {
    CHECK(opacityOfStep(0.5, 1) == Approx(0.5));
    CHECK(opacityOfStep(0.5, 2) == Approx(0.75));   // 1 − 0.25
    CHECK(opacityOfStep(0.19, 0.5) == Approx(0.1)); // 1 − sqrt(0.81)
    CHECK(opacityOfStep(0, 7) == 0);
    CHECK(opacityOfStep(1, 1) == Approx(1.0));
    CHECK(std::isfinite(opticalDepthOfOpacity(1)));
}

TEST_CASE("three tents stand where docs/method.md puts them", "[tf]") {
    const TransferFunction tf = tents(3, 0.5);
    REQUIRE(tf.points.size() == 9);
    // Tent 1: centre 1.5/3 = 0.5, bottoms at 0.5 ± 0.4/3, hue 180° (cyan).
    CHECK(tf.points[4].x == Approx(0.5));
    CHECK(tf.points[3].x == Approx(0.5 - 0.4 / 3));
    CHECK(tf.points[5].x == Approx(0.5 + 0.4 / 3));
    CHECK(tf.points[3].fixed);
    CHECK_FALSE(tf.points[4].fixed);
    CHECK(hexFromRgb(tf.points[4].color) == "#00ffff");
    CHECK(tf.features[1].a == tf.points[3].x);
    CHECK(tf.features[1].b == tf.points[5].x);
    CHECK(tf.opacity(0.5) == Approx(0.5));
    CHECK(tf.opacity(0.5 + 0.2 / 3) == Approx(0.25)); // half way down
    CHECK(tf.opacity(1.0 / 3) == 0);                  // between tents
    CHECK(featureOpacities(tf) == std::vector<double>{0.5, 0.5, 0.5});
    tf.validate();
}

TEST_CASE("a ramp has points of 1/6 and falls to 0 at the ends", "[tf]") {
    const TransferFunction tf = ramp(6);
    REQUIRE(tf.points.size() == 6);
    CHECK(tf.opacity(0.5) == Approx(1.0 / 6));
    CHECK(tf.opacity(0) == 0);
    CHECK(tf.opacity(1) == 0);
    CHECK(tf.opacity(0.25 / 6) == Approx(1.0 / 12)); // half way to the first point at 0.5/6
    CHECK(hexFromRgb(tf.points[0].color) == hexFromRgb(rgbFromHsv(30, 1, 1)));
    REQUIRE(tf.features.size() == 1);
    CHECK(tf.features[0].contains(1.0));
}

TEST_CASE("of two points that share an x the later one holds from there on", "[tf]") {
    TransferFunction tf;
    tf.points = {
        {0.0, 0.2, {}, false, {}}, {0.5, 0.2, {}, false, {}}, {0.5, 0.8, {}, false, {}}, {1.0, 0.8, {}, false, {}}};
    CHECK(tf.opacity(std::nextafter(0.5, 0)) == Approx(0.2));
    CHECK(tf.opacity(0.5) == 0.8);
    CHECK(tf.opacity(1.0) == 0.8);            // no point is added at an end that has one
    const TfTable table = makeTfTable(tf, 5); // 0, ¼, ½, ¾, 1
    CHECK(table.rgba[1][3] == Approx(0.2f));
    CHECK(table.rgba[2][3] == Approx(0.8f));
    CHECK(table.opticalDepth[2] == Approx(-std::log(0.2)));
}

TEST_CASE("a transfer function without points is transparent", "[tf]") {
    CHECK(TransferFunction{}.opacity(0.5) == 0);
    CHECK(deriveFeatures(TransferFunction{}).empty());
}

TEST_CASE("features end before b, except at 1", "[tf]") {
    const std::vector<Feature> features{{"low", 0, 0.5, {}, {}}, {"high", 0.5, 1, {}, {}}};
    CHECK(featureAt(features, 0) == 0);
    CHECK(featureAt(features, 0.5) == 1);
    CHECK(featureAt(features, 1) == 1);
    CHECK(featureAt(features, std::nan("")) == -1);
}

TEST_CASE("scaling a tent's parameter scales its opacity in proportion and nothing else", "[tf]") {
    const TransferFunction tf = tents(3, 0.5);
    const TransferFunction scaled = withFeatureOpacities(tf, {0.5, 0.1, 0.5});
    CHECK(scaled.opacity(0.5) == Approx(0.1));
    CHECK(scaled.opacity(0.5 + 0.2 / 3) == Approx(0.05));
    CHECK(scaled.opacity(1.0 / 6) == Approx(0.5));
    CHECK(scaled.points.size() == tf.points.size());
}

TEST_CASE("a tent of opacity 0 can be raised again", "[tf]") {
    const TransferFunction flat = withFeatureOpacities(tents(2, 0.5), {0.0, 0.5});
    CHECK(featureOpacities(flat)[0] == 0);
    CHECK(withFeatureOpacities(flat, {0.5, 0.5}) == tents(2, 0.5));
    TransferFunction stuck = flat;
    for (ControlPoint& p : stuck.points) p.fixed = true;
    CHECK_THROWS_AS(withFeatureOpacities(stuck, {0.5, 0.5}), Error);
}

TEST_CASE("a feature cut out of a ramp scales between steps", "[tf]") {
    TransferFunction tf = ramp(1); // (0,0) (0.5,1/6) (1,0)
    tf.features = {{"middle", 0.25, 0.75, {}, {}}, {"right", 0.75, 1.0, {}, {}}};
    // α(0.25) = 1/12 on both sides; the middle's peak is 1/6, the right one's is its left end, 1/12.
    CHECK(featureOpacities(tf)[0] == Approx(1.0 / 6));
    CHECK(featureOpacities(tf)[1] == Approx(1.0 / 12));
    const TransferFunction scaled = withFeatureOpacities(tf, {1.0 / 3, 1.0 / 12});
    scaled.validate();
    CHECK(scaled.opacity(0.2) == Approx(tf.opacity(0.2)));
    CHECK(scaled.opacity(0.25) == Approx(1.0 / 6));
    CHECK(scaled.opacity(0.5) == Approx(1.0 / 3));
    CHECK(scaled.opacity(std::nextafter(0.75, 0)) == Approx(1.0 / 6));
    CHECK(scaled.opacity(0.75) == Approx(1.0 / 12));
    CHECK(featureOpacities(scaled)[0] == Approx(1.0 / 3));
    CHECK(featureOpacities(scaled)[1] == Approx(1.0 / 12));
}

TEST_CASE("features are derived from the intervals of positive opacity", "[tf]") {
    TransferFunction tf = tents(4, 0.3);
    const auto expected = tf.features;
    CHECK(deriveFeatures(tf) == expected);
    tf = withFeatureOpacities(tf, {0.3, 0.0, 0.3, 0.3}); // a flat tent is nothing to see
    CHECK(deriveFeatures(tf).size() == 3);
}

TEST_CASE("transfer functions can be named", "[tf]") {
    CHECK(tfFromSpec("tents:3") == tents(3, kDefaultPeak));
    CHECK(tfFromSpec("tents:3:0.25") == tents(3, 0.25));
    CHECK(tfFromSpec("ramp:6") == ramp(6));
    CHECK_FALSE(tfFromSpec("a/file.tf.json"));
    CHECK_FALSE(tfFromSpec("tents"));
    for (const char* bad : {"tents:0", "tents:-1", "tents:65", "tents:x", "tents:3:2", "tents:3:-1", "tents:3:nan",
                            "tents:3:0.1:4", "tents:", "tents:3.5", "ramp:0", "ramp:3:0.5"})
        CHECK_THROWS_AS(tfFromSpec(bad), UsageError);
}

TEST_CASE("what cannot be a transfer function is refused with its place", "[tf]") {
    TransferFunction tf = tents(2);
    tf.points[1].opacity = 1.5;
    CHECK_THROWS_WITH(tf.validate(), Catch::Contains("/points/1/opacity"));
    tf = tents(2);
    std::swap(tf.points[1], tf.points[4]);
    CHECK_THROWS_WITH(tf.validate(), Catch::Contains("sorted"));
    tf = tents(2);
    tf.points[0].x = std::nan("");
    CHECK_THROWS_AS(tf.validate(), Error);
    tf = tents(2);
    tf.features[1].a = tf.features[0].a;
    CHECK_THROWS_WITH(tf.validate(), Catch::Contains("overlap"));
}
