#include "session/live_targets.h"

#include <algorithm>
#include <cmath>

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

bool sameFeatures(const TransferFunction& a, const TransferFunction& b) {
    return std::equal(a.features.begin(), a.features.end(), b.features.begin(), b.features.end(),
                      [](const Feature& f, const Feature& g) { return f.id == g.id; });
}

std::set<FeatureId> setByHand(const TransferFunction& before, const TransferFunction& after,
                              const std::map<FeatureId, double>& wanted) {
    const std::vector<double> was = featureOpacities(before), is = featureOpacities(after);
    std::set<FeatureId> set;
    for (std::size_t i = 0; i < is.size(); ++i) {
        const FeatureId id = after.features[i].id;
        const auto update = wanted.find(id);
        if (was[i] != is[i] && (update == wanted.end() || std::abs(update->second - is[i]) > 1e-9)) set.insert(id);
    }
    if (set.size() == is.size()) set.clear();
    return set;
}

} // namespace pellucid
