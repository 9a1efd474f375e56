// Transfer functions that follow the frames of a series.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "optimize/time/tracking.h"
#include "session/frame_adapter.h"
#include "session/frame_figures.h"
#include "session/refine_priority.h"
#include "session/track_keys.h"
#include "tf/opacity.h"

using namespace pellucid;

namespace {

using Mode = AdaptSettings::Mode;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kFrames = 8;

/// Three layers one behind the other, intensities 1/6, 1/2 and 5/6; the borders between them move from frame to frame.
Volume layers(int frame) {
    constexpr int kSize = 18;
    std::vector<float> samples;
    const int first = 4 + frame / 2, second = 12 - frame / 3;
    for (int k = 0; k < kSize; ++k)
        for (int j = 0; j < kSize; ++j)
            for (int i = 0; i < kSize; ++i) {
                const bool inside = j > 1 && k > 1 && j < kSize - 2 && k < kSize - 2 && i > 0 && i < kSize - 1;
                samples.push_back(!inside ? 0.0f : i < first ? 1.0f / 6 : i < second ? 0.5f : 5.0f / 6);
            }
    return Volume(Geometry{{kSize, kSize, kSize}}, Samples(std::move(samples)));
}

/// Frame `broken` cannot be read.
Scene sceneOf(Mode mode, double coherence, int broken = -1) {
    SeriesListing listing;
    listing.title = "layers";
    listing.declaredRange = ValueRange{0, 1};
    for (int f = 0; f < kFrames; ++f) {
        SeriesFrame frame;
        frame.source.path = "layers.raw";
        frame.source.step = f;
        frame.time = f;
        frame.name = "step " + std::to_string(f);
        listing.frames.push_back(frame);
    }
    Scene basis;
    basis.series = std::make_shared<TimeSeries>(listing, [broken](int frame, const JobControl&) {
        if (frame == broken) throw FileError("it ends too early", "layers.raw", "copy it again");
        return layers(frame);
    });
    Session session = sessionOf(listing.frames[0].source);
    basis.session = session; // of the same source: resolve() takes the series
    basis.data = basis.series->load(0);
    basis.volume = std::make_shared<const Volume>(basis.data->withRange({0, 1}));
    session.setTf(tents(3, 0.2));
    session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    session.adapt.set({mode, coherence});
    return resolve(session, basis);
}

/// Makes all transfer functions that are to be made, in their order; what was made.
std::vector<AdaptedFrame> adaptAll(Scene& scene) {
    Workspace workspace;
    FrameAdapter adapter;
    std::vector<AdaptedFrame> all;
    while (const auto task = nextToAdapt(scene.session, *scene.series)) {
        try {
            all.push_back(adapter.adapt(scene, *task, workspace));
        } catch (const FileError&) { // the frame is known to be broken now
            continue;
        }
        scene.session = withAdapted(std::move(scene.session), task->frame, all.back().forTrack());
    }
    return all;
}

/// Smooths all that is to be smoothed; the tasks.
std::vector<SmoothTask> smoothAll(Scene& scene) {
    Workspace workspace;
    FrameAdapter adapter;
    std::vector<SmoothTask> tasks;
    while (auto task = nextToSmooth(scene.session, *scene.series)) {
        scene.session = withSmoothed(std::move(scene.session), adapter.smooth(scene, *task, workspace));
        tasks.push_back(std::move(*task));
        REQUIRE(tasks.size() < 10);
    }
    return tasks;
}

std::vector<int> framesOf(const std::vector<AdaptedFrame>& made) {
    std::vector<int> frames;
    for (const AdaptedFrame& f : made) frames.push_back(f.frame);
    return frames;
}

/// Frames that have to be made anew, by making them.
std::vector<int> stale(const Scene& scene) {
    Scene copy = scene;
    return framesOf(adaptAll(copy));
}

/// The key optimized to equal shares.
void optimizeKey(Scene& scene) {
    Workspace workspace;
    const OptimizeResult r = workspace.optimize(measureInput(scene), scene.targets(), {}, {});
    REQUIRE(r.converged());
    Session session = scene.session;
    session.variables.edit(
        [&](std::vector<Variable>& all) { all.front().track.keys[0] = Part<TransferFunction>(r.tf); });
    scene = resolve(session, scene);
}

std::vector<FrameFigures> figures(const Scene& scene) {
    Workspace workspace;
    std::vector<FrameFigures> all;
    std::optional<TransferFunction> before;
    for (int f = 0; f < scene.series->size(); ++f) {
        const Scene at = sceneAt(scene, f, *scene.session.tfAt(f));
        all.push_back(figuresOf(at, before ? &*before : nullptr, workspace));
        before = at.tf;
    }
    return all;
}

using Ints = std::vector<int>;

} // namespace

