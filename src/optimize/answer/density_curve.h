// n opacities, n − 1 shares: the one freedom left is the density of the picture. Opacities of equal shares form a
// curve, which is followed here from the faintest to the strongest picture (docs/method.md, "Density at equal shares").
#pragma once

#include <vector>

#include "optimize/coverage.h"
#include "optimize/optimizer.h"

namespace pellucid {

/// A picture on the curve.
struct DensityPoint {
    std::vector<double> opacity; ///< peak of each feature
    std::vector<double> vws;     ///< W of each feature
    double objective = 0;        ///< F of these from the curve's shares
    Coverage coverage;
};

/// Opacities of equal shares.
struct DensityCurve {
    std::vector<double> shares;       ///< W that all points have, sum 1
    std::vector<DensityPoint> points; ///< at least one, coverage ascending; neighbours at most 1.5 apart in ln coverage
    int evaluations = 0;              ///< of W, or of W with its derivatives

    const DensityPoint& faintest() const { return points.front(); }
    const DensityPoint& strongest() const { return points.back(); }
    /// There is no freedom: limits and locks leave one picture.
    bool isPoint() const { return points.size() == 1; }
    /// Opacities of a coverage, between points linear in ln τ; those of the nearer end beyond.
    std::vector<double> at(double coverage) const;
    struct Nearest {
        double coverage = 0;
        double distance = 0; ///< largest of the features, in ln τ
    };
    /// The place on the curve that is nearest to these opacities, as at() has it.
    Nearest nearest(const std::vector<double>& opacity) const;
};

/// What the curve is followed through. Keeps references.
struct DensityProblem {
    const VwsFunction& full;
    const VwsFunction* coarse = nullptr;    ///< an estimate of `full`: steps are taken there
    const RayBundle& rays;                  ///< of the view
    std::vector<OpacityLimits> limits = {}; ///< one per feature; empty: none has any
};

/// Both ends of the curve through `start`: up to where an opacity meets a bound and shares cannot be held any more, or
/// the coverage no longer grows, and down to a tenth of the largest coverage. All points have F < 0.01 from `shares`;
/// empty: those of `start`. Features of opacity 0 stay so. Deterministic. Throws as the functions do, Cancelled.
DensityCurve densityCurve(const DensityProblem& problem, const std::vector<double>& start,
                          const std::vector<double>& shares = {}, const JobControl& job = {});

} // namespace pellucid
