#include "optimize/optimizer.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "optimize/newton.h"
#include "optimize/picture_goal.h"

namespace pellucid {

namespace {

constexpr int kSmallestParallelStep = -2, kLargestParallelStep = 5; ///< exponents of 2 of the parallel line search
constexpr int kHalvings = 5, kDoublings = 12;                       ///< of the sequential one
constexpr int kPatience = 12;                                       ///< moves of a search without a new best

/// Thesis 5.3.4 and 5.3.5: the search so far and what its moves need.
class Search {
public:
    Search(const VwsFunction& function, const std::vector<double>& targets, const std::vector<OpacityLimits>& limits,
           const OptimizeOptions& options, const JobControl& job)
        : m_function(function), m_targets(targets), m_limits(limits), m_options(options), m_job(job) {}

    std::vector<OptimizeState> evaluate(const std::vector<std::vector<double>>& candidates) {
        const auto vws = m_function.evaluate(candidates, m_job);
        m_evaluations += static_cast<int>(candidates.size());
        std::vector<OptimizeState> states;
        for (std::size_t i = 0; i < candidates.size(); ++i)
            states.push_back({objectiveOf(vws[i], m_targets), vws[i], candidates[i]});
        return states;
    }

    /// The state after one move from the last of `history`. The direction need not be the gradient (method 1 replaces
    /// ∂W/∂x by b), so that at times no step along it helps: then the search goes on from the best of them, worse than
    /// where it was.
    OptimizeState move(const std::vector<OptimizeState>& history) {
        const OptimizeState& at = history.back();
        const std::vector<double> d = direction(at, history.size() > 1 ? &history[history.size() - 2] : nullptr);
        switch (m_options.method) {
        case SearchMethod::Fixed:
            return fixedStep(at, d);
        case SearchMethod::Line:
            return lineSearch(at, d);
        case SearchMethod::Parallel:
            return parallelLineSearch(at, d);
        case SearchMethod::Newton:
            break;
        }
        PELLUCID_CHECK(false);
        return at;
    }

    int evaluations() const { return m_evaluations; }

private:
    static double lengthOf(const std::vector<double>& d) {
        double square = 0;
        for (const double v : d) square += v * v;
        return std::sqrt(square);
    }

    /// `before`: the state before `at`, null at the start.
    std::vector<double> direction(const OptimizeState& at, const OptimizeState* before) {
        constexpr double kLongest = 20; // of a secant: a base step of 0.05 along it moves an opacity by 1
        const std::size_t n = m_targets.size();
        std::vector<double> slope(n); // ∂F/∂W_i taken as 2(W − t)
        for (std::size_t i = 0; i < n; ++i) slope[i] = 2 * (at.vws[i] - m_targets[i]);
        std::vector<double> d(n, 0.0);
        if (m_options.direction == Direction::Exact) {
            const VwsFunction::Linear linear = m_function.jacobian(at.opacity, m_job);
            ++m_evaluations;
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = 0; j < n; ++j) d[j] += slope[i] * linear.derivative[i][j];
        } else {
            for (std::size_t i = 0; i < n; ++i) {
                d[i] = m_options.b * slope[i];
                if (m_options.direction == Direction::Gradient || before == nullptr) continue;
                const double dx = at.opacity[i] - before->opacity[i], dw = at.vws[i] - before->vws[i];
                if (dx == 0 || dw == 0) continue;
                // F'_i = slope_i, ∇F = F'_i·∇x_i and ∇F'_i = 2∇W_i; downhill also where F'' < 0.
                d[i] = m_options.direction == Direction::Backward
                           ? slope[i] * dw / dx
                           : std::clamp(slope[i] * std::abs(dx / (2 * dw)), -kLongest, kLongest);
            }
        }
        // Of derivatives the direction counts alone: steps are as long as those of method 1.
        const bool derivative = m_options.direction == Direction::Backward || m_options.direction == Direction::Exact;
        const double length = lengthOf(d);
        if ((m_options.normalize || derivative) && length > 0)
            for (double& v : d) v *= (m_options.normalize ? 1 : m_options.b * lengthOf(slope)) / length;
        return d;
    }

