#include "session/live_targets.h"

#include <algorithm>

namespace pellucid {

namespace {

constexpr int kMovesAtOnce = 1;  ///< of an update while things move
constexpr int kMovesAtRest = 12; ///< enough from nearby

LiveUpdate update(Workspace& workspace, const HeldTargets& held, int moves, bool coarse, const JobControl& job) {
    OptimizeOptions options = held.options;
    options.method = SearchMethod::Newton; // from nearby it arrives in a move or two
    options.coverage.reset();
    options.coarse = false;
    options.restarts = !coarse; // where the hand rests there is time for them
    options.tolerance = std::min(options.tolerance, kLiveGoal);
    options.maxIterations = moves;
    const OptimizeResult result = workspace.approach(held.input, held.targets, held.limits, options, coarse, job);
    if (result.reason == StopReason::Cancelled) throw Cancelled{};
    const OptimizeState& best = result.history[result.best];
    const bool approximate =
        coarse && held.input.volume->size() > CoarserVolumes::kQuick && held.input.settings.profile == Profile::Default;
    return {best.opacity, best.vws, best.objective, approximate};
}

} // namespace

LiveUpdate followTargets(Workspace& workspace, const HeldTargets& held, const JobControl& job) {
    return update(workspace, held, kMovesAtOnce, true, job);
}

LiveUpdate settleTargets(Workspace& workspace, const HeldTargets& held, const JobControl& job) {
    return update(workspace, held, kMovesAtRest, false, job);
}

} // namespace pellucid
