// What becomes of an optimization's answer: as strong a picture as its shares allow, and what to do where that is none
// (docs/method.md, "Density at equal shares").
#pragma once

#include "optimize/density_curve.h"

namespace pellucid {

/// Moves the answer along the curve of equal shares: with the method newton to the strong end, with a wanted coverage
/// to that, whatever the method is; not where no moves are allowed. The states on the way join the history, the last of
/// them is the best. Fills `seen`, with shares that would be visible where these are not. `watch` as in optimize().
/// Cancelling makes the reason StopReason::Cancelled. Throws as the functions do.
void makeVisible(OptimizeResult& result, const DensityProblem& problem, const OptimizeOptions& options,
                 const JobControl& job = {}, const std::function<void(const OptimizeState&)>& watch = {});

/// What of `seen`, the strongest picture of its shares, is invisible; empty: nothing. `targets`: 0 is not wanted.
std::optional<Faintness> faintnessOf(const Coverage& seen, const std::vector<double>& targets,
                                     const std::vector<double>& opacity, const std::vector<OpacityLimits>& limits);

/// The shares nearest to `targets`, in round numbers, of a picture that has kVisibleCoverage and of its faint features
/// kVisibleCover; empty where none were found. From `opacity`, an answer for `targets`. Throws as the functions do.
std::optional<Faintness::Remedy> visibleShares(const DensityProblem& problem, const std::vector<double>& targets,
                                               const std::vector<double>& opacity, const Faintness& faint,
                                               const JobControl& job = {});

} // namespace pellucid
