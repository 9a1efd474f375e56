// Figures do not depend on what was computed before.
#include <algorithm>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "optimize/objective.h"
#include "optimize/ray_vws.h"
#include "render/camera_motion.h"
#include "render/cpu/cpu_engine.h"
#include "session/workspace.h"

using namespace pellucid;

namespace {

/// `size`: voxels along the longest axis; 0: as the sample is.
Scene sceneOf(const std::string& sample, const std::string& tf, int size = 20) {
    SceneInputs in;
    VolumeSource source;
    source.path = sample;
    if (size > 0) source.sampleSize = size;
    in.session = sessionOf(source);
    in.tf = tf;
    in.session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    return openScene(in);
}

bool same(const Measures& a, const Measures& b) {
    const auto sameFigures = [](const FeatureMeasures& f, const FeatureMeasures& g) {
        return f.visibility == g.visibility && f.vws == g.vws && f.vwsBrightness == g.vwsBrightness &&
               f.vwsSaturation == g.vwsSaturation;
    };
    return a.opacities == b.opacities && a.visibilityHistogram == b.visibilityHistogram &&
           std::equal(a.features.begin(), a.features.end(), b.features.begin(), b.features.end(), sameFigures);
}

Measures fresh(const MeasureInput& input) {
    Workspace workspace;
    return workspace.measure(input);
}

/// All that one may change, one after the other.
std::vector<MeasureInput> variations() {
    const Scene scene = sceneOf("sample:shells", "tents:3:0.1");
    const MeasureInput plain = measureInput(scene);
    std::vector<MeasureInput> all{plain};
    const auto add = [&](const auto& change) {
        MeasureInput input = plain;
        change(input);
        all.push_back(std::move(input));
    };
    add([](MeasureInput& i) { i.tf = withFeatureOpacities(i.tf, {0.02, 0.3, 0.9}); });
    add([](MeasureInput& i) { i.tf.features[1].b += 0.02; });
    add([](MeasureInput& i) {
        i.tf.points[4].color = {0.2, 0.9, 0.4};
        i.tf.features[1].color = {0.2, 0.9, 0.4};
    });
    add([](MeasureInput& i) { i.tf = tents(5); });
    add([](MeasureInput& i) { i.view = cameraFromView(i.volume->geometry(), 80, -10, 1, Projection::Orthographic); });
    add([](MeasureInput& i) { i.settings.quality = Quality::High; });
    add([](MeasureInput& i) { i.settings.engine = EngineChoice::Reference; });
    add([](MeasureInput& i) { i.settings.saliency.sigma = 3; });
    add([](MeasureInput& i) { i.settings.saliency.background = {1, 1, 1}; });
    add([](MeasureInput& i) { i.settings.vws = {0.2, 0.8}; });
    add([](MeasureInput& i) { i.volume = std::make_shared<const Volume>(i.volume->withRange({20, 180})); });
    all.push_back(measureInput(sceneOf("sample:disks", "tents:2")));
    return all;
}

MeasureInput inputOf(std::shared_ptr<const Volume> volume, const TransferFunction& tf) {
    return {std::move(volume), tf, {}, {}, {}};
}

} // namespace

TEST_CASE("the same input has the same figures whatever was computed before", "[session][workspace]") {
    const std::vector<MeasureInput> inputs = variations();
    std::vector<Measures> expected;
    for (const MeasureInput& input : inputs) expected.push_back(fresh(input));
    CHECK_FALSE(same(expected[0], expected[1]));
    Workspace workspace;
    // Each after each other one, and after itself.
    for (std::size_t before = 0; before < inputs.size(); before += 2)
        for (std::size_t now = 0; now < inputs.size(); ++now) {
            INFO(now << " after " << before);
            workspace.measure(inputs[before]);
            CHECK(same(workspace.measure(inputs[now]), expected[now]));
        }
}

