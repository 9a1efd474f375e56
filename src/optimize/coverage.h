// How strong a picture is: shares of visibility say nothing about that (docs/method.md, "Coverage").
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "optimize/ray_bundle.h"

namespace pellucid {

/// Of one transfer function from one view.
struct Coverage {
    double coverage = 0;        ///< mean alpha over the pixels whose rays meet any feature, [0,1]; 0 where none does
    std::vector<double> covers; ///< per feature: the part of the alpha that it has, mean over the rays that meet it
    bool operator==(const Coverage&) const = default;
};

/// A picture of these is as good as empty, a feature of this cover as good as unseen (docs/method.md, "Coverage").
inline constexpr double kFaintCoverage = 0.2, kFaintCover = 0.02;
/// What shares that are proposed in their place have to give.
inline constexpr double kVisibleCoverage = 0.3, kVisibleCover = 0.05;

/// Shares that cannot be shown: of the strongest picture that has them.
struct Faintness {
    bool picture = false;              ///< its coverage is below kFaintCoverage
    std::vector<std::size_t> features; ///< wanted, and below kFaintCover where they are seen
    std::vector<std::size_t> limiting; ///< cannot become more opaque, so that nothing else may either

    /// The nearest shares that were found to be visible.
    struct Remedy {
        std::vector<double> shares; ///< whole hundredths or thousandths, sum 1
        std::vector<double> vws;    ///< evaluated, within 0.01 of them
        std::vector<double> opacity;
        Coverage coverage; ///< with these opacities
        bool operator==(const Remedy&) const = default;
    };
    std::optional<Remedy> remedy;
    bool searched = true; ///< the strongest picture and the remedy were looked for; false: no move was allowed
    bool operator==(const Faintness&) const = default;
};

/// What an answer of an optimization looks like.
struct Seen {
    Coverage coverage;
    double strongest = 0;           ///< the largest coverage that was found for its shares
    std::optional<Faintness> faint; ///< where not even that is visible
    bool operator==(const Seen&) const = default;
};

inline constexpr int kCoverageRays = 96; ///< along each side of the picture that coverage is computed from

/// Of each of `tfs`, in their order, which have the features that `rays` was made for and differ in opacities alone.
std::vector<Coverage> coverageOf(const RayBundle& rays, const std::vector<TransferFunction>& tfs);
Coverage coverageOf(const RayBundle& rays, const TransferFunction& tf);

} // namespace pellucid
