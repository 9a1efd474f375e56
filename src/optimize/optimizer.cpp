#include "optimize/optimizer.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pellucid {

namespace {

constexpr int kSmallestParallelStep = -2, kLargestParallelStep = 5; ///< exponents of 2 of the parallel line search
constexpr int kHalvings = 5, kDoublings = 12;                       ///< of the sequential one
constexpr int kPatience = 12;                                       ///< moves of a search without a new best

/// The search so far and what its moves need.
class Search {
public:
    Search(const VwsFunction& function, const std::vector<double>& targets, const OptimizeOptions& options,
           const JobControl& job)
        : m_function(function), m_targets(targets), m_options(options), m_job(job) {}

    std::vector<OptimizeState> evaluate(const std::vector<std::vector<double>>& candidates) {
        const auto vws = m_function.evaluate(candidates, m_job);
        m_evaluations += static_cast<int>(candidates.size());
        std::vector<OptimizeState> states;
        for (std::size_t i = 0; i < candidates.size(); ++i)
            states.push_back({objectiveOf(vws[i], m_targets), vws[i], candidates[i]});
        return states;
    }

    /// The state after one move from `at`. The direction is not the gradient (∂W/∂x is replaced by 1), so that at times
    /// no step along it helps: then the search goes on from the best of them, worse than `at`.
    OptimizeState move(const OptimizeState& at) {
        const std::vector<double> d = direction(at);
        switch (m_options.method) {
        case SearchMethod::Fixed:
            return fixedStep(at, d);
        case SearchMethod::Line:
            return lineSearch(at, d);
        case SearchMethod::Parallel:
        case SearchMethod::Newton:
            return parallelLineSearch(at, d);
        }
        return at;
    }

    int evaluations() const { return m_evaluations; }

private:
    /// Method 1: ∂F/∂W_i taken as 2(W − t), with ∂W_i/∂x_i replaced by 1.
    std::vector<double> direction(const OptimizeState& at) const {
        std::vector<double> d(m_targets.size());
        double square = 0;
        for (std::size_t i = 0; i < d.size(); ++i) {
            d[i] = 2 * (at.vws[i] - m_targets[i]);
            square += d[i] * d[i];
        }
        if (m_options.normalize && square > 0)
            for (double& v : d) v /= std::sqrt(square);
        return d;
    }

    static std::vector<double> stepped(const OptimizeState& at, const std::vector<double>& d, double step) {
        std::vector<double> x = at.opacity;
        for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::clamp(x[i] - step * d[i], 0.0, 1.0);
        return x;
    }

    OptimizeState trial(const OptimizeState& at, const std::vector<double>& d, double step) {
        return evaluate({stepped(at, d, step)})[0];
    }

    OptimizeState fixedStep(const OptimizeState& at, const std::vector<double>& d) {
        if (stepped(at, d, m_options.step) == at.opacity) return at;
        return trial(at, d, m_options.step);
    }

    OptimizeState lineSearch(const OptimizeState& at, const std::vector<double>& d) {
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
        constexpr int kCount = kLargestParallelStep - kSmallestParallelStep + 1;
        // Where the whole batch overshoots, the valley is narrower than its smallest step: one finer batch looks there.
        OptimizeState leastBad;
        for (const int shift : {0, -kCount}) {
            std::vector<std::vector<double>> candidates;
            for (int i = kSmallestParallelStep; i <= kLargestParallelStep; ++i)
                candidates.push_back(stepped(at, d, m_options.step * std::exp2(i + shift)));
            const auto states = evaluate(candidates);
            // Of equal ones the shorter step: min_element keeps the first. A NaN never wins.
            const auto better = [](const auto& a, const auto& b) {
                return a.objective < b.objective || (std::isnan(b.objective) && !std::isnan(a.objective));
            };
            const auto best = std::min_element(states.begin(), states.end(), better);
            if (best->objective < at.objective) return *best;
            if (shift == 0) leastBad = *best;
        }
        return leastBad;
    }

    const VwsFunction& m_function;
    const std::vector<double>& m_targets;
    const OptimizeOptions& m_options;
    const JobControl& m_job;
    int m_evaluations = 0;
};

} // namespace