TEST_CASE("every frame from the key on is adapted once, each from the one before", "[adapt]") {
    Scene scene = sceneOf(Mode::Optimize, 0);
    const TransferFunction key = *scene.session.tf();
    CHECK(firstStale(scene.session, *scene.series) == 0);
    CHECK(adaptProgress(scene.session, *scene.series).all == kFrames);
    const auto made = adaptAll(scene);
    CHECK(framesOf(made) == Ints{0, 1, 2, 3, 4, 5, 6, 7});
    CHECK_FALSE(nextToAdapt(scene.session, *scene.series));
    CHECK(firstStale(scene.session, *scene.series) == -1);
    CHECK(adaptProgress(scene.session, *scene.series).done == kFrames);
    for (const AdaptedFrame& f : made) {
        CHECK(*scene.session.tfAt(f.frame) == f.tf);
        const TransferFunction previous = f.frame == 0 ? key : *scene.session.tfAt(f.frame - 1);
        CHECK(f.basis == frameFingerprint(scene.session, *scene.series, f.frame, previous));
    }
    // Static transfer functions are the keys', and nothing is to be made.
    scene.session.adapt.set({Mode::Static, 0});
    CHECK_FALSE(nextToAdapt(scene.session, *scene.series));
    CHECK(*scene.session.tfAt(5) == key);
    CHECK(*scene.session.tfAt(0) == key); // what a hand has made is still there
}

TEST_CASE("the frame that a series starts from is made, too", "[adapt]") {
    SECTION("optimize: it is on target, where the key is not") {
        for (const double coherence : {0.0, 2.0}) {
            Scene scene = sceneOf(Mode::Optimize, coherence);
            scene.session.optimize.edit([](OptimizeOptions& o) { o.exactShares = true; });
            const double key = figures(scene).front().objective;
            CHECK(key > 0.05); // equal opacities: the first layer hides the others
            adaptAll(scene);
            smoothAll(scene);
            const auto made = figures(scene);
            CHECK(made.front().objective < 0.03); // the tolerance
            CHECK(summaryOf(made).rms <= 0.02);   // 2/100; single frames may stray
            CHECK((coherence > 0 || summaryOf(made).above == 0));
        }
    }
    SECTION("refine: whatever the coherence, it is the refinement of the key") {
        for (const double coherence : {0.0, 4.0}) {
            Scene scene = sceneOf(Mode::Refine, coherence);
            const RefineResult alone = refine(*scene.histogram, scene.tf, scene.session.refine->options());
            REQUIRE(alone.iterations > 0);
            adaptAll(scene);
            const TransferFunction first = *scene.session.variable().track.adapted.at(0).tf;
            CHECK((coherence > 0 || *scene.session.tfAt(0) == first));
            REQUIRE(first.points.size() == alone.tf.points.size());
            for (std::size_t i = 0; i < first.points.size(); ++i)
                CHECK(first.points[i].opacity == Approx(alone.tf.points[i].opacity));
        }
    }
    SECTION("an edit at it is another start; until that is made anew the edit is shown") {
        Scene scene = sceneOf(Mode::Refine, 0);
        adaptAll(scene);
        const TransferFunction before = *scene.session.tfAt(0), hand = tents(3, 0.4);
        scene.session.setTf(hand);
        CHECK(featureOpacities(*scene.session.tfAt(0)) == featureOpacities(hand));
        adaptAll(scene);
        CHECK_FALSE(*scene.session.tfAt(0) == before);
        CHECK(featureOpacities(*scene.session.variable().track.keys.at(0)) == featureOpacities(hand));
    }
    SECTION("where it cannot be read the next one starts from the key") {
        Scene scene = sceneOf(Mode::Optimize, 0);
        const TransferFunction key = *scene.session.tf();
        scene.session.variables.edit([&](std::vector<Variable>& all) {
            all.front().track.keys[3] = withFeatureOpacities(key, {0.3, 0.2, 0.4});
        });
        Scene broken = sceneOf(Mode::Optimize, 0, 3);
        broken.session.variables = scene.session.variables;
        const auto made = adaptAll(broken);
        CHECK(framesOf(made) == Ints{0, 1, 2, 4, 5, 6, 7});
        CHECK(made[3].basis ==
              frameFingerprint(broken.session, *broken.series, 4, *broken.session.variable().track.keys.at(3)));
        for (const AdaptedFrame& f : made) CHECK(*f.objective < 0.03);
    }
}

