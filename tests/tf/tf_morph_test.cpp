#include "tf/tf_morph.h"

#include <catch2/catch.hpp>

#include "tf/lch.h"
#include "tf/tf_range.h"

using namespace pellucid;

namespace {

TransferFunction tfOf(std::vector<ControlPoint> points, std::vector<Feature> features = {}) {
    TransferFunction tf;
    tf.points = std::move(points);
    tf.features = std::move(features);
    tf.range = ValueRange{0, 100};
    return tf;
}

Feature feature(const std::string& name, double a, double b) { return {name, a, b, {1, 0, 0}, {}}; }

const Rgb kRedEnd{1, 0, 0}, kBlueEnd{0, 0, 1};

/// A tent of the height `peak` over [a, b].
std::vector<ControlPoint> tent(double a, double b, double peak, const Rgb& color) {
    return {{a, 0, color, false, {}}, {(a + b) / 2, peak, color, false, {}}, {b, 0, color, false, {}}};
}

} // namespace

TEST_CASE("a way between transfer functions begins and ends at these", "[tf]") {
    const TransferFunction a = tfOf(tent(0.1, 0.3, 0.5, kRedEnd), {feature("skin", 0.1, 0.3)});
    TransferFunction b = tents(4);
    b.range = ValueRange{-50, 200};
    CHECK(tfMorph(a, b, 0) == a);
    CHECK(tfMorph(a, b, 1) == b);
    // Near its ends it is near to them, at all values, though the ranges differ.
    const ValueRange both{-50, 200};
    const TfSampler begin(inRange(a, both)), end(inRange(b, both));
    const TfSampler soon(tfMorph(a, b, 1e-6)), late(tfMorph(a, b, 1 - 1e-6));
    for (double s = 0.0005; s < 1; s += 0.001) {
        CHECK(soon.opacity(s) == Approx(begin.opacity(s)).margin(2e-5));
        CHECK(late.opacity(s) == Approx(end.opacity(s)).margin(2e-5));
    }
}

TEST_CASE("points that belong together go straight, colours through CIELAB", "[tf]") {
    const TransferFunction a = tfOf(tent(0.1, 0.3, 0.2, kRedEnd), {feature("skin", 0.1, 0.3)});
    const TransferFunction b = tfOf(tent(0.5, 0.9, 0.6, kBlueEnd), {feature("skin", 0.5, 0.9)});
    const TransferFunction half = tfMorph(a, b, 0.5);
    REQUIRE(half.points.size() == 3);
    CHECK(half.points[0].x == Approx(0.3));
    CHECK(half.points[1].x == Approx(0.45));
    CHECK(half.points[1].opacity == Approx(0.4));
    CHECK(half.features[0].b == Approx(0.6));
    // The mean of both in CIELAB, as far as sRGB has it: lightness is kept.
    const double wanted = (labFromSrgb(kRedEnd).lightness + labFromSrgb(kBlueEnd).lightness) / 2;
    CHECK(labFromSrgb(half.points[1].color).lightness == Approx(wanted).margin(2));
}

TEST_CASE("a feature that moves takes its curve along, whatever points it has", "[tf]") {
    const TransferFunction a = tfOf(tent(0.2, 0.4, 0.8, kRedEnd), {feature("skin", 0.2, 0.4)});
    // As wide, with a flat top of five points, elsewhere.
    std::vector<ControlPoint> flat = tent(0.6, 0.8, 0.8, kRedEnd);
    flat.insert(flat.begin() + 1, {0.65, 0.8, kRedEnd, false, {}});
    flat.insert(flat.begin() + 3, {0.75, 0.8, kRedEnd, false, {}});
    const TransferFunction b = tfOf(flat, {feature("skin", 0.6, 0.8)});
    const TransferFunction half = tfMorph(a, b, 0.5);
    half.validate();
    REQUIRE(half.features.size() == 1);
    CHECK(half.features[0].a == Approx(0.4));
    CHECK(half.features[0].b == Approx(0.6));
    CHECK(half.opacity(0.5) == Approx(0.8));              // both peaks
    CHECK(half.opacity(0.45) == Approx((0.4 + 0.8) / 2)); // halfway up, and the corner of the flat top
    CHECK(half.opacity(0.3) == Approx(0).margin(1e-9));   // nothing is left where it came from
    CHECK(half.opacity(0.7) == Approx(0).margin(1e-9));   // or where it goes to
}

TEST_CASE("a feature that one has alone fades where it is", "[tf]") {
    const TransferFunction a = tfOf(tent(0.1, 0.3, 0.4, kRedEnd), {feature("skin", 0.1, 0.3)});
    std::vector<ControlPoint> points = tent(0.1, 0.3, 0.4, kRedEnd);
    for (const ControlPoint& p : tent(0.6, 0.8, 0.9, kBlueEnd)) points.push_back(p);
    const TransferFunction b = tfOf(points, {feature("skin", 0.1, 0.3), feature("bone", 0.6, 0.8)});
    for (const double t : {0.25, 0.5, 0.75}) {
        const TransferFunction tf = tfMorph(a, b, t);
        tf.validate();
        CHECK(tf.opacity(0.2) == Approx(0.4));
        CHECK(tf.opacity(0.7) == Approx(0.9 * t));
        CHECK(tf.features.size() == 2);
    }
}

TEST_CASE("steps stay steps, and what an eye hides is transparent", "[tf]") {
    const TransferFunction a =
        tfOf({{0.5, 0, kRedEnd, false, {}}, {0.5, 0.6, kRedEnd, false, {}}, {1, 0.6, kRedEnd, false, {}}},
             {feature("f", 0.5, 1)});
    TransferFunction b = tfOf({{0.5, 0, kRedEnd, false, {}},
                               {0.5, 0.2, kRedEnd, false, {}},
                               {0.7, 0.2, kRedEnd, false, {}},
                               {1, 0.2, kRedEnd, false, {}}},
                              {feature("f", 0.5, 1)});
    TransferFunction half = tfMorph(a, b, 0.5);
    CHECK(half.opacity(0.4999) == Approx(0).margin(1e-9));
    CHECK(half.opacity(0.5) == Approx(0.4));
    CHECK(half.opacity(0.9) == Approx(0.4));
    b.features[0].hidden = true;
    half = tfMorph(a, b, 0.5);
    CHECK(half.opacity(0.9) == Approx(0.3));
    CHECK_FALSE(half.features[0].hidden);
}

TEST_CASE("features that change places make no curve that goes back", "[tf]") {
    std::vector<ControlPoint> points = tent(0.1, 0.3, 0.4, kRedEnd);
    for (const ControlPoint& p : tent(0.6, 0.8, 0.9, kBlueEnd)) points.push_back(p);
    const TransferFunction a = tfOf(points, {feature("one", 0.1, 0.3), feature("two", 0.6, 0.8)});
    const TransferFunction b = tfOf(points, {feature("two", 0.1, 0.3), feature("one", 0.6, 0.8)});
    for (double t = 0.05; t < 1; t += 0.05) CHECK_NOTHROW(tfMorph(a, b, t).validate());
}
