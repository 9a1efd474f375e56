// Targets that are held while the view turns.
#include <catch2/catch.hpp>

#include <cmath>

#include "base/error.h"
#include "render/camera_motion.h"
#include "session/live_targets.h"

using namespace pellucid;

namespace {

HeldTargets heldOf(const std::vector<double>& targets, bool exactShares = true) {
    SceneInputs in;
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 24;
    in.session = sessionOf(source);
    in.tf = "tents:3:0.1";
    in.session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    OptimizeOptions options;
    options.exactShares = exactShares;
    return {measureInput(openScene(in)), targets, {}, options};
}

double distance(const LiveUpdate& update, const std::vector<double>& targets) {
    return objectiveOf(update.vws, targets);
}

void put(HeldTargets& held, const LiveUpdate& update) {
    held.input.tf = withFeatureOpacities(held.input.tf, update.opacity);
}

void turn(HeldTargets& held, double degrees) {
    held.input.view.camera = rotated(held.input.view.camera, held.input.volume->geometry(), degrees, degrees / 3);
}

} // namespace

TEST_CASE("targets are held while the view turns", "[session][live]") {
    Workspace workspace;
    HeldTargets held = heldOf({0.2, 0.2, 0.6});
    put(held, settleTargets(workspace, held));
    for (int i = 0; i < 12; ++i) { // a half turn
        turn(held, 15);
        const double before = objectiveOf(
            [&] {
                std::vector<double> vws;
                for (const FeatureMeasures& f : workspace.measure(held.input).features) vws.push_back(f.vws);
                return vws;
            }(),
            held.targets);
        const LiveUpdate update = followTargets(workspace, held);
        CHECK(update.objective <= before + 1e-9);
        CHECK(update.objective == Approx(distance(update, held.targets)));
        CHECK(update.objective < 0.03);
        put(held, update);
    }
    const LiveUpdate rest = settleTargets(workspace, held);
    put(held, rest);
    // What it says of the last view is what is measured there.
    const Measures measured = workspace.measure(held.input);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(measured.features[i].vws == Approx(rest.vws[i]).margin(1e-6));
        CHECK(std::abs(measured.features[i].vws - held.targets[i]) < 0.01);
    }
}

TEST_CASE("the picture does not vanish while targets are held", "[session][live]") {
    // 0.6 for the core takes a picture that is 12 % opaque at most.
    Workspace workspace;
    HeldTargets held = heldOf({0.2, 0.2, 0.6}, false);
    put(held, settleTargets(workspace, held));
    CHECK(workspace.coverage(held.input).coverage > 0.19);
    for (int i = 0; i < 4; ++i) {
        turn(held, 15);
        put(held, followTargets(workspace, held));
        CHECK(workspace.coverage(held.input).coverage > 0.15); // a move at a time
    }
    put(held, settleTargets(workspace, held));
    CHECK(workspace.coverage(held.input).coverage > 0.19);
}

TEST_CASE("an opacity that is locked stays while targets are held", "[session][live]") {
    Workspace workspace;
    HeldTargets held = heldOf({0.2, 0.2, 0.6});
    held.limits.assign(3, {});
    held.limits[1].locked = true;
    const double opacity = featureOpacities(held.input.tf)[1];
    for (int i = 0; i < 3; ++i) {
        turn(held, 20);
        const LiveUpdate update = followTargets(workspace, held);
        CHECK(update.opacity[1] == opacity);
        put(held, update);
    }
}

TEST_CASE("holding targets stops where it is asked to", "[session][live]") {
    Workspace workspace;
    const HeldTargets held = heldOf({0.2, 0.2, 0.6});
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(followTargets(workspace, held, {stop.get_token(), {}}), Cancelled);
}

TEST_CASE("an opacity that somebody sets is told from those that an update wants", "[session][live]") {
    TransferFunction before = tents(3, 0.2);
    for (std::size_t i = 0; i < 3; ++i) before.features[i].id = static_cast<FeatureId>(i + 1);
    const TransferFunction after = withFeatureOpacities(before, {0.2, 0.5, 0.4});
    CHECK(sameFeatures(before, after));
    CHECK(setByHand(before, after, {}) == std::set<FeatureId>{2, 3});
    CHECK(setByHand(before, after, {{3, 0.4}}) == std::set<FeatureId>{2});               // the update came between
    CHECK(setByHand(before, withFeatureOpacities(before, {0.1, 0.1, 0.1}), {}).empty()); // another density
    TransferFunction fewer = before;
    fewer.features.pop_back();
    CHECK_FALSE(sameFeatures(before, fewer));
}