TEST_CASE("derivatives and searches do not depend on it either", "[session][workspace]") {
    const std::vector<MeasureInput> inputs = variations();
    Workspace used, unused;
    for (const std::size_t before : {4u, 5u, 8u}) used.measure(inputs[before]);
    CHECK(used.jacobian(inputs[0]) == unused.jacobian(inputs[0]));
    OptimizeOptions options;
    options.maxIterations = 2;
    Workspace another;
    const OptimizeResult a = used.optimize(inputs[1], {1, 2, 3}, {}, options);
    const OptimizeResult b = another.optimize(inputs[1], {1, 2, 3}, {}, options);
    CHECK(a.history == b.history);
    CHECK(a.iterations() <= 2);
    // And as without a workspace at all.
    const auto engine = makeCpuEngine(inputs[1].volume);
    const WeightFields weights = saliencyFields(*inputs[1].volume, inputs[1].tf);
    const EngineVws function(*engine, inputs[1].view, inputs[1].tf, weights);
    const RayBundle rays(*inputs[1].volume, inputs[1].tf, inputs[1].view, kCoverageRays);
    OptimizeProblem problem{function, {1, 2, 3}};
    problem.estimates = rayEstimates(
        std::make_shared<RaySamples>(*inputs[1].volume, inputs[1].tf, inputs[1].view, weights), inputs[1].tf);
    problem.rays = &rays;
    CHECK(a.history == optimize(problem, options).history);
}

TEST_CASE("what rays have met is of the input at hand", "[session][workspace]") {
    // Opacities keep them; another feature, colour, view, saliency, volume does not.
    const std::vector<MeasureInput> inputs = variations();
    OptimizeOptions options;
    options.maxIterations = 1;
    const auto historyOf = [&](Workspace& workspace, const MeasureInput& input) {
        return workspace.optimize(input, std::vector<double>(input.tf.features.size(), 1.0), {}, options).history;
    };
    Workspace used;
    for (const MeasureInput& input : inputs) {
        Workspace unused;
        CHECK(historyOf(used, input) == historyOf(unused, input));
        CHECK(historyOf(used, inputs[0]) == historyOf(unused, inputs[0]));
    }
}

TEST_CASE("figures of a move are called estimates where they are", "[session][workspace]") {
    MeasureInput input = measureInput(sceneOf("sample:shells", "tents:3:0.1", 72)); // large enough to save time
    Workspace workspace;
    CHECK(workspace.approach(input, {1, 2, 3}, {}, {}, true).estimated);
    CHECK_FALSE(workspace.approach(input, {1, 2, 3}, {}, {}, false).estimated);
    Camera near = input.view.camera; // no bundle from there holds the volume
    near.eye = input.volume->geometry().boxCenter() + Vec3(0, -0.9 * input.volume->geometry().radius(), 0);
    input.view = near;
    CHECK_FALSE(workspace.approach(input, {1, 2, 3}, {}, {}, true).estimated);
}

TEST_CASE("saliency is computed once for colours, however opaque they are", "[session][workspace]") {
    const std::vector<MeasureInput> inputs = variations();
    Workspace workspace;
    workspace.measure(inputs[0]);
    CHECK(workspace.seconds().saliency > 0);
    workspace.measure(inputs[1]); // other opacities
    CHECK(workspace.seconds().saliency == 0);
    workspace.measure(inputs[5]); // another camera
    CHECK(workspace.seconds().saliency == 0);
    workspace.measure(inputs[3]); // another colour
    CHECK(workspace.seconds().saliency > 0);
}

TEST_CASE("progress goes from the beginning to the end once", "[session][workspace]") {
    const MeasureInput input = variations()[0];
    std::mutex mutex;
    std::vector<double> reports;
    JobControl job;
    job.progress = [&](double fraction) {
        const std::lock_guard lock(mutex);
        reports.push_back(fraction);
    };
    Workspace workspace;
    workspace.measure(input, job);
    REQUIRE_FALSE(reports.empty());
    CHECK(*std::max_element(reports.begin(), reports.end()) == Approx(1));
    // Threads report in any order, but the saliency is the first half and the sweep the second.
    const auto firstAbove = std::find_if(reports.begin(), reports.end(), [](double f) { return f > 0.5 + 1e-9; });
    CHECK(std::none_of(firstAbove, reports.end(), [](double f) { return f < 0.5 - 1e-9; }));
}

