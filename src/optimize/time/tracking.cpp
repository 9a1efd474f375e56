#include "optimize/time/tracking.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "optimize/solve/boxed_step.h"
#include "optimize/solve/log_depths.h"

namespace pellucid {

namespace {

using Point = std::vector<double>;

constexpr double kSlow = 0.98;     ///< of F that a move leaves, where it is time to end
constexpr double kFarWithin = 0.8; ///< of the wanted F, below which a shorter way is looked for
constexpr double kSafety = 0.97;   ///< of the wanted F that a step aims at: models are not exact

/// One frame's search. Unknowns: y = ln τ of the movable features.
class Tracker {
public:
    Tracker(const VwsFunction& function, std::vector<double> targets, std::vector<OpacityLimits> limits,
            const TrackOptions& options, const JobControl& job)
        : m_function(function), m_targets(std::move(targets)), m_options(options), m_job(job),
          m_depths(std::move(limits), m_targets), m_start(m_depths.inside(featureOpacities(function.base()))),
          m_startDepths(m_depths.from(m_start)) {}

    Tracked run() {
        Tracked at;
        at.opacity = m_start;
        if (std::isinf(m_options.coherence) || m_options.maxMoves == 0 || m_depths.count() == 0) {
            at.vws = m_function.evaluate({&at.opacity, 1}, m_job)[0];
            at.objective = objectiveOf(at.vws, m_targets);
            at.evaluations = ++m_evaluations;
            return at;
        }
        double caution = 1;
        std::optional<double> first; // F of the start
        std::vector<std::vector<double>> derivative;
        for (bool known = false;;) {
            if (!known) {
                m_job.throwIfStopped();
                VwsFunction::Linear linear = m_function.jacobian(m_depths.capped(at.opacity), m_job);
                ++m_evaluations;
                at.vws = std::move(linear.vws);
                at.objective = objectiveOf(at.vws, m_targets);
                derivative = std::move(linear.derivative);
                if (!first) first = at.objective;
                at.least = leastDistance(at.vws, derivative, m_targets);
                m_goal = std::hypot(m_options.distance(), at.least);
                known = true;
            }
            if (at.objective <= m_goal || at.moves >= m_options.maxMoves) break;
            findMetric();
            const std::vector<Point> candidates = candidatesFrom(at, matrixOf(derivative), caution);
            if (candidates.empty()) break;
            const auto vws = m_function.evaluate(candidates, m_job);
            m_evaluations += static_cast<int>(candidates.size());
            std::size_t best = 0;
            for (std::size_t i = 1; i < vws.size(); ++i)
                if (better(vws[i], candidates[i], vws[best], candidates[best])) best = i;
            const double reached = objectiveOf(vws[best], m_targets);
            if (!(reached < at.objective)) {
                if (caution < 0.05) break;
                caution /= 8;
                continue;
            }
            const bool slow = reached > m_goal && reached > kSlow * at.objective;
            at.opacity = candidates[best];
            at.vws = vws[best];
            at.objective = reached;
            ++at.moves;
            known = false;
            if (reached <= m_goal || slow) break;
        }
        if (at.moves > 0 && m_options.coherence > 0 && at.objective < kFarWithin * m_goal) shorten(at, first);
        at.evaluations = m_evaluations;
        return at;
    }

private:
    void findMetric() {
        if (m_metric.size() > 0) return;
        Matrix all;
        if (m_options.metric) all = matrixOf(m_options.metric());
        const Eigen::Index n = m_depths.count();
        if (all.size() > 0)
            m_metric = all(m_depths.features(), m_depths.features());
        else
            m_metric = Matrix::Identity(n, n) / static_cast<double>(n);
    }

    /// A long step may end farther within the wanted distance than it must: then part of the way will do.
    void shorten(Tracked& at, const std::optional<double>& first) {
        const double near =
            std::clamp((*first - m_goal) / (*first - at.objective), 0.0, 1.0); // where F is m_goal, about
        const double rest = 1 - near;
        const Vector way = m_depths.from(at.opacity) - m_startDepths;
        std::vector<Point> points;
        for (const double part : {0.6 * near, 0.68 * near, 0.76 * near, 0.84 * near, 0.92 * near, near,
                                  near + 0.3 * rest, near + 0.65 * rest})
            points.push_back(m_depths.opacities(m_startDepths + part * way, m_start));
        const auto vws = m_function.evaluate(points, m_job);
        m_evaluations += static_cast<int>(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) { // the shortest first
            const double reached = objectiveOf(vws[i], m_targets);
            if (!(reached <= m_goal)) continue;
            at.opacity = points[i];
            at.vws = vws[i];
            at.objective = reached;
            return;
        }
    }