    std::vector<double> stepped(const OptimizeState& at, const std::vector<double>& d, double step) const {
        std::vector<double> x = at.opacity;
        for (std::size_t i = 0; i < x.size(); ++i)
            if (!m_limits[i].locked) x[i] -= step * d[i];
        return within(m_limits, std::move(x));
    }

    OptimizeState trial(const OptimizeState& at, const std::vector<double>& d, double step) {
        return evaluate({stepped(at, d, step)})[0];
    }

    /// Of equal ones the first; NaN never wins.
    static OptimizeState best(const std::vector<OptimizeState>& states) {
        return *std::ranges::min_element(states, [](const auto& a, const auto& b) {
            return a.objective < b.objective || (std::isnan(b.objective) && !std::isnan(a.objective));
        });
    }

    OptimizeState fixedStep(const OptimizeState& at, const std::vector<double>& d) {
        if (stepped(at, d, m_options.step) == at.opacity) return at;
        return trial(at, d, m_options.step);
    }

    /// Line: until one is no better than the one before. Parallel: all of them, the best, of equal ones the shorter.
    OptimizeState publishedSearch(const OptimizeState& at, const std::vector<double>& d) {
        constexpr int kSteps = 4;
        if (m_options.method == SearchMethod::Parallel) {
            std::vector<std::vector<double>> candidates;
            for (int i = 0; i < kSteps; ++i) candidates.push_back(stepped(at, d, m_options.step * std::exp2(i)));
            return best(evaluate(candidates));
        }
        OptimizeState best = trial(at, d, m_options.step);
        for (int i = 1; i < kSteps; ++i) {
            OptimizeState next = trial(at, d, m_options.step * std::exp2(i));
            if (!(next.objective < best.objective)) break;
            best = std::move(next);
        }
        return best;
    }

    OptimizeState lineSearch(const OptimizeState& at, const std::vector<double>& d) {
        if (m_options.publishedSteps) return publishedSearch(at, d);
        double step = m_options.step;
        OptimizeState best = trial(at, d, step);
        if (best.objective < at.objective) {
            for (int n = 0; n < kDoublings; ++n) {
                step *= 2;
                if (stepped(at, d, step) == best.opacity) break; // clamped at every end already
                OptimizeState next = trial(at, d, step);
                if (!(next.objective < best.objective)) break;
                best = std::move(next);
            }
            return best;
        }
        for (int n = 0; n < kHalvings; ++n) {
            step /= 2;
            best = trial(at, d, step);
            if (best.objective < at.objective) break;
        }
        return best;
    }

    OptimizeState parallelLineSearch(const OptimizeState& at, const std::vector<double>& d) {
        if (m_options.publishedSteps) return publishedSearch(at, d);
        constexpr int kCount = kLargestParallelStep - kSmallestParallelStep + 1;
        // Where the whole batch overshoots, the valley is narrower than its smallest step: one finer batch looks there.
        OptimizeState leastBad;
        for (const int shift : {0, -kCount}) {
            std::vector<std::vector<double>> candidates;
            for (int i = kSmallestParallelStep; i <= kLargestParallelStep; ++i)
                candidates.push_back(stepped(at, d, m_options.step * std::exp2(i + shift)));
            const OptimizeState found = best(evaluate(candidates));
            if (found.objective < at.objective) return found;
            if (shift == 0) leastBad = found;
        }
        return leastBad;
    }

