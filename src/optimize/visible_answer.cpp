#include "optimize/visible_answer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "optimize/log_depths.h"

namespace pellucid {

namespace {

constexpr double kRidge = 1e-6;
constexpr double kSolid = 0.99; // an opacity that more is not to be had of

/// Shares as whole hundredths that sum to 1, thousandths where a wanted one is smaller: the largest remainders are
/// rounded up; what is wanted keeps one.
std::vector<double> rounded(const std::vector<double>& shares, const std::vector<double>& targets) {
    int whole = 100;
    for (std::size_t f = 0; f < shares.size(); ++f)
        if (targets[f] > 0 && shares[f] < 0.01) whole = 1000;
    std::vector<int> parts;
    for (std::size_t f = 0; f < shares.size(); ++f)
        parts.push_back(std::max(targets[f] > 0 ? 1 : 0, static_cast<int>(whole * shares[f])));
    std::vector<std::size_t> order(shares.size());
    std::iota(order.begin(), order.end(), 0);
    int left = whole - std::accumulate(parts.begin(), parts.end(), 0);
    while (left != 0) {
        const auto lacks = [&](std::size_t f) { return whole * shares[f] - parts[f]; };
        const auto [least, most] = std::minmax_element(
            order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return lacks(a) < lacks(b); });
        const int step = left > 0 ? 1 : -1;
        parts[left > 0 ? *most : *least] += step;
        left -= step;
    }
    std::vector<double> round;
    for (const int p : parts) round.push_back(static_cast<double>(p) / whole);
    return round;
}

struct Bounds {
    Numbers lowest, highest;
};
Bounds stepBounds(const LogDepths& depths, const Numbers& y, double reach) {
    Bounds bounds;
    for (std::size_t i = 0; i < y.size(); ++i) {
        bounds.lowest.push_back(std::max(-reach, depths.lowest()[i] - y[i]));
        bounds.highest.push_back(std::min(reach, depths.highest()[i] - y[i]));
    }
    return bounds;
}

} // namespace

std::optional<Faintness> faintnessOf(const Coverage& seen, const std::vector<double>& targets,
                                     const std::vector<double>& opacity, const std::vector<OpacityLimits>& limits) {
    Faintness faint;
    faint.picture = seen.coverage < kFaintCoverage;
    for (std::size_t f = 0; f < targets.size(); ++f) {
        const OpacityLimits limit = limits.empty() ? OpacityLimits{} : limits[f];
        if (targets[f] > 0 && opacity[f] > 0 && seen.covers[f] < kFaintCover)
            faint.features.push_back(f);
        else if (limit.locked || opacity[f] >= kSolid * limit.highest)
            faint.limiting.push_back(f);
    }
    if (!faint.picture && faint.features.empty()) return {};
    return faint;
}

