// Opacities as unknowns: logarithms of optical depths, in which 0.002 and 0.97 are both normal numbers, and least
// squares of them within bounds.
#pragma once

#include <vector>

#include "optimize/optimizer.h"

namespace pellucid {

using Numbers = std::vector<double>;
using Rows = std::vector<Numbers>;

double logDepthOf(double opacity); ///< ln(−ln(1 − α)), of α in (0,1]
double opacityOfLogDepth(double y);

/// The features whose opacity may change, as y = ln τ, τ = −ln(1 − α) of the peak. Opacities of 0 and locked ones stay
/// as they are, and so does what the bounds hold.
class LogDepths {
public:
    /// `limits`: one per feature, or empty. A start beyond its limits is moved to them.
    LogDepths(const std::vector<OpacityLimits>& limits, const std::vector<double>& start);

    std::size_t count() const { return m_features.size(); } ///< of unknowns
    const Numbers& start() const { return m_start; }
    const Numbers& lowest() const { return m_lowest; }
    const Numbers& highest() const { return m_highest; }
    Numbers clamped(Numbers y) const;
    bool isHighest(const Numbers& y, std::size_t i) const { return y[i] >= m_highest[i] - 1e-9; }
    std::size_t featureOf(std::size_t i) const { return m_features[i]; }

    std::vector<double> opacity(const Numbers& y) const; ///< of all features
    Numbers from(const std::vector<double>& opacity) const;
    /// Derivatives with respect to y from those with respect to all opacities.
    Rows derivatives(const Rows& byOpacity, const Numbers& y) const;

private:
    std::vector<std::size_t> m_features;
    std::vector<double> m_opacity;
    Numbers m_start, m_lowest, m_highest;
};

/// The d that minimises |r + J d|² + ridge·|d|² with lowest ≤ d ≤ highest, ridge > 0: unknowns that would leave their
/// bounds are put there one by one.
Numbers leastSquaresStep(const Rows& jacobian, const Numbers& residual, const Numbers& lowest, const Numbers& highest,
                         double ridge);

double largestOf(const Numbers& v);                              ///< of the absolute values
Numbers plus(const Numbers& a, double factor, const Numbers& b); ///< a + factor·b

} // namespace pellucid