    const VwsFunction& m_function;
    const std::vector<double>& m_targets;
    const std::vector<OpacityLimits>& m_limits;
    const OptimizeOptions& m_options;
    const JobControl& m_job;
    int m_evaluations = 0;
};

/// Moves until the targets are met or nothing helps any more.
StopReason descend(Search& search, const std::vector<OptimizeState>& history, const std::size_t& best,
                   const OptimizeOptions& options, const JobControl& job,
                   const std::function<void(OptimizeState)>& arrive) {
    for (;;) {
        const OptimizeState& at = history.back();
        if (at.objective < options.tolerance) return StopReason::Converged;
        if (static_cast<int>(history.size()) - 1 >= options.maxIterations) return StopReason::MaxIterations;
        job.throwIfStopped();
        OptimizeState next = search.move(history);
        const bool searches = options.method != SearchMethod::Fixed;
        const bool stalled = searches && history.size() - 1 - best >= kPatience;
        if (next.opacity == at.opacity || stalled) return StopReason::NoProgress;
        arrive(std::move(next));
    }
}

} // namespace

template <>
std::span<const Setting> settingsOf<OptimizeOptions>() {
    using O = OptimizeOptions;
    constexpr auto isNewton = [](const void* o) { return static_cast<const O*>(o)->method == SearchMethod::Newton; };
    constexpr auto isStepped = [](const void* o) { return static_cast<const O*>(o)->method != SearchMethod::Newton; };
    constexpr auto hasB = [](const void* o) {
        const O& options = *static_cast<const O*>(o);
        return options.method != SearchMethod::Newton && options.direction == Direction::Gradient;
    };
    static constexpr const char* kMethods[] = {"Fixed step", "Line search", "Parallel line search", "Newton"};
    static constexpr const char* kDirections[] = {"Toward the targets (method 1)", "Backward differences",
                                                  "Second order (method 2)", "Exact gradient"};
    static const Setting kSettings[] = {
        {.key = "method",
         .at = member<&O::method>,
         .words = "&Method",
         .help = "How opacities are searched: Newton uses exact derivatives, the other three are the thesis's.",
         .choices = kMethods},
        {.key = "direction",
         .at = member<&O::direction>,
         .words = "&Direction",
         .help = "Where the steps of the thesis's methods go: along 2b(W − t), with backward differences, by second "
                 "derivatives, or by exact derivatives.",
         .choices = kDirections,
         .used = isStepped},
        {.key = "step",
         .at = member<&O::step>,
         .words = "&Step",
         .help = "The length of a base step, in opacity per unit of the direction; searches try multiples of it.",
         .range = {0, 10, NumberRange::Open::Low},
         .used = isStepped},
        {.key = "b",
         .at = member<&O::b>,
         .words = "&b",
         .help = "The scalar b of method 1's direction.",
         .range = {0, 1e6, NumberRange::Open::Low},
         .used = hasB},
        {.key = "tolerance",
         .at = member<&O::tolerance>,
         .words = "&Tolerance",
         .help = "Targets count as reached when their root mean square distance F from the VWS is below this.",
         .range = {0, 1, NumberRange::Open::Low}},
        {.key = "max_iterations",
         .at = member<&O::maxIterations>,
         .words = "Most &moves",
         .help = "The largest number of moves on the volume.",
         .range = {0, 1e9},
         .unit = "moves"},
        {.key = "coverage",
         .at = member<&O::coverage>,
         .words = "Co&verage",
         .help = "The mean opacity of the picture over the pixels whose rays meet what is wanted: of the opacities "
                 "with the same shares, those that come nearest to it are taken. Without a number, Newton keeps the "
                 "coverage of the start, within 0.2 and 0.7, and the other methods leave it as it comes.",
         .range = {0, 1, NumberRange::Open::Low},
         .none = "auto"},
        {.key = "normalize",
         .at = member<&O::normalize>,
         .words = "&Normalize the direction",
         .help = "Scale the direction to length 1, as section 5.3.4 prints it.",
         .used = isStepped},
        {.key = "coarse",
         .at = member<&O::coarse>,
         .words = "&Rays first",
         .help = "Make Newton's first moves along a few thousand rays, and only the last ones on the whole volume.",
         .option = "no-coarse",
         .used = isNewton},
        {.key = "restarts",
         .at = member<&O::restarts>,
         .words = "Restar&ts",
         .help = "Let Newton try other starts, spread over all opacities, where it is stuck.",
         .option = "no-restarts",
         .used = isNewton},
        {.key = "exact_shares",
         .at = member<&O::exactShares>,
         .words = "E&xact shares",
         .help = "Meet the shares even where nothing can be seen of them. Otherwise the picture keeps a coverage of at "
                 "least 0.2, and each feature with a target above 0 a cover of at least 0.02: where the shares would "
                 "go below that, the nearest ones that do not are taken, and the exact ones are reported beside them."},
    };
    return kSettings;
}