    /// The square of a jump.
    double jump(const Point& x) const {
        const Vector v = m_depths.from(x) - m_startDepths;
        return v.dot(m_metric * v);
    }

    /// Within the wanted distance the nearer one, else the one of smaller F. NaN never wins.
    bool better(const std::vector<double>& vws, const Point& x, const std::vector<double>& otherVws,
                const Point& other) const {
        const double f = objectiveOf(vws, m_targets), g = objectiveOf(otherVws, m_targets);
        if (f <= m_goal && g <= m_goal) return jump(x) < jump(other);
        return f < g || (std::isnan(g) && !std::isnan(f));
    }

    /// Steps to where the model has the wanted distance, and to its minimum, of several lengths.
    std::vector<Point> candidatesFrom(const Tracked& at, const Matrix& byOpacity, double caution) const {
        const double root = std::sqrt(static_cast<double>(m_targets.size()));
        const Vector y = m_depths.from(at.opacity), v = y - m_startDepths;
        const Vector r = (vectorOf(at.vws) - vectorOf(m_targets)) / root; // F is its length
        const Matrix j = m_depths.derivatives(byOpacity, at.opacity) / root;
        const Matrix square = j.transpose() * j;
        const double ridge = std::max(1e-9 * square.diagonal().maxCoeff(), 1e-200);
        const auto foretold = [&](const Vector& d) { return (r + j * d).norm(); };
        // The step d with |d_j| ≤ reach and within limits that minimises |r + J d|² + μ·jump(y + d)².
        const auto step = [&](double mu, double reach) {
            Matrix a = square + mu * m_metric;
            a.diagonal().array() += ridge;
            const auto [lowest, highest] = m_depths.stepsFrom(y, reach);
            return boxedStep(a, j.transpose() * r + mu * m_metric * v, lowest, highest);
        };
        std::vector<Point> points;
        const auto add = [&](const Vector& d) {
            const Point x = m_depths.opacities(y + d, at.opacity);
            if (x != at.opacity && std::ranges::find(points, x) == points.end()) points.push_back(x);
        };
        const double wanted = std::hypot(kSafety * m_options.distance(), at.least);
        for (const double length : {3.0, 1.0, 0.3, 0.1}) {
            const double reach = length * caution;
            const Vector most = step(0, reach); // the smallest F of the model
            if (foretold(most) < wanted) {      // of those that are near enough the one nearest to the start
                double lo = -16, hi = 6;        // log10 μ: F of the model grows with it
                for (int i = 0; i < 40; ++i) {
                    const double middle = (lo + hi) / 2;
                    (foretold(step(std::pow(10, middle), reach)) < wanted ? lo : hi) = middle;
                }
                add(step(std::pow(10, lo), reach));
            }
            add(most);
        }
        return points;
    }

    const VwsFunction& m_function;
    const std::vector<double> m_targets;
    const TrackOptions& m_options;
    const JobControl& m_job;
    const LogDepths m_depths;
    const Point m_start;
    const Vector m_startDepths;
    Matrix m_metric;   // of the unknowns
    double m_goal = 0; // F that is good enough
    int m_evaluations = 0;
};

} // namespace

double TrackOptions::distance() const { return std::max(kTrackGoal, coherence * kCoherentDistance); }

double leastDistance(const std::vector<double>& vws, const std::vector<std::vector<double>>& derivative,
                     const std::vector<double>& targets) {
    double lost = 0, square = 0;
    int others = 0;
    for (std::size_t i = 0; i < vws.size(); ++i) {
        const bool absent = vws[i] < 1e-9 && std::all_of(derivative[i].begin(), derivative[i].end(),
                                                         [](double d) { return std::abs(d) < 1e-9; });
        if (!absent) {
            ++others;
            continue;
        }
        lost += targets[i];
        square += targets[i] * targets[i];
    }
    if (others > 0) square += lost * lost / others;
    return std::sqrt(square / static_cast<double>(vws.size()));
}

Tracked track(const VwsFunction& function, const std::vector<double>& targets, const std::vector<OpacityLimits>& limits,
              const TrackOptions& options, const JobControl& job) {
    return Tracker(function, normalizedTargets(targets, function.featureCount()),
                   limitsOfMoves(function.base(), limits), options, job)
        .run();
}

} // namespace pellucid
