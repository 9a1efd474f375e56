// Levenberg–Marquardt with the exact derivatives of W, bounds, and a search from spread starts where it is stuck
// (docs/method.md, "Newton").
#pragma once

#include "optimize/optimizer.h"

namespace pellucid {

/// Below this F Newton is content, however large the tolerance is: one move more costs little and ends close by.
inline constexpr double kNewtonGoal = 1e-3;

/// The fixed part of optimize(): `targets` are normalised, `limits` complete, options valid. `arrive` takes every state
/// of the history in its order, the start first. Throws Cancelled.
class NewtonSearch {
public:
    using Arrive = std::function<void(const OptimizeState&)>;
    /// `levels`: the volume first, then coarser ones. Keeps references.
    NewtonSearch(const std::vector<const VwsFunction*>& levels, const std::vector<double>& targets,
                 const std::vector<OpacityLimits>& limits, const OptimizeOptions& options, const JobControl& job,
                 Arrive arrive);

    /// From these opacities.
    StopReason run(const std::vector<double>& start);

    int evaluations() const { return m_evaluations; }
    int spreadStarts() const { return m_spreadStarts; }

private:
    using Point = std::vector<double>;
    /// A state with ∂W_i/∂x_j as [i][j].
    struct Linear {
        OptimizeState state;
        std::vector<std::vector<double>> derivative;
    };
    enum class Variable { Depth, Opacity };    ///< ln τ, τ = −ln(1 − x), or ln x
    enum class Residual { Ratio, Difference }; ///< ln (W/t) or W − t
    struct Step {
        Variable variable;
        Residual residual;
        double damping, reach;
    };

    OptimizeState stateOf(const std::vector<double>& vws, const Point& x, std::size_t level) const;
    std::vector<OptimizeState> evaluate(std::size_t level, const std::vector<Point>& candidates);
    Linear linearize(std::size_t level, const Point& x);
    void arrive(const OptimizeState& state);
    bool mayMove(std::size_t level) const;
    Point inside(Point x) const;
    std::vector<Point> candidates(const Linear& at, double caution) const;
    Point stepped(const Linear& at, const Step& step) const;
    OptimizeState descend(Linear at, double goal, bool borrowed = false);
    OptimizeState refined(OptimizeState from);
    std::vector<OptimizeState> spread(const OptimizeState& best);

    const std::vector<const VwsFunction*>& m_levels;
    const std::vector<double>& m_targets;
    const std::vector<OpacityLimits>& m_limits;
    const OptimizeOptions& m_options;
    const JobControl& m_job;
    Arrive m_arrive;
    double m_goal;            ///< F on the volume
    std::vector<bool> m_held; ///< features that no move changes
    int m_evaluations = 0, m_spreadStarts = 0;
    int m_moves = 0, m_coarseMoves = 0; ///< of this descent
};

} // namespace pellucid