TEST_CASE("frames are made anew from the first one that changes", "[adapt]") {
    Scene scene = sceneOf(Mode::Optimize, 0);
    const TransferFunction key = *scene.session.tf();
    const auto targets = [&](double first) {
        return std::map<FeatureId, double>{
            {key.features[0].id, first}, {key.features[1].id, 1}, {key.features[2].id, 1}};
    };
    scene.session.targetKeys.set({{0, targets(1)}, {4, targets(1)}, {6, targets(1)}});
    adaptAll(scene);
    CHECK(stale(scene).empty());

    SECTION("targets of a later key frame") { // between frames 4 and 6 they are halfway
        scene.session.targetKeys.edit([&](TargetKeys& keys) { keys[6] = targets(3); });
        CHECK(stale(scene) == Ints{5, 6, 7});
    }
    SECTION("another key") {
        Session session = scene.session;
        session.frame = 4;
        session.setTf(tents(3, 0.4));
        scene.session = session;
        CHECK(stale(scene) == Ints{4, 5, 6, 7}); // from what a hand has made of 4; 0 to 3 are as they were
    }
    SECTION("the only key") {
        scene.session.setTf(tents(3, 0.25));
        CHECK(stale(scene) == Ints{0, 1, 2, 3, 4, 5, 6, 7});
    }
    SECTION("the view, limits, coherence and settings of measuring") {
        const Scene before = scene;
        scene.session.camera = homeCamera(scene.volume->geometry(), Projection::Orthographic);
        CHECK(firstStale(scene.session, *scene.series) == 0);
        scene = before;
        scene.session.goals.edit([&](FeatureGoals& goals) { goals[key.features[1].id].highest = 0.9; });
        CHECK(firstStale(scene.session, *scene.series) == 0);
        scene = before;
        scene.session.adapt.set({Mode::Optimize, 0.5});
        CHECK(firstStale(scene.session, *scene.series) == 0);
        scene = before;
        scene.session.measure.edit([](MeasureSettings& m) { m.saliency.sigma = 3; });
        CHECK(firstStale(scene.session, *scene.series) == 0);
    }
    SECTION("what plays no part") {
        scene.session.refine.edit([](RefineSettings& r) { r.intensity = 0.5; });
        scene.session.display.edit([](DisplaySettings& d) { d.background = {1, 1, 1}; });
        scene.session.frame = 3;
        CHECK(stale(scene).empty());
    }
}