std::vector<OpacityLimits> limitsOfMoves(const TransferFunction& base, std::vector<OpacityLimits> given) {
    const std::size_t n = base.features.size();
    if (given.empty()) given.resize(n);
    if (given.size() != n)
        throw UsageError(std::to_string(given.size()) + " limits for " + std::to_string(n) + " features", "limits",
                         "give one per feature");
    const std::vector<double> most = featureOpacities(withFullPeaks(base));
    for (std::size_t f = 0; f < n; ++f) {
        if (!(given[f].lowest >= 0 && given[f].lowest <= given[f].highest && given[f].highest <= 1))
            throw UsageError("the limits of '" + base.features[f].name + "' are not a range within 0 and 1", "limits",
                             "correct them");
        if (base.features[f].hidden || most[f] == 0) given[f].locked = true;
    }
    return given;
}

void OptimizeOptions::validate() const { checkSettings(*this, "optimize"); }

int OptimizeResult::laterSteps() const { return searched == 0 ? 0 : static_cast<int>(history.size() - searched); }

int OptimizeResult::iterations() const {
    const auto full =
        std::count_if(history.begin(), history.end() - laterSteps(), [](const auto& s) { return s.level == 0; });
    return std::max(0, static_cast<int>(full) - 1);
}

int OptimizeResult::coarseIterations() const {
    return static_cast<int>(
        std::count_if(history.begin(), history.end() - laterSteps(), [](const auto& s) { return s.level > 0; }));
}

namespace {

SeenShares sharesOf(const NewtonSearch::Place& place) {
    return {place.state.opacity, place.state.vws, place.state.objective, place.look};
}

} // namespace