const char* name(SearchMethod method) {
    switch (method) {
    case SearchMethod::Fixed:
        return "fixed";
    case SearchMethod::Line:
        return "line";
    case SearchMethod::Parallel:
        return "parallel";
    case SearchMethod::Newton:
        return "newton";
    }
    return "";
}

SearchMethod searchMethodFromName(const std::string& text) {
    for (const SearchMethod m : {SearchMethod::Fixed, SearchMethod::Line, SearchMethod::Parallel, SearchMethod::Newton})
        if (text == name(m)) return m;
    throw UsageError("there is no search method '" + text + "'", "search method",
                     "choose newton, parallel, line or fixed");
}

const char* name(Direction direction) {
    switch (direction) {
    case Direction::Gradient:
        return "gradient";
    case Direction::Backward:
        return "backward";
    case Direction::Second:
        return "second";
    case Direction::Exact:
        return "exact";
    }
    return "";
}

Direction directionFromName(const std::string& text) {
    for (const Direction d : {Direction::Gradient, Direction::Backward, Direction::Second, Direction::Exact})
        if (text == name(d)) return d;
    throw UsageError("there is no direction '" + text + "'", "direction", "choose gradient, backward, second or exact");
}

const char* name(StopReason reason) {
    switch (reason) {
    case StopReason::Converged:
        return "converged";
    case StopReason::MaxIterations:
        return "max-iterations";
    case StopReason::NoProgress:
        return "no-progress";
    case StopReason::Cancelled:
        return "cancelled";
    }
    return "";
}

void OptimizeOptions::validate() const {
    if (!(step > 0 && step <= 10)) throw UsageError("the step lies in (0,10]", "optimize", "correct the step");
    if (!(tolerance > 0) || !std::isfinite(tolerance))
        throw UsageError("the tolerance is positive", "optimize", "correct the tolerance");
    if (!(b > 0 && b <= 1e6)) throw UsageError("b lies in (0,1e6]", "optimize", "correct it");
    if (coverage && !(*coverage > 0 && *coverage <= 1))
        throw UsageError("the coverage lies in (0,1]", "optimize", "correct it");
    if (maxIterations < 0) throw UsageError("the number of iterations is not negative", "optimize", "correct it");
}

OptimizeResult optimize(const OptimizeProblem& problem, const OptimizeOptions& options, const JobControl& job,
                        const std::function<void(const OptimizeState&)>& watch) {
    options.validate();
    const VwsFunction& function = problem.function;
    OptimizeResult result;
    result.tf = function.base();
    result.targets = normalizedTargets(problem.targets, function.featureCount());
    Search search(function, result.targets, options, job);

    const auto arrive = [&](OptimizeState state) {
        result.history.push_back(std::move(state));
        if (result.history.back().objective < result.history[result.best].objective)
            result.best = result.history.size() - 1;
        if (watch) watch(result.history.back());
        job.report(options.maxIterations == 0 ? 1.0 : static_cast<double>(result.iterations()) / options.maxIterations);
    };
    try {
        arrive(search.evaluate({featureOpacities(function.base())})[0]);
        for (;;) {
            const OptimizeState& at = result.history.back();
            if (at.objective < options.tolerance) {
                result.reason = StopReason::Converged;
                break;
            }
            if (result.iterations() >= options.maxIterations) {
                result.reason = StopReason::MaxIterations;
                break;
            }
            job.throwIfStopped();
            OptimizeState next = search.move(at);
            const bool searches = options.method != SearchMethod::Fixed;
            const bool stalled = searches && result.history.size() - 1 - result.best >= kPatience;
            if (next.opacity == at.opacity || stalled) {
                result.reason = StopReason::NoProgress;
                break;
            }
            arrive(std::move(next));
        }
    } catch (const Cancelled&) {
        result.reason = StopReason::Cancelled;
    }
    result.evaluations = search.evaluations();
    if (!result.history.empty()) result.tf = withFeatureOpacities(function.base(), result.history[result.best].opacity);
    return result;
}

} // namespace pellucid
