// The features' opacities that give them target saliencies (docs/method.md, "Optimization", thesis chapter 5).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/setting.h"
#include "optimize/coverage.h"
#include "optimize/objective.h"
#include "optimize/solve/opacity_limits.h"

namespace pellucid {

enum class SearchMethod {
    Fixed,    ///< steps of one length
    Line,     ///< the length doubled or halved while that helps
    Parallel, ///< eight lengths at once, the best of them
    Newton    ///< Levenberg–Marquardt with exact derivatives
};
template <>
inline constexpr auto kNamesOf<SearchMethod> = enumNames("search method", "fixed", "line", "parallel", "newton");

/// Where a step of the searches goes (docs/method.md, "Optimization"; thesis 5.3.4). Newton has its own.
enum class Direction {
    Gradient, ///< method 1: ∂F/∂W_i·b, with ∂F/∂W_i as 2(W − t)
    Backward, ///< ∂F/∂W_i·∇W_i/d, differences to the state before
    Second,   ///< method 2: ∇F/∇F', differences to the state before
    Exact     ///< Jᵀ·2(W − t), J the exact derivatives
};
template <>
inline constexpr auto kNamesOf<Direction> = enumNames("direction", "gradient", "backward", "second", "exact");

enum class StopReason {
    Converged, ///< F < tolerance
    MaxIterations,
    NoProgress, ///< a search has not bettered its best F for several moves, or no step moves any opacity
    Cancelled,
    Visible ///< F < tolerance is to be had, but not with a picture in which everything wanted can be seen
};
template <>
inline constexpr auto kNamesOf<StopReason> = enumNames("end", "converged", "max-iterations", "no-progress", "cancelled",
                                                       "visible");

/// Ranges are those of settingsOf<OptimizeOptions>().
struct OptimizeOptions {
    SearchMethod method = SearchMethod::Newton;
    Direction direction = Direction::Gradient;
    double b = 1;           ///< of method 1
    bool normalize = false; ///< the direction scaled to unit length, as §5.3.4 prints it
    double step = 0.05;
    double tolerance = 0.03; ///< on F
    int maxIterations = 200; ///< moves on the volume
    bool coarse = true;      ///< Newton: the first moves by estimates, where the problem has some
    bool restarts = true;    ///< Newton: where it is stuck it tries starts spread over all opacities
    /// Mean alpha that is wanted of the picture; empty: with Newton that of the start, within
    /// [kFaintCoverage, kMostCoverage], else as it comes.
    std::optional<double> coverage = {};
    /// Shares are met even where nothing can be seen of them; false: coverage and covers have floors (picture_goal.h).
    bool exactShares = false;
    /// Line and Parallel: the lengths 1, 2, 4 and 8 base steps (docs/method.md, "The published profile"). Follows from
    /// the profile and is kept in no session.
    bool publishedSteps = false;
    void validate() const; ///< throws UsageError
    bool operator==(const OptimizeOptions&) const = default;
};
template <>
std::span<const Setting> settingsOf<OptimizeOptions>();

/// One state of the search: the start first, then one after each move.
struct OptimizeState {
    double objective = 0;
    std::vector<double> vws;     ///< per feature
    std::vector<double> opacity; ///< per feature
    int level = 0;               ///< 0: figures of the volume; n: of OptimizeProblem::estimates[n − 1]
    bool operator==(const OptimizeState&) const = default;
};

struct OptimizeResult {
    TransferFunction tf;                ///< the best seen
    std::vector<double> targets;        ///< normalised
    std::vector<OptimizeState> history; ///< the start, then each move
    std::size_t best = 0;               ///< index into history of `tf`, a state of level 0
    /// How many states of the history the search has made; those behind them came after it, so that the picture can be
    /// seen. 0: all.
    std::size_t searched = 0;
    int evaluations = 0;  ///< of W, on any level
    int spreadStarts = 0; ///< Newton: starts tried all over the opacities, because it was stuck
    StopReason reason = StopReason::MaxIterations;
    std::optional<Seen> seen = {}; ///< of `tf`; where the problem has rays

    int iterations() const;       ///< moves of the search on the volume
    int coarseIterations() const; ///< its states by estimates
    int laterSteps() const;       ///< states after the search
    bool converged() const { return reason == StopReason::Converged; }
};

/// The limits of what may move: `given`, or none where that is empty, with locks on what is hidden in `base` and what
/// nothing can raise. Throws UsageError where there are not as many as features, or one is no range within 0 and 1.
std::vector<OpacityLimits> limitsOfMoves(const TransferFunction& base, std::vector<OpacityLimits> given);

/// What is to be solved. Keeps references.
struct OptimizeProblem {
    const VwsFunction& function;
    std::vector<double> targets;            ///< ≥ 0, scaled to sum 1
    std::vector<OpacityLimits> limits = {}; ///< one per feature; empty: none has any
    VwsEstimates estimates = {};            ///< of `function` (optimize/ray_vws.h)
    /// Makes them where `estimates` is empty, when they are first needed; may be empty, too.
    std::function<VwsEstimates()> makeEstimates = {};
    /// Of the function's view and features: what pictures look like. Null: shares are all that counts.
    const RayBundle* rays = nullptr;
    /// Opacities that earlier searches have come to: Newton looks at them, too, so that it never ends farther away.
    std::vector<std::vector<double>> known = {};
    /// With Newton: the start is close to the answer, as where things change little by little. Floors count from the
    /// first move, and nothing farther away is looked for.
    bool nearby = false;
};

/// `watch` is called after the start and each move, on the calling thread. Cancelling through `job` returns what is
/// there so far (StopReason::Cancelled); it does not throw.
OptimizeResult optimize(const OptimizeProblem& problem, const OptimizeOptions& options = {}, const JobControl& job = {},
                        const std::function<void(const OptimizeState&)>& watch = {});

} // namespace pellucid