TEST_CASE("refinement depends on its own settings, not on the view", "[adapt]") {
    Scene scene = sceneOf(Mode::Refine, 0);
    adaptAll(scene);
    scene.session.camera = homeCamera(scene.volume->geometry(), Projection::Orthographic);
    scene.session.measure.edit([](MeasureSettings& m) { m.saliency.sigma = 3; });
    CHECK(stale(scene).empty());
    scene.session.refine.edit([](RefineSettings& r) { r.intensity = 0.5; });
    CHECK(firstStale(scene.session, *scene.series) == 0);
    adaptAll(scene);
    // A region is of the picture, and that of the view.
    scene.session.refine.edit([](RefineSettings& r) {
        r.intensity.reset();
        r.region = ImageRegion{{{0.3, 0.3}, {0.7, 0.3}, {0.7, 0.7}, {0.3, 0.7}}};
    });
    CHECK(firstStale(scene.session, *scene.series) == 0);
    adaptAll(scene);
    CHECK(stale(scene).empty());
    scene.session.camera.reset();
    CHECK(firstStale(scene.session, *scene.series) == 0);
}

TEST_CASE("a hue is the same colour in every frame, and each frame goes on from the one before", "[adapt]") {
    Scene scene = sceneOf(Mode::Refine, 0);
    // Hue 60 is that of the first tent's points (tents(): 360 degrees times the centre, 1/6).
    scene.session.refine.edit([](RefineSettings& r) { r.hue = 60; });
    const TransferFunction key = scene.tf;
    RefineOptions by = scene.session.refine->options();
    by.priority.intensity = intensityOfHue(key, 60);
    CHECK(*by.priority.intensity == Approx(1.0 / 6));
    const auto made = adaptAll(scene);
    REQUIRE(made.size() == kFrames);
    TransferFunction before = key;
    for (const AdaptedFrame& f : made) {
        const Scene at = sceneAt(scene, f.frame, before);
        const RefineResult alone = refine(*at.histogram, at.tf, by);
        CHECK(f.tf == alone.tf);
        CHECK(f.priority == by.priority);
        REQUIRE(f.energy);
        CHECK(f.energy->before == alone.energyBefore);
        CHECK(f.energy->after == alone.energyAfter);
        CHECK(f.energy->movableBefore == alone.energyMovableBefore);
        CHECK(f.energy->movableAfter == alone.energyMovableAfter);
        before = f.tf;
    }
    CHECK(stale(scene).empty());
    // The key's colours are what the hue is looked for in.
    scene.session.refine.edit([](RefineSettings& r) { r.hue = 300; });
    CHECK(firstStale(scene.session, *scene.series) == 0);
}

TEST_CASE("of two places of one hue the key's more opaque one stays meant", "[adapt]") {
    Scene scene = sceneOf(Mode::Refine, 0);
    Session session = scene.session;
    TransferFunction tf = tents(3, 0.2); // points 0..8, the peaks are 1, 4 and 7
    for (const std::size_t i : {6, 7, 8}) tf.points[i].color = tf.points[0].color;
    tf.points[7].opacity = 0.21;
    session.variables.edit([](std::vector<Variable>& all) { all.front().track = {}; });
    session.setTf(tf);
    session.refine.edit([](RefineSettings& r) { r.hue = 60; });
    scene = resolve(session, scene);
    for (const AdaptedFrame& f : adaptAll(scene)) CHECK(f.priority.intensity == Approx(5.0 / 6)); // that of peak 7
}

TEST_CASE("a region's colours are those of the key's picture in all frames", "[adapt]") {
    Scene scene = sceneOf(Mode::Refine, 0);
    const ImageRegion region{{{0.3, 0.3}, {0.7, 0.3}, {0.7, 0.7}, {0.3, 0.7}}};
    scene.session.refine.edit([&](RefineSettings& r) {
        r.region = region;
        r.regionSize = {48, 32};
    });
    const std::vector<RegionColor> colors = regionColors(scene, region, {48, 32});
    double pixels = 0;
    for (const RegionColor& c : colors) pixels += c.count;
    // Pixel centres within [0.3, 0.7): 14.4 ≤ i + ½ < 33.6 are 20 of 48, 9.6 ≤ j + ½ < 22.4 are 12 of 32.
    CHECK(pixels == 20 * 12);
    TransferFunction before = scene.tf;
    for (const AdaptedFrame& f : adaptAll(scene)) {
        CHECK(f.priority.region == colors);
        const Scene at = sceneAt(scene, f.frame, before);
        RefineOptions by = scene.session.refine->options();
        by.priority.region = colors;
        CHECK(f.tf == refine(*at.histogram, at.tf, by).tf);
        before = f.tf;
    }
}

