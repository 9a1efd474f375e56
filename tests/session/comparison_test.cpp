// Two states beside each other: B as a session, pairs of features, figures of both.
#include <catch2/catch.hpp>

#include "render/camera_motion.h"
#include "session/comparison.h"

using namespace pellucid;

namespace {

Scene sceneOf(const std::string& tf, const std::string& sample = "sample:shells") {
    SceneInputs in;
    VolumeSource source;
    source.path = sample;
    source.sampleSize = 16;
    in.session = sessionOf(source);
    in.tf = tf;
    in.session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    return openScene(in);
}

FeatureFigures figures(const std::string& name, double vws) { return {name, {}, false, vws, 0.5, 0.25, {}}; }

} // namespace

TEST_CASE("B has its transfer function, and view, frame and look where they are not shared", "[comparison]") {
    Scene scene = sceneOf("tents:3:0.1", "sample:vortex");
    ComparedState b = comparedState(sceneOf("tents:2:0.7", "sample:vortex"), "other");
    b.frame = 4;
    b.camera = standardCamera(scene.volume->geometry(), 90, 0, Projection::Orthographic);
    b.display.edit([](DisplaySettings& d) { d.background = {1, 1, 1}; });
    b.clipping.edit([](Clipping& c) { c.lo.x = 0.25; });
    ComparisonView view;
    view.b = b;
    scene.session.comparison = view;
    scene.session.camera = scene.camera;
    const Session same = comparedSession(scene.session);
    CHECK(same.tf()->points == b.tf->points);
    CHECK(same.camera == scene.camera);
    CHECK(same.frame == 0);
    CHECK(same.display == scene.session.display);
    CHECK(same.clipping == scene.session.clipping);
    CHECK_FALSE(same.comparison->b);
    view.sameView = view.sameFrame = view.sameLook = false;
    scene.session.comparison = view;
    const Session own = comparedSession(scene.session);
    CHECK(own.camera == b.camera);
    CHECK(own.frame == 4);
    CHECK(own.display == b.display);
    CHECK(own.clipping == b.clipping);
    // It needs another frame alone; of the present one it shares the volume.
    CHECK(resolve(same, scene).volume == scene.volume);
    CHECK(needsData(own, scene));
}

TEST_CASE("a B under keys and adaption is the same in all frames", "[comparison]") {
    Scene scene = sceneOf("tents:3:0.1", "sample:vortex");
    ComparisonView view;
    view.b = comparedState(scene, "pinned");
    scene.session.adapt.edit([](AdaptSettings& a) { a.mode = AdaptSettings::Mode::Refine; });
    scene.session.frame = 3;
    scene.session.setTf(*sceneOf("tents:2:0.7", "sample:vortex").session.tf());
    scene.session.comparison = view;
    const Session b = comparedSession(scene.session);
    CHECK(b.adapt->mode == AdaptSettings::Mode::Static);
    for (const int frame : {0, 3, 8}) CHECK(b.tfAt(frame)->points == view.b->tf->points);
}

TEST_CASE("features are paired by their names", "[comparison]") {
    const auto pairs =
        pairsOf({figures("skin", 0.2), figures("bone", 0.8)}, {figures("bone", 0.6), figures("fat", 0.4)});
    REQUIRE(pairs.size() == 3);
    CHECK(pairs[0].name == "skin");
    CHECK_FALSE(pairs[0].b);
    CHECK(pairs[1].name == "bone");
    CHECK(pairs[1].a->vws == 0.8);
    CHECK(pairs[1].b->vws == 0.6);
    CHECK(pairs[2].name == "fat");
    CHECK_FALSE(pairs[2].a);
}

TEST_CASE("of features of one name, the first belongs to the first", "[comparison]") {
    const auto pairs = pairsOf({figures("bone", 0.1), figures("bone", 0.2)},
                               {figures("bone", 0.3), figures("bone", 0.4), figures("bone", 0.5)});
    REQUIRE(pairs.size() == 3);
    CHECK(pairs[0].b->vws == 0.3);
    CHECK(pairs[1].a->vws == 0.2);
    CHECK(pairs[1].b->vws == 0.4);
    CHECK_FALSE(pairs[2].a);
    CHECK(pairs[2].b->vws == 0.5);
}

TEST_CASE("equal states differ in nothing, and figures are those that are measured", "[comparison]") {
    const Scene scene = sceneOf("tents:3:0.1");
    const SideInput input = sideInput(scene, pictureInput(scene, 32, 24), true);
    Workspace workspace;
    const Measures measures = workspace.measure(input.measure);
    const auto renderer = makeCpuRenderer(scene.volume);
    const ComparedSide side = comparedSide(input, measures, *renderer);
    const Comparison same = comparisonOf("a", side, "b", side);
    CHECK(same.difference.largest == 0);
    CHECK(same.difference.ssim == 1);
    REQUIRE(same.features.size() == 3);
    double shares = 0;
    for (std::size_t f = 0; f < 3; ++f) {
        CHECK(same.features[f].a->vws == measures.features[f].vws);
        CHECK(same.features[f].a->visibility == measures.features[f].visibility);
        CHECK(same.features[f].b->opacity == Approx(0.1));
        shares += same.features[f].a->fs.value();
    }
    CHECK(shares == Approx(1)); // 2D feature saliency is shared out
    // Without it the picture is the same.
    SideInput plain = input;
    plain.withSaliency = false;
    const ComparedSide drawn = comparedSide(plain, measures, *renderer);
    CHECK_FALSE(drawn.features[0].fs);
    CHECK(drawn.image.rgba == side.image.rgba);
}