std::optional<Faintness::Remedy> visibleShares(const DensityProblem& problem, const std::vector<double>& targets,
                                               const std::vector<double>& opacity, const Faintness& faint,
                                               const JobControl& job) {
    const VwsFunction& along = problem.coarse ? *problem.coarse : problem.full;
    const LogDepths depths(problem.limits, opacity);
    if (depths.count() == 0 || problem.rays.rays() == 0) return {};
    Numbers y = depths.start();
    const auto coveragesAt = [&](const std::vector<Numbers>& places) {
        std::vector<TransferFunction> tfs;
        for (const Numbers& p : places) tfs.push_back(withFeatureOpacities(problem.full.base(), depths.opacity(p)));
        return coverageOf(problem.rays, tfs);
    };
    /// ln of what is wanted over what there is: of the picture, then of each faint feature.
    const auto lacks = [&](const Coverage& c) {
        Numbers lacking{std::log(kVisibleCoverage / std::max(c.coverage, 1e-6))};
        for (const std::size_t f : faint.features)
            lacking.push_back(std::log(kVisibleCover / std::max(c.covers[f], 1e-6)));
        return lacking;
    };

    // Least squares of the distance from the targets, and of what is lacking, which weighs more and more.
    constexpr double kDelta = 0.02, kReach = 0.7;
    constexpr int kSteps = 3;
    Rows derivative;
    for (const double weight : {0.03, 0.1, 0.3, 1.0})
        for (int n = 0; n < kSteps; ++n) {
            job.throwIfStopped();
            const VwsFunction::Linear linear = along.jacobian(depths.opacity(y), {job.stop, {}});
            derivative = depths.derivatives(linear.derivative, y);
            std::vector<Numbers> places{y};
            for (std::size_t i = 0; i < y.size(); ++i) {
                places.push_back(y);
                places.back()[i] += kDelta;
            }
            const std::vector<Coverage> coverages = coveragesAt(places);
            const Numbers lacking = lacks(coverages[0]);
            Rows rows = derivative;
            Numbers residual = plus(linear.vws, -1, targets);
            for (std::size_t k = 0; k < lacking.size(); ++k) {
                if (lacking[k] <= 0) continue;
                residual.push_back(-weight * lacking[k]);
                Numbers& row = rows.emplace_back();
                for (std::size_t i = 0; i < y.size(); ++i)
                    row.push_back(-weight * (lacks(coverages[i + 1])[k] - lacking[k]) / kDelta);
            }
            const Bounds bounds = stepBounds(depths, y, kReach);
            const Numbers step = leastSquaresStep(rows, residual, bounds.lowest, bounds.highest, kRidge);
            y = depths.clamped(plus(y, 1, step));
            if (largestOf(step) < 1e-3) break;
        }

    // The volume itself has the last word: shares in round numbers, met there.
    Faintness::Remedy remedy;
    for (int round = 0; round < 4; ++round) {
        job.throwIfStopped();
        remedy.opacity = depths.opacity(y);
        remedy.vws = problem.full.evaluate(std::vector<std::vector<double>>{remedy.opacity}, {job.stop, {}})[0];
        if (remedy.shares.empty()) remedy.shares = rounded(remedy.vws, targets);
        if (objectiveOf(remedy.vws, remedy.shares) < 1e-3) break;
        const Bounds bounds = stepBounds(depths, y, kReach);
        const Numbers step =
            leastSquaresStep(derivative, plus(remedy.vws, -1, remedy.shares), bounds.lowest, bounds.highest, kRidge);
        if (round < 3) y = depths.clamped(plus(y, 1, step));
    }
    for (std::size_t f = 0; f < targets.size(); ++f)
        if (std::abs(remedy.vws[f] - remedy.shares[f]) > 0.01) return {};
    remedy.coverage = coverageOf(problem.rays, withFeatureOpacities(problem.full.base(), remedy.opacity));
    for (const double lacking : lacks(remedy.coverage))
        if (lacking > 0.2) return {};
    return remedy;
}

void makeVisible(OptimizeResult& result, const DensityProblem& problem, const OptimizeOptions& options,
                 const JobControl& job, const std::function<void(const OptimizeState&)>& watch) {
    if (result.reason == StopReason::Cancelled || result.history.empty()) return;
    try {
        const TransferFunction& base = problem.full.base();
        OptimizeState best = result.history[result.best];
        Seen seen;
        seen.coverage = coverageOf(problem.rays, withFeatureOpacities(base, best.opacity));
        seen.strongest = seen.coverage.coverage;
        const bool moves = (options.method == SearchMethod::Newton || options.coverage) && options.maxIterations > 0;
        Coverage strongest = seen.coverage;
        std::vector<double> opacity = best.opacity;
        if (moves) {
            DensityAnswer answer = atDensity(problem, result.targets, best.opacity, options.coverage, job);
            result.evaluations += answer.evaluations;
            result.searched = result.history.size();
            if (answer.point.objective >= options.tolerance && best.objective < options.tolerance) {
                // What is on target stays so.
                answer.point = {best.opacity, best.vws, best.objective, seen.coverage};
                answer.history.push_back(best);
            }
            for (OptimizeState& state : answer.history) {
                result.history.push_back(std::move(state));
                if (watch) watch(result.history.back());
            }
            result.best = result.history.size() - 1;
            result.tf = withFeatureOpacities(base, answer.point.opacity);
            seen.coverage = strongest = answer.point.coverage;
            seen.strongest = answer.strongestCoverage;
            opacity = answer.point.opacity;
        }
        // What somebody has asked to be faint needs no words; what other methods leave so may be only that.
        if ((options.coverage || !moves) && faintnessOf(strongest, result.targets, opacity, problem.limits) &&
            options.maxIterations > 0) {
            const DensityAnswer answer = atDensity(problem, result.targets, opacity, {}, job);
            strongest = answer.point.coverage;
            opacity = answer.point.opacity;
            seen.strongest = std::max(seen.strongest, strongest.coverage);
        }
        seen.faint = faintnessOf(strongest, result.targets, opacity, problem.limits);
        if (seen.faint) {
            seen.faint->searched = options.maxIterations > 0;
            if (seen.faint->searched)
                seen.faint->remedy = visibleShares(problem, result.targets, opacity, *seen.faint, job);
        }
        result.seen = std::move(seen);
    } catch (const Cancelled&) {
        result.reason = StopReason::Cancelled;
    }
}

} // namespace pellucid