TEST_CASE("infinite coherence is a static transfer function", "[adapt]") {
    for (const Mode mode : {Mode::Optimize, Mode::Refine}) {
        Scene scene = sceneOf(mode, kInfinite);
        const TransferFunction key = *scene.session.tf();
        for (const AdaptedFrame& f : adaptAll(scene)) {
            CHECK(f.tf == key);
            CHECK(f.moves == 0);
        }
        for (const FrameFigures& f : figures(scene)) CHECK(f.flicker.value_or(0) == 0);
    }
}

TEST_CASE("without coherence every frame is on target", "[adapt]") {
    Scene scene = sceneOf(Mode::Optimize, 0);
    optimizeKey(scene);
    const auto made = adaptAll(scene);
    CHECK(made.front().moves == 0); // it is where it is wanted
    int moves = 0;
    for (const AdaptedFrame& f : made) {
        CHECK(*f.objective <= kTrackGoal);
        moves += f.moves;
    }
    CHECK(moves <= 2 * (kFrames - 1));
    const auto dynamic = figures(scene);
    for (std::size_t i = 0; i < dynamic.size(); ++i) // what the adapter said is what is measured
        CHECK(dynamic[i].objective == Approx(*made[i].objective).margin(1e-7));
    scene.session.adapt.set({Mode::Static, 0});
    const auto fixed = figures(scene);
    CHECK(summaryOf(dynamic).rms < 0.1 * summaryOf(fixed).rms);
    CHECK(summaryOf(fixed).flicker == 0);
    CHECK(summaryOf(dynamic).flicker > 0);
}

TEST_CASE("coherence trades the distance from the targets for flicker", "[adapt]") {
    double flicker = kInfinite;
    for (const double coherence : {0.0, 1.0, 3.0}) {
        Scene scene = sceneOf(Mode::Optimize, coherence);
        optimizeKey(scene);
        adaptAll(scene);
        const auto frames = figures(scene);
        for (const FrameFigures& f : frames) CHECK(f.objective <= std::max(kTrackGoal, 0.01 * coherence));
        CHECK(summaryOf(frames).flicker < flicker);
        flicker = summaryOf(frames).flicker;
    }
}

TEST_CASE("frames are smoothed together once all are made", "[adapt]") {
    Scene scene = sceneOf(Mode::Optimize, 2);
    optimizeKey(scene);
    CHECK_FALSE(nextToSmooth(scene.session, *scene.series)); // nothing is made yet
    adaptAll(scene);
    const auto forward = figures(scene);
    CHECK(adaptProgress(scene.session, *scene.series).smooth == 0);
    const auto tasks = smoothAll(scene);
    REQUIRE(tasks.size() == 1);
    CHECK(tasks[0].key == 0);
    CHECK(tasks[0].frames == Ints{0, 1, 2, 3, 4, 5, 6, 7});
    const AdaptProgress progress = adaptProgress(scene.session, *scene.series);
    CHECK(progress.smooth == progress.all);
    const auto smooth = figures(scene);
    CHECK(summaryOf(smooth).flicker < 0.95 * summaryOf(forward).flicker); // all borders drift one way
    CHECK(summaryOf(smooth).rms <= 0.02);
    CHECK_FALSE(nextToAdapt(scene.session, *scene.series)); // what they were made of is still there

    SECTION("a frame that is made anew is smoothed anew, with all others") {
        scene.session.variables.edit([](std::vector<Variable>& all) { all.front().track.adapted.erase(4); });
        CHECK_FALSE(nextToSmooth(scene.session, *scene.series));
        CHECK(framesOf(adaptAll(scene)) == Ints{4}); // those after it come out as they are
        CHECK(adaptProgress(scene.session, *scene.series).smooth == 0);
        CHECK(smoothAll(scene).size() == 1);
    }
    SECTION("other targets") {
        scene.session.goals.edit([&](FeatureGoals& goals) { goals[scene.tf.features[0].id].target = 2; });
        CHECK_FALSE(nextToSmooth(scene.session, *scene.series)); // first they are made
        adaptAll(scene);
        CHECK(smoothAll(scene).size() == 1);
    }
    SECTION("without coherence, and with nothing but it, nothing is smoothed") {
        for (const double coherence : {0.0, kInfinite}) {
            scene.session.adapt.set({Mode::Optimize, coherence});
            adaptAll(scene);
            CHECK_FALSE(nextToSmooth(scene.session, *scene.series));
            const AdaptProgress p = adaptProgress(scene.session, *scene.series);
            CHECK(p.smooth == p.all);
        }
    }
}

