// From the opacities of one frame to those of the next (docs/method.md, "Transfer functions over time").
#pragma once

#include <functional>
#include <vector>

#include "optimize/optimizer.h"

namespace pellucid {

/// Distance F from the targets that is as good as none: what tracking without coherence goes below.
inline constexpr double kTrackGoal = 1e-3;
/// Distance F that a coherence of 1 allows for.
inline constexpr double kCoherentDistance = 0.01;

struct TrackOptions {
    double coherence = 0; ///< ≥ 0; infinity: nothing moves
    int maxMoves = 8;     ///< each is a sweep with derivatives and one of up to eight candidates
    /// What a jump is: its square is Σ v_i·metric[i][j]·v_j, v the changes of ln τ of all features, τ = −ln(1 − x) the
    /// optical depth of a peak. Symmetric, positive; empty: the mean of v². Asked for before the first move.
    std::function<std::vector<std::vector<double>>()> metric = {};
    /// F that is good enough: the larger of kTrackGoal and coherence·kCoherentDistance.
    double distance() const;
};

struct Tracked {
    std::vector<double> opacity; ///< per feature
    std::vector<double> vws;     ///< W there
    double objective = 0;        ///< F there
    /// The smallest F that there can be: 0, but where wanted features have no voxel in sight.
    double least = 0;
    int moves = 0;
    int evaluations = 0; ///< of W, derivatives included
};

/// F where features that nothing can raise have none, and the others divide what is left as well as it goes: the
/// smallest that there can be. `derivative`: of W, [i][j], with respect to whatever moves the features.
double leastDistance(const std::vector<double>& vws, const std::vector<std::vector<double>>& derivative,
                     const std::vector<double>& targets);

/// The opacities with the smallest jump from those of function.base() whose distance F from `targets` is at most
/// √(options.distance()² + least²); where there are none, those of the smallest F that moves downhill find. `limits`:
/// one per feature, or empty. Throws UsageError as normalizedTargets() does, Cancelled.
Tracked track(const VwsFunction& function, const std::vector<double>& targets, const std::vector<OpacityLimits>& limits,
              const TrackOptions& options, const JobControl& job = {});

} // namespace pellucid
