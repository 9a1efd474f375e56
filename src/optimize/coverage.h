// How strong a picture is: shares of visibility say nothing about that (docs/method.md, "Coverage").
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "optimize/ray_bundle.h"

namespace pellucid {

/// Of one transfer function from one view.
struct Coverage {
    double coverage = 0; ///< mean alpha over the pixels whose rays meet a wanted feature, [0,1]; 0 where none does
    std::vector<double> covers; ///< per feature: the part of the alpha that it has, mean over the rays that meet it
    bool operator==(const Coverage&) const = default;
};

/// A picture of less is as good as empty, a feature of less cover as good as unseen (docs/method.md, "A picture that
/// can be seen").
inline constexpr double kFaintCoverage = 0.2, kFaintCover = 0.02;
/// A picture of more shows little but surfaces: optimizing goes no further by itself.
inline constexpr double kMostCoverage = 0.7;

/// Whether the picture, or a feature with a target above 0, is fainter than that.
bool isFaint(const Coverage& look, const std::vector<double>& targets);

/// Opacities, and what they look like.
struct SeenShares {
    std::vector<double> opacity; ///< per feature
    std::vector<double> vws;     ///< likewise
    double objective = 0;        ///< F of these
    Coverage look;
    bool operator==(const SeenShares&) const = default;
};

/// What an answer of an optimization looks like.
struct Seen {
    Coverage coverage;
    bool faint = false;                ///< the picture: below kFaintCoverage
    std::vector<std::size_t> unseen;   ///< wanted features below kFaintCover
    std::optional<SeenShares> exact;   ///< nearer to the targets than the answer, and faint: why it is not the answer
    std::optional<SeenShares> visible; ///< of a faint answer: the nearest that is less so
    bool operator==(const Seen&) const = default;
};

inline constexpr int kCoverageRays = 96; ///< along each side of the picture that coverage is computed from

/// Features that are drawn: not hidden, and of an opacity above 0; all where none is.
std::vector<char> drawnFeatures(const TransferFunction& tf);

/// Of each of `tfs`, in their order, which have the features that `rays` was made for and differ in opacities alone.
/// `wanted` and `every` as RayBundle::appearances() has them.
std::vector<Coverage> coverageOf(const RayBundle& rays, const std::vector<TransferFunction>& tfs,
                                 const std::vector<char>& wanted, int every = 1);
/// What is drawn is wanted.
Coverage coverageOf(const RayBundle& rays, const TransferFunction& tf);

} // namespace pellucid