TEST_CASE("what is made does not depend on light, background and mode, with coherence either", "[adapt]") {
    Scene scene = sceneOf(Mode::Optimize, 2);
    optimizeKey(scene);
    Scene lit = scene;
    lit.session.display.edit([](DisplaySettings& d) {
        d.background = {1, 1, 1};
        d.light.on = true;
        d.mode = RenderMode::Mip;
    });
    lit = resolve(lit.session, lit);
    const auto plain = adaptAll(scene), other = adaptAll(lit);
    for (std::size_t i = 0; i < plain.size(); ++i) {
        CHECK(plain[i].tf == other[i].tf);
        CHECK(plain[i].basis == other[i].basis);
    }
    smoothAll(scene);
    smoothAll(lit);
    for (int f = 0; f < kFrames; ++f) CHECK(*scene.session.tfAt(f) == *lit.session.tfAt(f));
}

TEST_CASE("a transfer function without features is not smoothed", "[adapt]") {
    Scene scene = sceneOf(Mode::Optimize, 2);
    TransferFunction plain = *scene.session.tf();
    plain.features.clear();
    scene.session.setTf(plain);
    scene = resolve(scene.session, scene);
    adaptAll(scene);
    CHECK_FALSE(nextToSmooth(scene.session, *scene.series));
    const AdaptProgress progress = adaptProgress(scene.session, *scene.series);
    CHECK(progress.smooth == progress.all);
}

TEST_CASE("smoothed transfer functions are put beside those that they came from alone", "[adapt]") {
    Scene scene = sceneOf(Mode::Optimize, 2);
    adaptAll(scene);
    Workspace workspace;
    FrameAdapter adapter;
    const auto task = nextToSmooth(scene.session, *scene.series);
    REQUIRE(task);
    const SmoothedFrames smooth = adapter.smooth(scene, *task, workspace);
    scene.session.variables.edit([](std::vector<Variable>& all) { all.front().track.adapted.at(3).basis = "other"; });
    const Session put = withSmoothed(scene.session, smooth);
    CHECK(put.variable().track.adapted.at(2).smooth);
    CHECK_FALSE(put.variable().track.adapted.at(3).smooth);
}

TEST_CASE("smoothing ends at keys and passes over broken frames", "[adapt]") {
    Scene scene = sceneOf(Mode::Optimize, 2, 6);
    optimizeKey(scene);
    TransferFunction second = *scene.session.tf();
    second = withFeatureOpacities(second, {0.3, 0.2, 0.4});
    scene.session.variables.edit([&](std::vector<Variable>& all) { all.front().track.keys[3] = second; });
    adaptAll(scene);
    const auto tasks = smoothAll(scene);
    REQUIRE(tasks.size() == 2);
    CHECK(tasks[0].frames == Ints{0, 1, 2});
    CHECK(tasks[1].key == 3);
    CHECK(tasks[1].frames == Ints{3, 4, 5, 7});

    // Another key changes what lies before it, too: the jump to it counts.
    scene.session.variables.edit([&](std::vector<Variable>& all) {
        all.front().track.keys[3] = withFeatureOpacities(second, {0.2, 0.2, 0.2});
    });
    adaptAll(scene);
    CHECK(smoothAll(scene).size() == 2);
}

