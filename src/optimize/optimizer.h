// Gradient descent of the features' opacities to target saliencies (docs/method.md, "Optimization", thesis chapter 5).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "optimize/objective.h"

namespace pellucid {

enum class SearchMethod { Fixed, Line, Parallel };
const char* name(SearchMethod method);                      ///< "fixed", "line", "parallel"
SearchMethod searchMethodFromName(const std::string& name); ///< throws UsageError

enum class StopReason {
    Converged, ///< F < tolerance
    MaxIterations,
    NoProgress, ///< a search has not bettered its best F for several moves, or no step moves any opacity
    Cancelled
};
const char* name(StopReason reason); ///< "converged", "max-iterations", "no-progress", "cancelled"

struct OptimizeOptions {
    SearchMethod method = SearchMethod::Parallel;
    bool normalize = false;  ///< the direction scaled to unit length, as §5.3.4 prints it
    double step = 0.05;      ///< (0, 10]
    double tolerance = 0.03; ///< on F, > 0
    int maxIterations = 200; ///< moves, ≥ 0
    void validate() const;   ///< throws UsageError
    bool operator==(const OptimizeOptions&) const = default;
};

/// One state of the search: the start first, then one after each move.
struct OptimizeState {
    double objective = 0;
    std::vector<double> vws;     ///< per feature
    std::vector<double> opacity; ///< per feature
    bool operator==(const OptimizeState&) const = default;
};

struct OptimizeResult {
    TransferFunction tf;                ///< the best seen
    std::vector<double> targets;        ///< normalised
    std::vector<OptimizeState> history; ///< the start, then each move
    std::size_t best = 0;               ///< index into history of `tf`
    int evaluations = 0;                ///< of W
    StopReason reason = StopReason::MaxIterations;

    int iterations() const { return history.empty() ? 0 : static_cast<int>(history.size()) - 1; }
    bool converged() const { return reason == StopReason::Converged; }
};

/// `watch` is called after the start and each move, on the calling thread. Cancelling through `job` returns what is
/// there so far (StopReason::Cancelled); it does not throw.
OptimizeResult optimize(const VwsFunction& function, const std::vector<double>& targets,
                        const OptimizeOptions& options = {}, const JobControl& job = {},
                        const std::function<void(const OptimizeState&)>& watch = {});

} // namespace pellucid
