#include "optimize/time/tracking.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "optimize/solve/boxed_step.h"
#include "tf/opacity.h"

namespace pellucid {

namespace {

using Point = std::vector<double>;
using Rows = std::vector<Point>;

constexpr double kLeastOpacity = 1e-7;    ///< a logarithm has no place for 0
constexpr double kMostOpacity = 1 - 2e-7; ///< beyond, extinction is capped
constexpr double kSlow = 0.98;            ///< of F that a move leaves, where it is time to end
constexpr double kFarWithin = 0.8;        ///< of the wanted F, below which a shorter way is looked for
constexpr double kSafety = 0.97;          ///< of the wanted F that a step aims at: models are not exact

double logDepth(double x) { return std::log(opticalDepthOfOpacity(std::clamp(x, kLeastOpacity, kMostOpacity))); }
double opacityAt(double y) { return -std::expm1(-std::exp(y)); }

std::vector<std::size_t> movable(const std::vector<double>& targets, const std::vector<OpacityLimits>& limits) {
    std::vector<std::size_t> all;
    for (std::size_t f = 0; f < targets.size(); ++f)
        if (targets[f] > 0 && (limits.empty() || (!limits[f].locked && limits[f].lowest < limits[f].highest)))
            all.push_back(f);
    return all;
}

/// One frame's search. Unknowns: y = ln τ of the movable features.
class Tracker {
public:
    Tracker(const VwsFunction& function, std::vector<double> targets, std::vector<OpacityLimits> limits,
            const TrackOptions& options, const JobControl& job)
        : m_function(function), m_targets(std::move(targets)), m_limits(std::move(limits)), m_options(options),
          m_job(job), m_features(movable(m_targets, m_limits)) {
        m_start = inside(featureOpacities(function.base()));
    }

