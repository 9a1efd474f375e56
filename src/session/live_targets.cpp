#include "session/live_targets.h"

namespace pellucid {

namespace {

constexpr int kMovesAtOnce = 1;  ///< of an update while things move
constexpr int kMovesAtRest = 12; ///< enough from nearby

LiveUpdate update(Workspace& workspace, const HeldTargets& held, int moves, bool rough, const JobControl& job) {
    OptimizeOptions options = held.options;
    options.method = SearchMethod::Newton; // from nearby it arrives in a move or two
    options.coverage.reset();
    options.coarse = false;
    options.restarts = !rough; // where the hand rests there is time for them
    options.maxIterations = moves;
    const auto [result, estimated] = workspace.approach(held.input, held.targets, held.limits, options, rough, job);
    if (result.reason == StopReason::Cancelled) throw Cancelled{};
    const OptimizeState& best = result.history[result.best];
    return {best.opacity, best.vws, best.objective, estimated};
}

} // namespace

LiveUpdate followTargets(Workspace& workspace, const HeldTargets& held, const JobControl& job) {
    return update(workspace, held, kMovesAtOnce, true, job);
}

LiveUpdate settleTargets(Workspace& workspace, const HeldTargets& held, const JobControl& job) {
    return update(workspace, held, kMovesAtRest, false, job);
}

} // namespace pellucid
