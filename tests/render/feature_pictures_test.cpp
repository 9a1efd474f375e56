// The pictures of features alone.
#include "render/feature_pictures.h"

#include <catch2/catch.hpp>

#include "render/ground.h"
#include "support/sample_tf.h"
#include "tf/shapes.h"
#include "tf/shown_tf.h"
#include "volume/procedural.h"

using namespace pellucid;

namespace {

struct Disks {
    std::shared_ptr<const Volume> volume = std::make_shared<Volume>(makeSample("disks", 24));
    std::unique_ptr<TileRenderer> renderer = makeCpuRenderer(volume);
    TransferFunction tf = disksTf();
    Camera camera = cameraFromView(volume->geometry(), -50, 20, 1, Projection::Perspective);
    RenderSettings settings;

    Disks() {
        settings.width = 60;
        settings.height = 44;
    }
    FeaturePictures pictures() { return featurePictures(*renderer, camera, tf, settings); }
};

double largestDifference(const Image& a, const Image& b, int components) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    double most = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        if (static_cast<int>(i % 4) < components)
            most = std::max(most, std::abs(static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i])));
    return most;
}

float largestAlpha(const Image& image) {
    float most = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) most = std::max(most, image.rgba[i]);
    return most;
}

} // namespace

TEST_CASE("a feature's picture is that with the eyes of the others shut", "[picture]") {
    Disks s;
    s.settings.background = Rgb{0.1, 0.3, 0.2};
    s.settings.backgroundTop = Rgb{0.8, 0.7, 0.6};
    s.settings.light.on = GENERATE(false, true);
    const FeaturePictures pictures = s.pictures();
    CHECK(largestDifference(pictures.whole, s.renderer->render(s.camera, s.tf, s.settings), 4) == 0);
    REQUIRE(pictures.alone.size() == 3);
    for (int f = 0; f < 3; ++f) {
        TransferFunction others = s.tf;
        for (int other = 0; other < 3; ++other)
            if (other != f) others = withFeatureHidden(others, other, true);
        const TransferFunction alone = shownTf(others);
        const Image& picture = pictures.alone[static_cast<std::size_t>(f)];
        // Tents end at opacity 0, so nothing lies between the features; what the lighting of edges makes of both is
        // the same to a 255th.
        CHECK(largestDifference(picture, s.renderer->render(s.camera, alone, s.settings), 3) < 1.0 / 255);
        RenderSettings transparent = s.settings;
        transparent.background.reset();
        transparent.backgroundTop.reset();
        const Image clear = s.renderer->render(s.camera, alone, transparent);
        for (std::size_t i = 3; i < clear.rgba.size(); i += 4) CHECK((clear.rgba[i] > 0) == (picture.rgba[i] > 0));
    }
}

TEST_CASE("what is not drawn is nowhere in its picture", "[picture]") {
    Disks s;
    SECTION("hidden") { s.tf = shownTf(withFeatureHidden(s.tf, 1, true)); }
    SECTION("of no opacity") { s.tf = withFeatureOpacities(s.tf, {0.5, 0, 0.5}); }
    SECTION("another one is drawn alone") { s.settings.onlyFeature = 2; }
    const FeaturePictures pictures = s.pictures();
    CHECK(largestAlpha(pictures.alone[1]) == 0);
    CHECK(largestAlpha(pictures.alone[2]) > 0);
    if (s.settings.onlyFeature == 2) CHECK(largestAlpha(pictures.alone[0]) == 0);
    CHECK(featureSaliency(pictures).shares[1] == 0);
}

TEST_CASE("the ground is seen behind every feature, and is none", "[picture]") {
    Disks s;
    auto ground = std::make_shared<Ground>(); // flat, at half the height of the volume
    ground->nx = ground->ny = 2;
    ground->heights = {0, 0, 0, 0};
    const Geometry& g = s.volume->geometry();
    ground->origin = {g.corner(0).x, g.corner(0).y, g.boxCenter().z};
    ground->stepX = g.corner(1) - g.corner(0);
    ground->stepY = g.corner(2) - g.corner(0);
    const FeaturePictures without = s.pictures();
    s.settings.ground = ground;
    const FeaturePictures with = s.pictures();
    CHECK(largestDifference(with.whole, s.renderer->render(s.camera, s.tf, s.settings), 4) == 0);
    CHECK(largestDifference(with.whole, without.whole, 3) > 0.1);
    for (std::size_t f = 0; f < 3; ++f) {
        CHECK(largestDifference(with.alone[f], without.alone[f], 3) > 0.1);
        int seen = 0, hidden = 0, invented = 0; // pixels of the feature
        for (std::size_t i = 3; i < with.alone[f].rgba.size(); i += 4) {
            const bool is = with.alone[f].rgba[i] > 0, was = without.alone[f].rgba[i] > 0;
            seen += is && was;
            hidden += !is && was;
            invented += is && !was;
        }
        CHECK(seen > 0);
        CHECK(hidden > 0); // the lower part of a disk, from above
        CHECK(invented == 0);
    }
}
