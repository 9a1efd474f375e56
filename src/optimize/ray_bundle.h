// What rays of one view meet of the features: how strong pictures of many opacities are, without drawing them.
#pragma once

#include <cstdint>
#include <vector>

#include "base/job.h"
#include "render/view.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// What a bundle of rays, as a small picture has them, meets of the features of a transfer function. Made once for a
/// volume and a view; then pictures of other opacities cost about a millisecond, however large the volume is. Hidden
/// features are not met; what is opaque and in no feature takes light, and counts in alpha.
class RayBundle {
public:
    /// `pixels` rays along each side of the picture. Throws Cancelled.
    RayBundle(const Volume& volume, const TransferFunction& tf, const View& view, int pixels = 72,
              const JobControl& job = {});

    /// Of one transfer function with the same features.
    struct Appearance {
        std::vector<double> covers; ///< part of the alpha that a feature has, mean over the rays that meet it, [0,1]
        std::vector<double> shares; ///< of all alpha, that of each feature, sum ≤ 1: FV (4.5) along these rays
        double alpha = 0;           ///< mean over the rays that meet a wanted feature, [0,1]
        double translucent = 0;     ///< part of those rays whose alpha lies in (0.05, 0.95)
    };
    /// Of each of `tfs`, in their order. `wanted`: per feature; empty: all are. `every`: of so many rays one is looked
    /// at, for estimates that take a part of the time.
    std::vector<Appearance> appearances(const std::vector<TransferFunction>& tfs, const std::vector<char>& wanted = {},
                                        int every = 1) const;

    int rays() const { return static_cast<int>(m_begins.size()) - 1; } ///< that meet any feature
    /// Whether a ray meets a feature: passes through it for at least half of d0.
    bool meets(int ray, int feature) const { return m_met[index(ray, feature)] != 0; }
    int raysOf(int feature) const; ///< that meet it

private:
    std::size_t index(int ray, int feature) const {
        return static_cast<std::size_t>(ray) * m_features + static_cast<std::size_t>(feature);
    }

    std::size_t m_features = 0;
    double m_stepInD0 = 1;
    std::vector<std::uint16_t> m_bins;   ///< of intensity, of all rays one after the other, front to back
    std::vector<std::uint32_t> m_begins; ///< of each ray in m_bins, and the end
    std::vector<std::uint8_t> m_met;     ///< [ray][feature]
    std::vector<int> m_slotOfBin;        ///< its feature; m_features: none, but opaque
};

} // namespace pellucid
