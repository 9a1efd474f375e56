// How strong a picture is: shares of visibility say nothing about that (docs/method.md, "Coverage").
#pragma once

#include <span>
#include <vector>

#include "optimize/ray_bundle.h"

namespace pellucid {

/// Of one transfer function from one view.
struct Coverage {
    double coverage = 0;        ///< mean alpha over the pixels whose rays meet any feature, [0,1]; 0 where none does
    std::vector<double> covers; ///< per feature: the part of the alpha that it has, mean over the rays that meet it
    bool operator==(const Coverage&) const = default;
};

inline constexpr int kCoverageRays = 96; ///< along each side of the picture that coverage is computed from

/// Of each of `tfs`, in their order, which have the features that `rays` was made for and differ in opacities alone.
std::vector<Coverage> coverageOf(const RayBundle& rays, const std::vector<TransferFunction>& tfs);
Coverage coverageOf(const RayBundle& rays, const TransferFunction& tf);

} // namespace pellucid