    Tracked run() {
        Tracked at;
        at.opacity = m_start;
        if (std::isinf(m_options.coherence) || m_options.maxMoves == 0 || m_features.empty()) {
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
                VwsFunction::Linear linear = m_function.jacobian(capped(at.opacity), m_job);
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
            const std::vector<Point> candidates = candidatesFrom(at, derivative, caution);
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
    /// Targets of 0 at the lowest opacity, wanted features above 0.
    Point inside(Point x) const {
        double sum = 0;
        int wanted = 0;
        for (const std::size_t f : m_features)
            if (x[f] > 0) {
                sum += std::log(x[f]);
                ++wanted;
            }
        const double usual = wanted > 0 ? std::clamp(std::exp(sum / wanted), 1e-3, 0.5) : 0.1;
        for (std::size_t f = 0; f < x.size(); ++f) {
            if (m_limits[f].locked) continue;
            if (m_targets[f] == 0)
                x[f] = 0;
            else if (x[f] < kLeastOpacity)
                x[f] = usual;
            x[f] = std::clamp(x[f], m_limits[f].lowest, m_limits[f].highest);
        }
        return x;
    }

    Point capped(Point x) const {
        for (const std::size_t f : m_features) x[f] = std::min(x[f], kMostOpacity);
        return x;
    }

    void findMetric() {
        if (!m_metric.empty()) return;
        std::vector<std::vector<double>> all;
        if (m_options.metric) all = m_options.metric();
        for (const std::size_t f : m_features) {
            Point& row = m_metric.emplace_back();
            for (const std::size_t g : m_features)
                row.push_back(!all.empty() ? all[f][g] : f == g ? 1.0 / static_cast<double>(m_features.size()) : 0.0);
        }
    }

    /// A long step may end farther within the wanted distance than it must: then part of the way will do.
    void shorten(Tracked& at, const std::optional<double>& first) {
        const double near =
            std::clamp((*first - m_goal) / (*first - at.objective), 0.0, 1.0); // where F is m_goal, about
        const double rest = 1 - near;
        std::vector<Point> points;
        for (const double part : {0.6 * near, 0.68 * near, 0.76 * near, 0.84 * near, 0.92 * near, near,
                                  near + 0.3 * rest, near + 0.65 * rest}) {
            Point x = at.opacity;
            for (const std::size_t f : m_features) {
                const double y = logDepth(m_start[f]);
                x[f] = std::clamp(opacityAt(y + part * (logDepth(at.opacity[f]) - y)), m_limits[f].lowest,
                                  m_limits[f].highest);
            }
            points.push_back(std::move(x));
        }
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
        Point v;
        for (const std::size_t f : m_features) v.push_back(logDepth(x[f]) - logDepth(m_start[f]));
        double square = 0;
        for (std::size_t p = 0; p < v.size(); ++p)
            for (std::size_t q = 0; q < v.size(); ++q) square += v[p] * m_metric[p][q] * v[q];
        return square;
    }

    /// Within the wanted distance the nearer one, else the one of smaller F. NaN never wins.
    bool better(const std::vector<double>& vws, const Point& x, const std::vector<double>& otherVws,
                const Point& other) const {
        const double f = objectiveOf(vws, m_targets), g = objectiveOf(otherVws, m_targets);
        if (f <= m_goal && g <= m_goal) return jump(x) < jump(other);
        return f < g || (std::isnan(g) && !std::isnan(f));
    }

    /// The step d with |d_j| ≤ reach and within limits that minimises |r + J d|²/n + μ·jump(y + d)².
    Point step(const Rows& j, const Point& r, const Point& v, double mu, double reach, const Point& y) const {
        const std::size_t m = m_features.size();
        const double n = static_cast<double>(r.size());
        Matrix a(m, Point(m, 0.0));
        Point g(m, 0.0), lowest(m), highest(m);
        for (std::size_t row = 0; row < r.size(); ++row)
            for (std::size_t p = 0; p < m; ++p) {
                g[p] += j[row][p] * r[row] / n;
                for (std::size_t q = 0; q < m; ++q) a[p][q] += j[row][p] * j[row][q] / n;
            }
        double most = 0;
        for (std::size_t p = 0; p < m; ++p) most = std::max(most, a[p][p]);
        for (std::size_t p = 0; p < m; ++p) {
            for (std::size_t q = 0; q < m; ++q) {
                a[p][q] += mu * m_metric[p][q];
                g[p] += mu * m_metric[p][q] * v[q];
            }
            a[p][p] += std::max(1e-9 * most, 1e-200);
            const OpacityLimits& limit = m_limits[m_features[p]];
            lowest[p] = std::clamp(logDepth(limit.lowest) - y[p], -reach, 0.0);
            highest[p] = std::clamp(logDepth(limit.highest) - y[p], 0.0, reach);
        }
        return boxedStep(a, g, lowest, highest);
    }

    /// Steps to where the model has the wanted distance, and to its minimum, of several lengths.
    std::vector<Point> candidatesFrom(const Tracked& at, const Rows& byOpacity, double caution) const {
        const std::size_t n = m_targets.size(), m = m_features.size();
        Point y(m), v(m), r(n);
        Rows j(n, Point(m, 0.0));
        for (std::size_t p = 0; p < m; ++p) {
            const double x = std::clamp(at.opacity[m_features[p]], kLeastOpacity, kMostOpacity);
            y[p] = logDepth(x);
            v[p] = y[p] - logDepth(m_start[m_features[p]]);
            for (std::size_t row = 0; row < n; ++row)
                j[row][p] = byOpacity[row][m_features[p]] * (1 - x) * opticalDepthOfOpacity(x);
        }
        for (std::size_t row = 0; row < n; ++row) r[row] = at.vws[row] - m_targets[row];
        const auto foretold = [&](const Point& d) {
            double square = 0;
            for (std::size_t row = 0; row < n; ++row) {
                double w = r[row];
                for (std::size_t p = 0; p < m; ++p) w += j[row][p] * d[p];
                square += w * w;
            }
            return std::sqrt(square / static_cast<double>(n));
        };
        std::vector<Point> points;
        const auto add = [&](const Point& d) {
            Point x = at.opacity;
            for (std::size_t p = 0; p < m; ++p) {
                if (d[p] == 0) continue;
                const OpacityLimits& limit = m_limits[m_features[p]];
                x[m_features[p]] = std::clamp(opacityAt(y[p] + d[p]), limit.lowest, limit.highest);
            }
            if (x != at.opacity && std::find(points.begin(), points.end(), x) == points.end()) points.push_back(x);
        };
        const double wanted = std::hypot(kSafety * m_options.distance(), at.least);
        for (const double length : {3.0, 1.0, 0.3, 0.1}) {
            const double reach = length * caution;
            const Point most = step(j, r, v, 0, reach, y); // the smallest F of the model
            if (foretold(most) < wanted) {                 // of those that are near enough the one nearest to the start
                double lo = -16, hi = 6;                   // log10 μ: F of the model grows with it
                for (int i = 0; i < 40; ++i) {
                    const double middle = (lo + hi) / 2;
                    (foretold(step(j, r, v, std::pow(10, middle), reach, y)) < wanted ? lo : hi) = middle;
                }
                add(step(j, r, v, std::pow(10, lo), reach, y));
            }
            add(most);
        }
        return points;
    }

    const VwsFunction& m_function;
    const std::vector<double> m_targets;
    const std::vector<OpacityLimits> m_limits;
    const TrackOptions& m_options;
    const JobControl& m_job;
    const std::vector<std::size_t> m_features;
    Point m_start;
    Matrix m_metric;   // of the movable features
    double m_goal = 0; // F that is good enough
    int m_evaluations = 0;
};

} // namespace

double TrackOptions::distance() const { return std::max(kTrackGoal, coherence * kCoherentDistance); }

std::vector<OpacityLimits> limitsOfMoves(const TransferFunction& base, const std::vector<OpacityLimits>& given) {
    const std::size_t n = base.features.size();
    std::vector<OpacityLimits> limits = given.empty() ? std::vector<OpacityLimits>(n) : given;
    if (limits.size() != n)
        throw UsageError(std::to_string(limits.size()) + " limits for " + std::to_string(n) + " features", "limits",
                         "give one per feature");
    const std::vector<double> most = featureOpacities(withFullPeaks(base));
    for (std::size_t f = 0; f < n; ++f)
        if (base.features[f].hidden || most[f] == 0) limits[f].locked = true;
    return limits;
}

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