TEST_CASE("an engine that has failed is not kept", "[session][workspace]") {
    const MeasureInput good = variations()[0];
    MeasureInput inside = good;
    inside.view.camera.projection = Projection::Perspective;
    inside.view.camera.eye = good.volume->geometry().boxCenter() + Vec3(0.5, 0, 0);
    const auto holders = [&, alone = good.volume.use_count()] { return good.volume.use_count() - alone; };
    Workspace workspace;
    workspace.measure(good);
    CHECK(holders() > 1); // the engine and the saliency
    CHECK_THROWS_AS(workspace.measure(inside), Error);
    CHECK(holders() == 1);
    CHECK(same(workspace.measure(good), fresh(good)));
    // One that was stopped has not failed.
    std::stop_source stop;
    stop.request_stop();
    JobControl job;
    job.stop = stop.get_token();
    CHECK_THROWS_AS(workspace.measure(good, job), Cancelled);
    CHECK(holders() > 1);
    workspace.releaseEngine();
    CHECK(holders() == 1);
    CHECK(same(workspace.measure(good), fresh(good)));
}

TEST_CASE("saliency is computed again for colours and features, never for opacities", "[session][workspace]") {
    std::vector<std::uint8_t> samples;
    for (int i = 0; i < 12 * 12 * 12; ++i) samples.push_back(static_cast<std::uint8_t>(i * 37 % 256));
    const auto volume =
        std::make_shared<const Volume>(Geometry{{12, 12, 12}, Vec3(1), Vec3(0)}, Samples(std::move(samples)));
    const TransferFunction tf = tents(3);
    Workspace cache;
    const WeightFields first = cache.weights(inputOf(volume, tf), {});
    CHECK(first == saliencyFields(*volume, tf));

    // A computation would hear that it should stop.
    std::stop_source stop;
    stop.request_stop();
    const JobControl stopped{stop.get_token(), {}};
    CHECK(cache.weights(inputOf(volume, withFeatureOpacities(tf, {0.1, 0.9, 0.0})), stopped) == first);
    TransferFunction renamed = tf;
    renamed.features[1].name = "other";
    CHECK(cache.weights(inputOf(volume, renamed), stopped) == first);

    TransferFunction moved = tf;
    moved.features[1].a += 0.01;
    TransferFunction recoloured = tf;
    for (ControlPoint& p : recoloured.points) p.color = {0.3, 0.5, 0.7};
    for (const TransferFunction& other : {moved, recoloured}) {
        CHECK_THROWS_AS(cache.weights(inputOf(volume, other), stopped), Cancelled);
        CHECK(cache.weights(inputOf(volume, other), {}) == saliencyFields(*volume, other));
    }
    // A stopped one leaves nothing behind that would be taken for finished.
    CHECK_THROWS_AS(cache.weights(inputOf(volume, tf), stopped), Cancelled);
    CHECK_THROWS_AS(cache.weights(inputOf(volume, tf), stopped), Cancelled);
    CHECK(cache.weights(inputOf(volume, tf), {}) == first);
    // The same samples in another volume.
    const auto other = std::make_shared<const Volume>(*volume);
    CHECK_THROWS_AS(cache.weights(inputOf(other, tf), stopped), Cancelled);
}