TEST_CASE("models of frames that are kept, and those taken anew, give the same", "[adapt]") {
    Scene scene = sceneOf(Mode::Optimize, 2);
    optimizeKey(scene);
    Workspace workspace;
    FrameAdapter adapter;
    while (const auto task = nextToAdapt(scene.session, *scene.series)) {
        const AdaptedFrame made = adapter.adapt(scene, *task, workspace);
        scene.session = withAdapted(std::move(scene.session), made.frame, made.forTrack());
    }
    const auto task = nextToSmooth(scene.session, *scene.series);
    REQUIRE(task);
    const SmoothedFrames kept = adapter.smooth(scene, *task, workspace);
    Workspace otherWorkspace;
    FrameAdapter other;
    const SmoothedFrames anew = other.smooth(scene, *task, otherWorkspace);
    REQUIRE(kept.tfs.size() == kFrames); // the first one gives way, too
    REQUIRE(anew.tfs.size() == kFrames);
    for (const auto& [frame, tf] : kept.tfs) {
        const auto x = featureOpacities(tf), y = featureOpacities(anew.tfs.at(frame));
        INFO("frame " << frame);
        for (std::size_t f = 0; f < x.size(); ++f) CHECK(x[f] == Approx(y[f]).epsilon(1e-6));
    }
    CHECK(featureOpacities(kept.tfs.at(0)) != featureOpacities(*scene.session.tfAt(0)));
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(adapter.smooth(scene, *task, workspace, {stop.get_token(), {}}), Cancelled);
}

TEST_CASE("coherence evens out the steps of refinements, and changes nothing in the chain", "[adapt]") {
    Scene scene = sceneOf(Mode::Refine, 0);
    scene.session.refine.edit([](RefineSettings& r) { r.intensity = 0.5; }); // ever more of it
    const auto free = adaptAll(scene);
    CHECK_FALSE(nextToSmooth(scene.session, *scene.series));
    const Scene at = sceneAt(scene, 1, free[0].tf);
    RefineOptions options = scene.session.refine->options();
    options.priority.intensity = 0.5;
    const RefineResult alone = refine(*at.histogram, at.tf, options);
    CHECK(free[1].tf == alone.tf);
    CHECK(free[1].moves == alone.iterations);
    double flicker = summaryOf(figures(scene)).flicker;
    REQUIRE(flicker > 0);
    for (const double weight : {0.5, 2.0, 8.0}) {
        scene.session.adapt.set({Mode::Refine, weight});
        const auto held = adaptAll(scene);
        REQUIRE(held.size() == free.size());
        for (std::size_t f = 0; f < free.size(); ++f) CHECK(held[f].tf == free[f].tf);
        REQUIRE(smoothAll(scene).size() == 1);
        // At the minimum of Σ (x_t − r_t)² + λ Σ (x_t − x_(t−1))² every derivative is 0:
        // x_t − r_t + λ (x_t − x_(t−1)) + λ (x_t − x_(t+1)) = 0, without the neighbours that are not there.
        for (std::size_t p = 0; p < free[0].tf.points.size(); ++p)
            for (int t = 0; t < kFrames; ++t) {
                const auto x = [&](int frame) { return scene.session.tfAt(frame)->points[p].opacity; };
                double slope = x(t) - free[static_cast<std::size_t>(t)].tf.points[p].opacity;
                if (t > 0) slope += weight * (x(t) - x(t - 1));
                if (t + 1 < kFrames) slope += weight * (x(t) - x(t + 1));
                CHECK(slope == Approx(0).margin(1e-12));
            }
        const double now = summaryOf(figures(scene)).flicker;
        CHECK(now < flicker);
        flicker = now;
    }
    // Up to a key, whose frame stays as it was made.
    scene.session.variables.edit([&](std::vector<Variable>& all) { all.front().track.keys[5] = tents(3, 0.3); });
    adaptAll(scene);
    const auto tasks = smoothAll(scene);
    REQUIRE(tasks.size() == 2);
    CHECK(tasks[0].frames == Ints{0, 1, 2, 3, 4});
    CHECK(tasks[1].frames == Ints{5, 6, 7});
}

