// Opacities as unknowns: logarithms, in which 0.002 and 0.97 are both normal numbers.
#pragma once

#include <vector>

#include "optimize/solve/matrix.h"
#include "optimize/solve/opacity_limits.h"

namespace pellucid {

inline constexpr double kLeastOpacity = 1e-7;    ///< of what is wanted: a logarithm has no place for 0
inline constexpr double kMostOpacity = 1 - 2e-7; ///< beyond, extinction is capped (docs/method.md, "Visibility")

double logDepthOf(double opacity); ///< ln(−ln(1 − α)), α brought within [kLeastOpacity, kMostOpacity]
double opacityOfLogDepth(double y);

/// The peaks of the features that may change, as y = ln τ, τ = −ln(1 − α); or as y = ln α.
class LogDepths {
public:
    enum class Log { Depth, Opacity };
    /// Unknowns: the features with `wanted` above 0, one number per feature, but for those that are locked or whose
    /// limits leave one opacity. `limits`: one per feature, or empty.
    LogDepths(std::vector<OpacityLimits> limits, const std::vector<double>& wanted, Log log = Log::Depth);

    const std::vector<std::size_t>& features() const { return m_features; } ///< of each unknown, ascending
    Eigen::Index count() const { return m_lowest.size(); }                  ///< of unknowns
    const Vector& lowest() const { return m_lowest; }
    const Vector& highest() const { return m_highest; }

    /// Of the opacities of all features, brought within the bounds.
    Vector from(const std::vector<double>& opacity) const;
    /// `opacity` with the unknowns at y; what is there already keeps its bits.
    std::vector<double> opacities(const Vector& y, std::vector<double> opacity) const;
    Vector clamped(const Vector& y) const { return y.cwiseMax(m_lowest).cwiseMin(m_highest); }
    /// Bounds of a step from y by at most `reach`; they hold 0 where y is within bounds.
    struct Steps {
        Vector lowest, highest;
    };
    Steps stepsFrom(const Vector& y, double reach) const;

    /// Columns of the unknowns, with respect to y, of derivatives with respect to the opacities of all features.
    Matrix derivatives(const Matrix& byOpacity, const std::vector<double>& opacity) const;
    Vector slopes(const std::vector<double>& opacity) const; ///< ∂α/∂y

    /// Where derivatives are: unknowns at kMostOpacity at most.
    std::vector<double> capped(std::vector<double> opacity) const;
    /// Where a search begins: unknowns below kLeastOpacity at the geometric mean of the others, all other features that
    /// are not locked at their lowest opacity.
    std::vector<double> inside(const std::vector<double>& opacity) const;

private:
    double yOf(double opacity) const;

    std::vector<OpacityLimits> m_limits; // of all features
    Log m_log;
    std::vector<std::size_t> m_features;
    Vector m_lowest, m_highest;
};

} // namespace pellucid
