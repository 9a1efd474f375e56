// Features that some viewers cannot tell apart, and colours with which they can.
#include "tf/alike_features.h"

#include <algorithm>

#include <catch2/catch.hpp>

#include "tf/color_spaces.h"
#include "tf/edit.h"
#include "tf/palette.h"

using namespace pellucid;

namespace {

TransferFunction inColors(const std::vector<Rgb>& colors) {
    TransferFunction tf = tents(static_cast<int>(colors.size()));
    for (std::size_t f = 0; f < colors.size(); ++f) tf = withFeatureColor(tf, static_cast<int>(f), colors[f]);
    return tf;
}

std::vector<AlikePair> alike(const TransferFunction& tf) { return alikeFeatures(tf, featuresToTell(tf)); }

/// Indices of features, the darkest first.
std::vector<std::size_t> byLightness(const TransferFunction& tf) {
    const std::vector<Rgb> colors = featureColors(tf);
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < colors.size(); ++i) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return labFromSrgb(colors[a]).lightness < labFromSrgb(colors[b]).lightness;
    });
    return order;
}

const Rgb kRed = rgbFromHex("#cc3300"), kGreen = rgbFromHex("#668000"), kBlue = rgbFromHex("#3060d0"),
          kIvory = rgbFromHex("#fbf6e6");

} // namespace

TEST_CASE("a red and a green of one lightness look alike to who cannot tell them by their hue", "[alike]") {
    const TransferFunction tf = inColors({kRed, kGreen, kBlue});
    const std::vector<AlikePair> pairs = alike(tf);
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].first == 0);
    CHECK(pairs[0].second == 1);
    CHECK((pairs[0].vision == VisionKind::Deuteranopia || pairs[0].vision == VisionKind::Protanopia));
    // What is said is what that viewer sees.
    const LightMatrix m = visionMatrix(pairs[0].vision);
    CHECK(pairs[0].difference ==
          Approx(ciede2000(labFromSrgb(seenColor(kRed, m)), labFromSrgb(seenColor(kGreen, m)))).margin(1e-6));
    CHECK(ciede2000(labFromSrgb(kRed), labFromSrgb(kGreen)) > kWantedDifference);
}

TEST_CASE("what is alike to all is said so", "[alike]") {
    TransferFunction tf = inColors({rgbFromHex("#808080"), rgbFromHex("#888888")});
    tf.features[0].name = "bone";
    tf.features[1].name = "vessels";
    const std::vector<AlikePair> pairs = alike(tf);
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].vision == VisionKind::Normal);
    CHECK(alikeText(tf, {0, 1, VisionKind::Normal, 3.24}) ==
          "bone and vessels look alike to all viewers (ΔE00 3.2, of 10 wanted)");
    CHECK(alikeText(tf, {0, 1, VisionKind::Deuteranopia, 3.24}) ==
          "bone and vessels look alike to a viewer with deuteranopia (ΔE00 3.2, of 10 wanted)");
}

TEST_CASE("what is hidden or too faint to be seen is like nothing", "[alike]") {
    TransferFunction tf = inColors({kRed, kGreen});
    REQUIRE(alike(tf).size() == 1);
    tf.features[1].hidden = true;
    CHECK(alike(tf).empty());
    tf.features[1].hidden = false;
    CHECK(alike(withFeatureOpacities(tf, {0.5, kLeastSeenOpacity / 2})).empty());
    CHECK(alike(withFeatureOpacities(tf, {0.5, kLeastSeenOpacity})).size() == 1);
}

TEST_CASE("the colour of a feature is that of its light, by opacity", "[alike]") {
    // One point at the peak of a tent has another colour than the ends, between which colours are mixed: of a tent in
    // one colour it is that one.
    const TransferFunction tf = inColors({kRed, kBlue});
    const std::vector<Rgb> colors = featureColors(tf);
    CHECK(hexFromRgb(colors[0]) == hexFromRgb(kRed));
    CHECK(hexFromRgb(colors[1]) == hexFromRgb(kBlue));
    // Without opacity there is no light, and the feature's own colour counts.
    CHECK(featureColors(withFeatureOpacities(tf, {0, 0.5}))[0] == tf.features[0].color);
}

TEST_CASE("the colours that Pellucid gives to features are apart for all viewers", "[alike]") {
    for (int n = 1; n <= 6; ++n) {
        INFO(n << " classes");
        CHECK(alike(inColors(classColors(n))).empty());
    }
    CHECK(alike(inColors(divergingColors())).empty());
    const TissueColors t = tissueColors();
    CHECK(alike(inColors({t.lung, t.fat, t.soft, t.bone, t.dense})).empty());
}

TEST_CASE("mended colours are apart for all viewers and keep the order of lightness", "[alike]") {
    const std::vector<std::vector<Rgb>> sets{
        {kRed, kGreen, kBlue},
        {kRed, kRed},
        {rgbFromHex("#808080"), rgbFromHex("#848484"), rgbFromHex("#888888"), rgbFromHex("#8c8c8c")},
        {kRed, kGreen, rgbFromHex("#cc6600"), rgbFromHex("#809900"), kBlue, rgbFromHex("#6040d0"), kIvory,
         rgbFromHex("#ffffff")}};
    for (const std::vector<Rgb>& colors : sets) {
        const TransferFunction tf = inColors(colors);
        INFO(colors.size() << " colours");
        REQUIRE_FALSE(alike(tf).empty());
        const std::optional<TransferFunction> mended = withColorsApart(tf, featuresToTell(tf));
        REQUIRE(mended.has_value());
        CHECK(alike(*mended).empty());
        CHECK(byLightness(*mended) == byLightness(tf));
        CHECK(featureOpacities(*mended) == featureOpacities(tf));
    }
}

TEST_CASE("colours that are apart are left alone", "[alike]") {
    const TransferFunction apart = inColors({kBlue, kIvory});
    REQUIRE(alike(apart).empty());
    CHECK(withColorsApart(apart, featuresToTell(apart)) == apart);
    // Of three, the one that is like no other keeps its colour.
    const TransferFunction tf = inColors({kRed, kGreen, kBlue});
    const std::optional<TransferFunction> mended = withColorsApart(tf, featuresToTell(tf));
    REQUIRE(mended.has_value());
    CHECK(mended->features[2].color == kBlue);
}

TEST_CASE("nobody can tell thirteen colours apart, so none are promised", "[alike]") {
    const TransferFunction tf = inColors(std::vector<Rgb>(kMostApart + 1, kRed));
    CHECK_FALSE(withColorsApart(tf, featuresToTell(tf)).has_value());
}
