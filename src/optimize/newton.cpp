#include "optimize/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "optimize/boxed_step.h"

namespace pellucid {

namespace {

constexpr double kLeastOpacity = 1e-7; ///< of a peak that is wanted: ln x has no place for 0
constexpr double kCoarseGoal = 2e-4;   ///< F on coarser volumes, which differ from the full one by more
constexpr double kTinyShare = 1e-3;    ///< added to shares before their logarithm is taken
constexpr int kCoarseMoves = 40;       ///< at most, per descent
constexpr int kSpread = 64, kBatch = 8, kRefined = 3;

double logOf(double x) { return std::log(std::max(x, kLeastOpacity)); }

/// The n-th number of the van der Corput sequence to a prime base: dimensions of Halton's lattice.
double halton(int n, int base) {
    double value = 0, digit = 1.0 / base;
    for (; n > 0; n /= base, digit /= base) value += digit * (n % base);
    return value;
}

constexpr int kPrimes[] = {2,  3,  5,  7,  11, 13, 17, 19, 23, 29,  31,  37,  41,  43,  47,  53,
                           59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103, 107, 109, 113, 127, 131};

} // namespace

NewtonSearch::NewtonSearch(const std::vector<const VwsFunction*>& levels, const std::vector<double>& targets,
                           const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                           const JobControl& job, Arrive arrive)
    : m_levels(levels), m_targets(targets), m_limits(limits), m_options(options), m_job(job),
      m_arrive(std::move(arrive)) {
    // A target of 0 is met by the lowest opacity, and x is not moved any more.
    for (std::size_t f = 0; f < targets.size(); ++f)
        m_held.push_back(limits[f].locked || targets[f] == 0 || limits[f].lowest == limits[f].highest);
}

OptimizeState NewtonSearch::stateOf(const std::vector<double>& vws, const Point& x, std::size_t level) const {
    return {objectiveOf(vws, m_targets), vws, x, static_cast<int>(level)};
}

std::vector<OptimizeState> NewtonSearch::evaluate(std::size_t level, const std::vector<Point>& candidates) {
    const auto vws = m_levels[level]->evaluate(candidates, m_job);
    m_evaluations += static_cast<int>(candidates.size());
    std::vector<OptimizeState> states;
    for (std::size_t i = 0; i < candidates.size(); ++i) states.push_back(stateOf(vws[i], candidates[i], level));
    return states;
}

NewtonSearch::Linear NewtonSearch::linearize(std::size_t level, const Point& x) {
    VwsFunction::Linear linear = m_levels[level]->jacobian(x, m_job);
    ++m_evaluations;
    for (auto& row : linear.derivative)
        for (std::size_t j = 0; j < x.size(); ++j) row[j] *= m_held[j] ? 0.0 : x[j];
    return {stateOf(linear.vws, x, level), std::move(linear.derivative)};
}

/// Where the search begins: targets of 0 at the lowest opacity, wanted features above 0.
NewtonSearch::Point NewtonSearch::inside(Point x) const {
    double sum = 0;
    int wanted = 0;
    for (std::size_t f = 0; f < x.size(); ++f)
        if (!m_held[f] && x[f] > 0) {
            sum += std::log(x[f]);
            ++wanted;
        }
    const double usual = wanted > 0 ? std::clamp(std::exp(sum / wanted), 1e-3, 0.5) : 0.1;
    for (std::size_t f = 0; f < x.size(); ++f) {
        if (m_limits[f].locked) continue;
        if (m_targets[f] == 0)
            x[f] = m_limits[f].lowest;
        else if (x[f] < kLeastOpacity)
            x[f] = usual;
        x[f] = std::clamp(x[f], m_limits[f].lowest, m_limits[f].highest);
    }
    return x;
}

NewtonSearch::Point NewtonSearch::steppedBy(const Linear& at, bool logarithmic, double damping, double reach) const {
    const std::size_t n = m_targets.size();
    Matrix a(n, std::vector<double>(n, 0.0));
    std::vector<double> g(n, 0.0), lowest(n, 0.0), highest(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        const double w = at.state.vws[i], t = m_targets[i];
        // ln((W + ε)/(t + ε)), weighted by t: linear in ln x where features do not hide each other.
        const double scale = logarithmic ? 1 / (w + kTinyShare) : 1;
        const double residual = logarithmic ? std::log((w + kTinyShare) / (t + kTinyShare)) : w - t;
        const double weight = logarithmic ? t + kTinyShare : 1;
        for (std::size_t j = 0; j < n; ++j) {
            const double dj = at.derivative[i][j] * scale * weight;
            if (dj == 0) continue;
            g[j] += dj * residual;
            for (std::size_t k = 0; k < n; ++k) a[j][k] += dj * at.derivative[i][k] * scale;
        }
    }
    double most = 0;
    for (std::size_t j = 0; j < n; ++j) most = std::max(most, a[j][j]);
    for (std::size_t j = 0; j < n; ++j) {
        a[j][j] += std::max(damping * most, 1e-200);
        if (m_held[j]) continue;
        const double y = logOf(at.state.opacity[j]);
        lowest[j] = std::clamp(logOf(m_limits[j].lowest) - y, -reach, 0.0);
        highest[j] = std::clamp(logOf(m_limits[j].highest) - y, 0.0, reach);
    }
    const std::vector<double> p = boxedStep(a, g, lowest, highest);
    Point x = at.state.opacity;
    for (std::size_t j = 0; j < n; ++j)
        if (p[j] != 0) x[j] = std::clamp(x[j] * std::exp(p[j]), m_limits[j].lowest, m_limits[j].highest);
    return x;
}

/// Steps of one batch; those that would differ by less than F/20 in the shares that the derivatives foretell are one.
std::vector<NewtonSearch::Point> NewtonSearch::candidates(const Linear& at, double caution) const {
    std::vector<Point> points;
    for (const bool logarithmic : {true, false})
        for (const auto& [damping, reach] : {std::pair{1e-7, 4.0}, {1e-3, 2.0}, {3e-2, 1.0}, {0.3, 0.4}}) {
            const Point x = steppedBy(at, logarithmic, damping / caution, reach * caution);
            const auto same = [&](const Point& other) {
                double square = 0;
                for (std::size_t i = 0; i < x.size(); ++i) {
                    double w = 0;
                    for (std::size_t j = 0; j < x.size(); ++j)
                        if (x[j] != other[j]) w += at.derivative[i][j] * std::log(x[j] / other[j]);
                    square += w * w;
                }
                return std::sqrt(square / static_cast<double>(x.size())) < 0.05 * at.state.objective;
            };
            if (x != at.state.opacity && std::none_of(points.begin(), points.end(), same)) points.push_back(x);
        }
    return points;
}

OptimizeState NewtonSearch::descend(std::size_t level, OptimizeState from, double goal, int moves, bool tell) {
    constexpr int kFailures = 3, kSlowMoves = 4;
    constexpr double kSlow = 0.98; ///< of F that a move leaves
    double caution = 1;
    int failures = 0, slow = 0;
    std::optional<Linear> at;
    while (from.objective >= goal && moves > 0 && failures < kFailures && slow < kSlowMoves) {
        m_job.throwIfStopped();
        if (!at) at = linearize(level, from.opacity);
        const std::vector<Point> points = candidates(*at, caution);
        if (points.empty()) break;
        std::vector<OptimizeState> states = evaluate(level, points);
        auto best = std::min_element(states.begin(), states.end(),
                                     [](const auto& a, const auto& b) { return a.objective < b.objective; });
        if (!(best->objective < from.objective)) {
            caution /= 10;
            ++failures;
            continue;
        }
        slow = best->objective > kSlow * from.objective ? slow + 1 : 0;
        failures = 0;
        caution = std::min(1.0, caution * 3);
        from = std::move(*best);
        at.reset();
        --moves;
        if (level == 0) ++m_moves;
        if (tell) m_arrive(from);
    }
    return from;
}

std::vector<NewtonSearch::Point> NewtonSearch::spreadPoints(int count) const {
    std::vector<Point> points;
    for (int p = 0; p < count; ++p) {
        Point x(m_targets.size(), 0.0);
        for (std::size_t f = 0; f < x.size(); ++f) {
            // ln x between those of 1e-3 and 1, and of the limits.
            const double lo = std::max(logOf(m_limits[f].lowest), std::min(std::log(1e-3), logOf(m_limits[f].highest)));
            const double hi = logOf(m_limits[f].highest);
            x[f] = std::exp(lo + (hi - lo) * halton(p + 1, kPrimes[f % std::size(kPrimes)]));
        }
        points.push_back(std::move(x));
    }
    return points;
}

/// On the coarsest volume.
OptimizeState NewtonSearch::spread(const OptimizeState& best) {
    const std::size_t level = m_levels.size() - 1;
    std::vector<OptimizeState> states;
    std::vector<Point> points = spreadPoints(kSpread);
    for (Point& x : points)
        for (std::size_t f = 0; f < x.size(); ++f)
            if (m_held[f]) x[f] = best.opacity[f];
    for (std::size_t first = 0; first < points.size(); first += kBatch) {
        const auto begin = points.begin() + static_cast<std::ptrdiff_t>(first);
        for (OptimizeState& s : evaluate(level, {begin, begin + kBatch})) states.push_back(std::move(s));
    }
    m_spreadStarts += kSpread;
    std::stable_sort(states.begin(), states.end(),
                     [](const auto& a, const auto& b) { return a.objective < b.objective; });
    OptimizeState found = best;
    for (std::size_t i = 0; i < kRefined; ++i) {
        OptimizeState end = descend(level, states[i], kCoarseGoal, kCoarseMoves, false);
        if (end.objective < found.objective) found = std::move(end);
        if (found.objective < kCoarseGoal) break;
    }
    return found;
}

StopReason NewtonSearch::run(const OptimizeState& start) {
    const double goal = std::min(kNewtonGoal, m_options.tolerance);
    const auto reasonOf = [&](double f) { return f < m_options.tolerance ? StopReason::Converged : StopReason::NoProgress; };
    if (start.objective < goal) return StopReason::Converged;
    if (m_options.maxIterations == 0) return reasonOf(start.objective) == StopReason::Converged ? StopReason::Converged : StopReason::MaxIterations;
    const bool coarse = m_levels.size() > 1;

    OptimizeState best = start; // on the volume
    const auto fullMoves = [&] { return m_options.maxIterations - m_moves; };
    const auto arriveAt = [&](const Point& x) {
        OptimizeState state = evaluate(0, {x})[0];
        ++m_moves;
        m_arrive(state);
        return state;
    };

    Point x = inside(start.opacity);
    if (coarse) {
        for (std::size_t level = m_levels.size() - 1; level > 0; --level) {
            OptimizeState state = evaluate(level, {x})[0];
            state = descend(level, std::move(state), kCoarseGoal, kCoarseMoves, true);
            if (level + 1 == m_levels.size() && state.objective >= kCoarseGoal) {
                const OptimizeState found = spread(state);
                if (found.objective < state.objective) m_arrive(found);
                if (found.objective < state.objective) state = found;
            }
            x = state.opacity;
        }
    }
    OptimizeState at = x == start.opacity ? start : arriveAt(x);
    at = descend(0, std::move(at), goal, fullMoves(), true);
    if (at.objective < best.objective) best = at;
    if (best.objective >= goal && !coarse && fullMoves() > 0) {
        const OptimizeState found = spread(best);
        if (found.objective < best.objective) {
            m_arrive(found);
            ++m_moves;
            best = found;
        }
    }
    if (best.objective >= m_options.tolerance && fullMoves() <= 0) return StopReason::MaxIterations;
    return reasonOf(best.objective);
}

} // namespace pellucid