TEST_CASE("a broken frame is passed over", "[adapt]") {
    Scene scene = sceneOf(Mode::Optimize, 0, 3);
    const auto made = adaptAll(scene);
    CHECK(framesOf(made) == Ints{0, 1, 2, 4, 5, 6, 7});
    CHECK(scene.series->summary(3).problem == "it ends too early");
    // The next one starts from the last that there is.
    CHECK(made[3].basis == frameFingerprint(scene.session, *scene.series, 4, made[2].tf));
    CHECK(adaptProgress(scene.session, *scene.series).all == kFrames - 1);
    CHECK(brokenFigures(*scene.series, 3).problem == "it ends too early");
}

TEST_CASE("flicker is the change of one frame's picture under two transfer functions", "[adapt]") {
    Scene scene = sceneOf(Mode::Static, 0);
    Workspace workspace;
    const TransferFunction tf = *scene.session.tf(), none = withFeatureOpacities(tf, {0, 0, 0});
    const Scene at = sceneAt(scene, 2, tf);
    CHECK_FALSE(figuresOf(at, nullptr, workspace).flicker);
    CHECK(*figuresOf(at, &at.tf, workspace).flicker == 0);
    const double toBlack = *figuresOf(at, &none, workspace).flicker;
    CHECK(toBlack > 1);
    // The other way round it is the same two pictures.
    CHECK(*figuresOf(sceneAt(scene, 2, none), &at.tf, workspace).flicker == Approx(toBlack));
}

TEST_CASE("adapted transfer functions have the same bits on one thread and on two", "[adapt]") {
    std::array<std::vector<AdaptedFrame>, 2> made;
    std::array<std::vector<FrameFigures>, 2> shown;
    for (std::size_t i = 0; i < 2; ++i) {
        setThreadCount(static_cast<int>(i) + 1);
        Scene scene = sceneOf(Mode::Optimize, 1);
        made[i] = adaptAll(scene);
        shown[i] = figures(scene);
    }
    setThreadCount(0);
    REQUIRE(made[0].size() == made[1].size());
    for (std::size_t f = 0; f < made[0].size(); ++f) {
        CHECK(made[0][f].tf == made[1][f].tf);
        CHECK(made[0][f].basis == made[1][f].basis);
        CHECK(shown[0][f].flicker == shown[1][f].flicker);
        CHECK(shown[0][f].vws == shown[1][f].vws);
    }
}

TEST_CASE("keys of both kinds are set, found and removed", "[adapt]") {
    Session session = sceneOf(Mode::Refine, 1).session;
    setTfKey(session);
    session.frame = 3;
    setTfKey(session);
    session = withAdapted(std::move(session), 4, {});
    session.frame = 5;
    setTargetKey(session);
    const auto& track = [&]() -> const TfTrack& { return session.variable().track; };
    CHECK(track().keys.size() == 2);
    CHECK(session.targetKeys->size() == 1);
    CHECK(keyBeside(session, 1, 1) == 3);
    CHECK(keyBeside(session, 3, 1) == 5);
    CHECK(keyBeside(session, 3, -1) == 0);
    CHECK_FALSE(keyBeside(session, 5, 1).has_value());
    CHECK_FALSE(keyBeside(session, 0, -1).has_value());

    Session other = session;
    other.frame = 3;
    removeTfKey(other);
    CHECK(other.variable().track.keys.size() == 1);
    CHECK(adaptsOtherwise(session, other));
    CHECK_FALSE(adaptsOtherwise(session, session));

    session.frame = 2;
    beginTracksHere(session); // what is later goes
    CHECK(track().keys.contains(0));
    CHECK(track().keys.contains(2));
    CHECK_FALSE(track().keys.contains(3));
    CHECK(track().adapted.empty());
}
