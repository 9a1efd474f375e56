// What a picture is made of, with a second volume over the first.
#include <catch2/catch.hpp>

#include <cmath>
#include <numeric>

#include "render/overlay.h"
#include "render/picture_shares.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Layers along x, looked at along x: of intensities 0.2, 0.5 and 0.8, 8 voxels each, over 0 in a volume of 28.
std::shared_ptr<const Volume> layers() {
    const Geometry g{{28, 12, 12}, Vec3(1), Vec3(0)};
    return volumeFrom(g, [](int i, int, int) { return i < 2 || i >= 26 ? 0 : i < 10 ? 0.2 : i < 18 ? 0.5 : 0.8; });
}

Camera alongX() {
    Camera c;
    c.projection = Projection::Orthographic;
    c.eye = {-100, 5.5, 5.5};
    c.center = {14, 5.5, 5.5};
    c.height = 4; // the middle of the layers, all through
    return c;
}

RenderSettings small() {
    RenderSettings s;
    s.width = s.height = 8;
    s.stepInD0 = 0.25;
    s.finestInD0 = 1.0 / 64;
    return s;
}

/// Boxes of opacity 0.05, 0.1 and 0.2 around the three intensities; between them and before the first nothing.
TransferFunction threeBoxes() {
    TransferFunction tf;
    const double opacity[] = {0.05, 0.1, 0.2};
    const double middle[] = {0.2, 0.5, 0.8};
    for (int f = 0; f < 3; ++f) {
        const double a = middle[f] - 0.02, b = middle[f] + 0.02;
        tf.points.push_back({a, 0, {0.3, 0.6, 0.9}, false, {}});
        tf.points.push_back({a, opacity[f], {0.3, 0.6, 0.9}, false, {}});
        tf.points.push_back({b, opacity[f], {0.9, 0.2, 0.1}, false, {}});
        tf.points.push_back({b, 0, {0.9, 0.2, 0.1}, false, {}});
        tf.features.push_back({"f" + std::to_string(f + 1), a, b, {0.3, 0.6, 0.9}, {}});
    }
    return tf;
}

} // namespace

TEST_CASE("layers have of a picture what they absorb of what comes to them", "[shares]") {
    const auto volume = layers();
    const auto renderer = makeCpuRenderer(volume);
    RenderSettings settings = small();
    settings.light.on = true; // which shares do not depend on
    settings.background = Rgb{1, 1, 1};
    const PictureShares shares = pictureShares(*renderer, alongX(), threeBoxes(), settings);
    REQUIRE(shares.features.size() == 3);
    // Between samples of one layer lie 7 voxels, and next to them the intensity is in the box for a small part of the
    // way to the next: 0.02/0.3 of a voxel on either side, of the first layer 0.02/0.2 outside.
    const double ways[] = {7 + 0.02 / 0.2 + 0.02 / 0.3, 7 + 2 * 0.02 / 0.3, 7 + 0.02 / 0.3 + 0.02 / 0.8};
    double clear = 1;
    const double opacity[] = {0.05, 0.1, 0.2};
    for (std::size_t f = 0; f < 3; ++f) {
        const double left = clear * std::pow(1 - opacity[f], ways[f]);
        CHECK(shares.features[f] == Approx(clear - left).margin(0.004));
        clear = left;
    }
    CHECK(shares.alpha == Approx(1 - clear).margin(0.004));
    CHECK(shares.overlay == 0);
    CHECK(shares.rest == Approx(0).margin(0.004));
}

TEST_CASE("an overlay has its share, and takes from what lies behind it", "[shares]") {
    const auto volume = layers();
    const auto renderer = makeCpuRenderer(volume);
    RenderSettings settings = small();
    const PictureShares alone = pictureShares(*renderer, alongX(), threeBoxes(), settings);

    // In the place of the second layer, of constant intensity 1 of its own: opacity 0.1 over 9 voxels.
    auto overlay = std::make_shared<Overlay>();
    Geometry g{{8, 12, 12}, Vec3(1), {10, 0, 0}};
    overlay->geometry = g;
    overlay->volume = volumeFrom(g, [](int, int j, int) { return j == 0 ? 0.0 : 1.0; });
    overlay->tf.points = {
        {0.9, 0, {1, 0, 0}, false, {}}, {0.95, 0.1, {1, 0, 0}, false, {}}, {1, 0.1, {1, 0, 0}, false, {}}};
    settings.overlay = overlay;
    const PictureShares both = pictureShares(*renderer, alongX(), threeBoxes(), settings);
    CHECK(both.features[0] == Approx(alone.features[0]).margin(0.004)); // in front
    // The two media absorb in the proportion of their extinctions where both are: over the 7 voxels, and the overlay
    // alone half a voxel to either side, in its box.
    const double before = 1 - both.features[0];
    const double half = std::pow(0.9, 0.5), through = std::pow(0.9, 14.0);
    const double shared = before * half * (1 - through);
    CHECK(both.features[1] == Approx(shared / 2).margin(0.02));
    CHECK(both.overlay == Approx(before * (1 - half) + shared / 2 + before * half * through * (1 - half)).margin(0.02));
    CHECK(both.features[2] < 0.6 * alone.features[2]);
    const double sum = std::accumulate(both.features.begin(), both.features.end(), both.overlay + both.rest);
    CHECK(sum == Approx(both.alpha).margin(1e-4));
}

TEST_CASE("more features than a picture has channels are told apart, and what is in none is the rest", "[shares]") {
    const auto volume = layers();
    const auto renderer = makeCpuRenderer(volume);
    TransferFunction tf = threeBoxes();
    const PictureShares three = pictureShares(*renderer, alongX(), tf, small());
    // Two more that no voxel has, before the three.
    tf.features.insert(tf.features.begin(),
                       {{"none", 0.02, 0.05, {1, 1, 1}, {}}, {"neither", 0.06, 0.1, {1, 1, 1}, {}}});
    const PictureShares five = pictureShares(*renderer, alongX(), tf, small());
    REQUIRE(five.features.size() == 5);
    CHECK(five.features[0] == Approx(0).margin(1e-6));
    for (std::size_t f = 0; f < 3; ++f) CHECK(five.features[f + 2] == Approx(three.features[f]).margin(1e-4));

    tf = threeBoxes();
    const double second = three.features[1];
    tf.features.erase(tf.features.begin() + 1);
    const PictureShares two = pictureShares(*renderer, alongX(), tf, small());
    CHECK(two.rest == Approx(second).margin(0.004));
}