OptimizeResult optimize(const OptimizeProblem& problem, const OptimizeOptions& options, const JobControl& job,
                        const std::function<void(const OptimizeState&)>& watch) {
    options.validate();
    const VwsFunction& function = problem.function;
    OptimizeResult result;
    result.tf = function.base();
    result.targets = normalizedTargets(problem.targets, function.featureCount());
    const std::vector<OpacityLimits> limits = limitsOfMoves(function.base(), problem.limits);
    const std::vector<double> start = within(limits, featureOpacities(function.base()));

    const bool isNewton = options.method == SearchMethod::Newton;
    bool looksAside = false;
    const auto arrive = [&](const OptimizeState& state) {
        result.history.push_back(state);
        if (state.level == 0 && state.objective < result.history[result.best].objective)
            result.best = result.history.size() - 1;
        if (looksAside) return;
        if (watch) watch(result.history.back());
        job.report(options.maxIterations == 0 ? 1.0 : static_cast<double>(result.iterations()) / options.maxIterations);
    };
    /// Becomes the answer.
    const auto take = [&](const NewtonSearch::Place& place) {
        std::size_t i = result.history.size();
        while (i > 0 && !(result.history[i - 1].level == 0 && result.history[i - 1].opacity == place.state.opacity))
            --i;
        if (i == 0) {
            // Where no more moves are allowed the answer takes the place of the last one, which was not as good.
            if (isNewton && result.iterations() >= std::max(1, options.maxIterations)) {
                const auto last = std::find_if(result.history.rbegin(), result.history.rend(),
                                               [](const OptimizeState& s) { return s.level == 0; });
                result.history.erase(std::next(last).base());
                result.best = 0;
            }
            arrive(place.state);
            i = result.history.size();
        }
        result.best = i - 1;
    };
    std::optional<PictureGoal> goal;
    if (problem.rays && problem.rays->rays() > 0)
        goal.emplace(*problem.rays, function.base(), result.targets, limits, start, options.coverage);
    // That profile looks along the grid and counts moves: its answers stay as they are.
    const bool moves = options.maxIterations > 0 && !options.publishedSteps;
    VwsEstimates estimates; // whom the levels belong to
    std::vector<const VwsFunction*> levels{&function};
    const auto addEstimates = [&] {
        if (!options.coarse || !moves || levels.size() > 1) return;
        estimates = problem.estimates.empty() && problem.makeEstimates ? problem.makeEstimates() : problem.estimates;
        for (const auto& estimate : estimates) levels.push_back(estimate.get());
    };
    Search search(function, result.targets, limits, options, job);
    NewtonSearch newton(levels, result.targets, limits, options, goal && moves ? &*goal : nullptr, job, arrive);
    try {
        NewtonSearch::Place nearest;
        if (isNewton && problem.nearby && goal && moves && !options.exactShares) {
            newton.follow(start);
            nearest = newton.visible();
        } else if (isNewton) {
            addEstimates();
            std::vector<std::vector<double>> starts{start};
            for (const auto& x : problem.known)
                if (x.size() == start.size()) starts.push_back(within(limits, x));
            newton.toShares(starts);
            nearest = newton.nearest();
        } else {
            arrive(search.evaluate({start})[0]);
            result.reason = descend(search, result.history, result.best, options, job, arrive);
            result.searched = result.history.size();
            nearest.state = result.history[result.best];
            if (goal && moves) {
                newton.look(nearest.state);
                if (options.coverage) {
                    addEstimates();
                    newton.toShares({nearest.state.opacity});
                }
                nearest = newton.nearest();
            }
        }
        take(nearest);
        if (problem.rays && !goal) { // no ray meets anything
            const std::size_t n = result.targets.size();
            result.seen = Seen{{0, std::vector<double>(n, 0.0)}, true, {}, {}, {}};
            for (std::size_t f = 0; f < n; ++f)
                if (result.targets[f] > 0) result.seen->unseen.push_back(f);
        }
        if (goal) result.seen = goal->seen(moves ? nearest.look : goal->looks({nearest.state.opacity})[0]);
        if (goal && moves && !problem.nearby && nearest.lack > kShownLack) {
            addEstimates();
            const std::size_t known = result.history.size();
            looksAside = options.exactShares; // what was not asked for is told, and is no part of the way
            if (looksAside) result.evaluations = search.evaluations() + newton.evaluations();
            newton.toFloors({nearest.state.opacity, start});
            const NewtonSearch::Place visible = newton.visible();
            if (visible.lack < nearest.lack - kShownLack) {
                if (options.exactShares) {
                    result.seen->visible = sharesOf(visible);
                } else {
                    take(visible);
                    result.seen = goal->seen(visible.look);
                    result.seen->exact = sharesOf(nearest);
                }
            }
            if (looksAside) {
                result.history.resize(known);
                looksAside = false;
            }
            if (!result.seen->exact) take(nearest);
        }
        const double objective = result.history[result.best].objective;
        const bool isKept = result.seen && result.seen->exact && result.seen->exact->objective < options.tolerance;
        if (objective < options.tolerance)
            result.reason = StopReason::Converged;
        else if (isKept)
            result.reason = StopReason::Visible;
        else if (isNewton)
            result.reason = newton.mayMove() ? StopReason::NoProgress : StopReason::MaxIterations;
        if (result.searched == result.history.size()) result.searched = 0;
    } catch (const Cancelled&) {
        result.reason = StopReason::Cancelled;
    }
    if (result.evaluations == 0) result.evaluations = search.evaluations() + newton.evaluations();
    result.spreadStarts = newton.spreadStarts();
    if (!result.history.empty()) result.tf = withFeatureOpacities(function.base(), result.history[result.best].opacity);
    return result;
}

} // namespace pellucid
