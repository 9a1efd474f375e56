// Which values of an overlay are drawn, and in which colours.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "tf/overlay_look.h"

using namespace pellucid;

namespace {

Volume volumeOf(const std::function<float(std::size_t)>& value) {
    std::vector<float> samples(40 * 40 * 40);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = value(i);
    return {Geometry{{40, 40, 40}}, Samples(std::move(samples))};
}

/// What `range` makes of a value.
double intensity(double value, const ValueRange& range) { return (value - range.lo) / (range.hi - range.lo); }

} // namespace

TEST_CASE("a map of both signs gets a threshold on either side of 0", "[overlay]") {
    // Of standard normal values the magnitude exceeds 1.960 with 5 %, 3.291 with 0.1 %; two digits. Half of the voxels
    // are 0, as outside of a head: they count for nothing.
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    const OverlayLook look = usualLook(volumeOf([&](std::size_t i) { return i % 2 ? normal(random) : 0.0f; }));
    CHECK(look.twoSided);
    CHECK(look.threshold == Approx(2.0).margin(0.051));
    CHECK(look.top == Approx(3.3).margin(0.15));
    CHECK(usualColorMap(look).kind == ColorMap::Kind::Diverging);
}

TEST_CASE("a smooth map of both signs is drawn from a quarter of its top, not from where it is next to nothing",
          "[overlay]") {
    // One voxel in a hundred has 8 or −8; all others have a thousandth, of which 95 % of the magnitudes consist.
    const OverlayLook look = usualLook(volumeOf([](std::size_t i) {
        const float sign = i % 2 == 0 ? 1.0f : -1.0f;
        return sign * ((i / 2) % 100 == 0 ? 8.0f : 0.001f);
    }));
    CHECK(look == OverlayLook{true, 2, 8});
}

TEST_CASE("a map of one sign is drawn from a tenth of its largest value", "[overlay]") {
    const OverlayLook look = usualLook(volumeOf([](std::size_t i) { return 50.0f * static_cast<float>(i % 41) / 40; }));
    CHECK(look == OverlayLook{false, 5, 50});
    // A few values below 0, as noise or interpolation leave them, make no second side.
    const OverlayLook noisy = usualLook(
        volumeOf([](std::size_t i) { return i % 50 == 0 ? -1.0f : 50.0f * static_cast<float>(i % 41) / 40; }));
    CHECK(noisy == OverlayLook{false, 5, 50});
    CHECK(usualColorMap(look).name == "ember");
    // A CT: air on one end, flesh around 40, some bone. 0 lies between two things, not in the middle of one.
    const OverlayLook ct = usualLook(volumeOf([](std::size_t i) {
        return i % 2 == 0 ? -1000.0f : i % 10 == 1 ? 1000.0f : static_cast<float>(i % 80);
    }));
    CHECK_FALSE(ct.twoSided);
    // Negative values alone: from −90, the lowest tenth left out.
    CHECK(oneSidedLook({-100, 0}) == OverlayLook{false, -90, 0});
    CHECK(twoSidedLook({-100, 20}) == OverlayLook{true, 10, 100});
}

TEST_CASE("nothing is drawn up to the threshold, and what lies beyond the top looks the same", "[overlay]") {
    const ValueRange range{-8, 10};
    const ColorMap& colors = colorMapNamed("blue-red");
    const TransferFunction tf = overlayTf({true, 2, 6}, colors, 0.4, range);
    CHECK_NOTHROW(tf.validate());
    CHECK(tf.range == range);
    const auto opacity = [&](double v) { return tf.opacity(intensity(v, range)); };
    for (const double v : {0.0, 1.99, 2.0, -1.99, -2.0}) CHECK(opacity(v) == 0);
    // Half of it at the threshold, evenly to all of it at the top: at 4, the middle, three quarters.
    for (const double sign : {-1.0, 1.0}) {
        CHECK(opacity(sign * 2.001) == Approx(0.2).margin(0.001));
        CHECK(opacity(sign * 4) == Approx(0.3).margin(0.001));
        CHECK(opacity(sign * 6) == Approx(0.4).margin(0.001));
        CHECK(opacity(sign * 7.9) == Approx(0.4).margin(0.001));
    }
    // The colours go from −6 to 6: 3 is at 3/4 of the map.
    const auto apart = [&](double v, const ColorMap& map, double t) {
        return colorDifference(tf.color(intensity(v, range)), map.colorAt(t));
    };
    CHECK(apart(3, colors, 0.75) < 0.5);
    CHECK(apart(-3, colors, 0.25) < 0.5);
    CHECK(apart(9, colors, 1) < 0.5);
    CHECK(apart(-7, colors, 0) < 0.5);

    // A map that does not diverge tells the distance from 0.
    const ColorMap& sand = colorMapNamed("sand");
    const TransferFunction both = overlayTf({true, 2, 6}, sand, 0.4, range);
    for (const double v : {3.0, -3.0}) CHECK(colorDifference(both.color(intensity(v, range)), sand.colorAt(0.5)) < 0.5);
}

TEST_CASE("a one-sided overlay has colours from 0, or from a threshold below it", "[overlay]") {
    const ColorMap& colors = colorMapNamed("ember");
    const ValueRange dose{0, 60};
    const TransferFunction tf = overlayTf({false, 6, 60}, colors, 0.2, dose);
    CHECK(tf.opacity(intensity(5.9, dose)) == 0);
    CHECK(tf.opacity(intensity(33, dose)) == Approx(0.15).margin(0.001));
    CHECK(colorDifference(tf.color(0.5), colors.colorAt(0.5)) < 0.5);
    // −500 … 1500: 500 is the middle.
    const ValueRange ct{-1000, 2000};
    const TransferFunction bones = overlayTf({false, -500, 1500}, colors, 0.2, ct);
    CHECK(bones.opacity(intensity(-501, ct)) == 0);
    CHECK(bones.opacity(intensity(2000, ct)) == Approx(0.2));
    CHECK(colorDifference(bones.color(intensity(500, ct)), colors.colorAt(0.5)) < 0.5);
    // A threshold of 0 leaves the values of 0 out, and a top below the threshold makes one colour of all.
    CHECK(overlayTf({false, 0, 60}, colors, 0.2, dose).opacity(0) == 0);
    const TransferFunction one = overlayTf({false, 30, 10}, colors, 0.2, dose);
    CHECK(one.opacity(intensity(29, dose)) == 0);
    CHECK(one.opacity(intensity(31, dose)) == Approx(0.2));
}
