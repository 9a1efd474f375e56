// Levenberg–Marquardt with the exact derivatives of W, bounds, and a search from spread starts where it is stuck
// (docs/method.md, "Newton").
#pragma once

#include "optimize/optimizer.h"
#include "optimize/picture_goal.h"
#include "optimize/solve/log_depths.h"

namespace pellucid {

/// Below this F Newton is content, however large the tolerance is: one move more costs little and ends close by.
inline constexpr double kNewtonGoal = 1e-3;

/// The search of optimize(): `targets` are normalised, `limits` complete, options valid. `arrive` takes every state of
/// the history in its order, the start first. Throws Cancelled.
class NewtonSearch {
public:
    using Arrive = std::function<void(const OptimizeState&)>;
    /// A state and what it looks like.
    struct Place {
        OptimizeState state;
        Coverage look;        ///< of the rays that `goal` has; empty without one
        double lack = 0;      ///< PictureGoal::lack()
        double miss = 0;      ///< PictureGoal::miss()
        double shortfall = 0; ///< Σ of the squares of what is missed of PictureGoal::shortfalls()
    };

    /// `levels`: the volume first, then ever rougher estimates of it. `goal`: null, where shares are all that
    /// counts. Keeps references.
    NewtonSearch(const std::vector<const VwsFunction*>& levels, const std::vector<double>& targets,
                 const std::vector<OpacityLimits>& limits, const OptimizeOptions& options, const PictureGoal* goal,
                 const JobControl& job, Arrive arrive);

    /// To the targets. `starts`: opacities to begin with, the first of them is the start, the others are known answers.
    void toShares(const std::vector<std::vector<double>>& starts);
    /// From nearby: to the least F with the floors.
    void follow(const std::vector<double>& start);
    /// Takes what another search has come to, on the volume, for the start.
    void look(const OptimizeState& state);
    /// To the least F with the floors of the goal, from what toShares() and `starts` came to.
    void toFloors(const std::vector<std::vector<double>>& starts);

    /// Of all that was evaluated on the volume: the best of toShares(), and of those above the floors, or nearest to
    /// them.
    Place nearest() const;
    Place visible() const;
    bool mayMove() const { return mayMove(0); }

    int evaluations() const { return m_evaluations; }
    int spreadStarts() const { return m_spreadStarts; }

private:
    using Point = std::vector<double>;
    /// A place with ∂W_i/∂x_j as (i, j).
    struct Linear {
        Place place;
        Matrix derivative;
    };
    /// What counts besides F: floors times `floor`, the distance from the wanted coverage times `strength`.
    struct Weights {
        double floor = 0, strength = 0;
    };
    /// The goal's residuals at a place and their derivatives by the unknowns m_depths.
    struct GoalRows {
        Vector residuals;
        Matrix byLogDepth;
    };
    enum class Residual { Ratio, Difference }; ///< ln (W/t) or W − t
    struct Step {
        const LogDepths& unknowns;
        Residual residual;
        double damping, reach;
    };

    Place placeOf(const std::vector<double>& vws, const Point& x, std::size_t level, Coverage look) const;
    std::vector<Place> evaluate(std::size_t level, const std::vector<Point>& candidates);
    Linear linearize(std::size_t level, const Point& x);
    GoalRows goalRows(const Place& at, const Weights& weights) const;
    void arrive(const OptimizeState& state);
    bool mayMove(std::size_t level) const;
    double score(const Place& place, const Weights& weights) const;
    bool isThere(const Place& place, const Weights& weights) const;
    bool isGood(const Place& place) const;   ///< on target, and of the wanted strength
    double goalOf(const Place& place) const; ///< F that is good enough on its level
    bool isBetter(const Place& a, const Place& b, const Weights& weights) const;
    const Place& bestIn(const std::vector<Place>& places, const Weights& weights) const;
    const Place& start() const { return m_places.front(); }
    double rank(const Place& place, bool floors) const;
    Place bestOf(bool floors) const;
    std::vector<Weights> phases(bool floors) const;
    Point atStrength(const Point& x, double part) const;
    std::vector<Point> startsFor(const Point& x) const;
    std::vector<Point> candidates(const Linear& at, const GoalRows& rows, double caution) const;
    Point stepped(const Linear& at, const GoalRows& rows, const Step& step) const;
    bool strengthens(const Place& at, const std::vector<Point>& points, double part) const;
    Place descend(Linear at, const Weights& weights, bool borrowed = false);
    Place byEstimates(const std::vector<Point>& starts, bool floors);
    std::vector<Place> spread(std::size_t level, const Point& best, const Weights& weights);
    void refine(const Place& from, const Point& start, bool floors);
    void begin();

    const std::vector<const VwsFunction*>& m_levels;
    const std::vector<double>& m_targets;
    const OptimizeOptions& m_options;
    const PictureGoal* m_goal;
    const JobControl& m_job;
    Arrive m_arrive;
    double m_goalDistance;                 ///< F on the volume that is good enough
    const LogDepths m_depths, m_opacities; ///< the unknowns, both ways
    std::vector<Place> m_places;           ///< all that was evaluated on the volume, the start first
    bool m_forFloors = false;
    std::vector<OptimizeState> m_waiting; ///< for the start, which comes first
    int m_evaluations = 0, m_spreadStarts = 0;
    int m_moves = 0, m_coarseMoves = 0; ///< of this descent
};

} // namespace pellucid