TEST_CASE("the knee's attention can be shared equally, and the picture stays as strong", "[session][workspace]") {
    // Copies of it mislead: at an eighth of the voxels the same opacities have an F of 0.1 to 0.3.
    const Scene scene = sceneOf("sample:knee", kAutomaticTf, 0);
    MeasureInput input = measureInput(scene);
    const std::vector<double> equal(input.tf.features.size(), 1);
    Workspace workspace;
    for (const bool home : {true, false}) {
        if (!home) input.view = cameraFromView(input.volume->geometry(), 120, 30, 1, Projection::Perspective);
        const double before = workspace.coverage(input).coverage;
        const OptimizeResult result = workspace.optimize(input, equal, {}, {});
        INFO("from home " << home << ", coverage " << before);
        CHECK(result.history[result.best].objective < 0.001);
        REQUIRE(result.seen);
        CHECK(result.seen->coverage.coverage == Approx(std::clamp(before, 0.2, 0.7)).epsilon(0.15));
        CHECK(result.seen->unseen.empty());
        // And from its answer to other shares: never farther than where that begins.
        MeasureInput again = input;
        again.tf = result.tf;
        std::vector<double> rising;
        for (std::size_t f = 0; f < equal.size(); ++f) rising.push_back(static_cast<double>(f + 1));
        const OptimizeResult other = workspace.optimize(again, rising, {}, {});
        CHECK(other.history[other.best].objective <= other.history.front().objective);
        CHECK(other.history[other.best].objective < 0.001);
    }
}

TEST_CASE("a verdict never names what an earlier run has bettered", "[session][workspace]") {
    const MeasureInput input = measureInput(sceneOf("sample:shells", "tents:3"));
    const std::vector<double> targets{1.0 / 6, 2.0 / 6, 3.0 / 6};
    Workspace workspace;
    OptimizeOptions exact;
    exact.exactShares = true; // these shares take a faint picture
    const OptimizeResult good = workspace.optimize(input, targets, {}, exact);
    REQUIRE(good.converged());
    Run run = runOf(good, {});
    const auto known = knownAnswers({run}, good.targets);
    REQUIRE(known.size() == 1);
    CHECK(known[0] == good.history[good.best].opacity);
    CHECK(knownAnswers({run}, {0.5, 0.25, 0.25}).empty()); // of other targets
    // A search that came nowhere, and no moves to look for more.
    OptimizeOptions options;
    options.maxIterations = 1;
    options.restarts = false;
    OptimizeResult poor = good;
    poor.history = {good.history.front()};
    poor.best = 0;
    poor.seen.reset();
    poor.reason = StopReason::NoProgress;
    const Verdict verdict = workspace.explain(input, targets, std::vector<OpacityLimits>(3), options, poor, {}, known);
    CHECK(verdict.objective <= good.history[good.best].objective);
}

TEST_CASE("a search that was stopped says nothing of what can be reached", "[session][workspace]") {
    const MeasureInput input = measureInput(sceneOf("sample:shells", "tents:3"));
    const std::vector<double> targets{1.0 / 6, 2.0 / 6, 3.0 / 6};
    OptimizeOptions options;
    options.method = SearchMethod::Fixed;
    options.maxIterations = 1;
    Workspace workspace;
    // A base step of 0.05 along 2(W − t) moves no opacity by more than 0.1: far from where f1 does not hide the others.
    const OptimizeResult found = workspace.optimize(input, targets, {}, options);
    REQUIRE(found.history[found.best].objective > options.tolerance);
    const Verdict verdict = workspace.explain(input, targets, std::vector<OpacityLimits>(3), options, found);
    CHECK(verdict.objective < options.tolerance); // shells are in sight, salient and free: any shares can be had
    CHECK(verdict.limits.empty());
    CHECK(verdict.helps.empty());
    REQUIRE(verdict.sentences.size() == 1);
    CHECK(verdict.sentences[0].starts_with("Within reach: "));
    std::vector<double> vws;
    const MeasureInput there{
        input.volume, withFeatureOpacities(input.tf, verdict.opacity), input.view, input.settings, {}};
    for (const FeatureMeasures& f : workspace.measure(there).features) vws.push_back(f.vws);
    CHECK(objectiveOf(vws, targets) == Approx(verdict.objective).margin(1e-4));
}
