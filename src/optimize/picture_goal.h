// What a picture is to be besides the shares of its features: visible, and about as strong as it was (docs/method.md,
// "A picture that can be seen").
#pragma once

#include <optional>
#include <vector>

#include "optimize/coverage.h"
#include "optimize/optimizer.h"

namespace pellucid {

/// PictureGoal::lack() that is as good as none.
inline constexpr double kShownLack = 0.002;

/// The floors and the strength that are wanted of one search's pictures, and how far a picture is from them.
class PictureGoal {
public:
    /// `start`: the opacities that the search begins with, whose coverage is kept where it lies within
    /// [kFaintCoverage, kMostCoverage] and `coverage` names no other; `targets` are normalised, `limits` complete.
    /// Floors that no opacities reach become what the limits allow. Keeps references.
    PictureGoal(const RayBundle& rays, const TransferFunction& base, const std::vector<double>& targets,
                const std::vector<OpacityLimits>& limits, const std::vector<double>& start,
                std::optional<double> coverage);

    enum class Rays {
        All,
        Some ///< a part of them, for the steps of a search
    };
    /// Of each of `opacities` (peaks of all features), in their order; coverage is that of the rays that meet what is
    /// wanted.
    std::vector<Coverage> looks(const std::vector<std::vector<double>>& opacities, Rays rays = Rays::All) const;

    /// ln(wanted/have) of what is farthest below its floor; 0 where nothing is.
    double lack(const Coverage& look) const;
    /// |ln(have/wanted)| of the coverage; 0 where nothing wanted is in sight.
    double miss(const Coverage& look) const;
    /// What a search aims at, a little above the floors: ln(aim/have) of the picture, then of each feature with a
    /// floor; above 0 where it is missed.
    std::vector<double> shortfalls(const Coverage& look) const;
    /// ln(have/wanted) of the coverage.
    double excess(const Coverage& look) const;

    /// Fills in what cannot be seen of it.
    Seen seen(const Coverage& look) const;

private:
    const RayBundle& m_rays;
    const TransferFunction& m_base;
    std::vector<char> m_wanted; ///< per feature: it has a target above 0
    double m_asked = 1;         ///< part of the usual floors that a small wanted coverage leaves
    double m_coverage = 0, m_leastCoverage = 0;
    std::vector<double> m_leastCovers;
};

} // namespace pellucid
