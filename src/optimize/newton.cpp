#include "optimize/newton.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "optimize/boxed_step.h"

namespace pellucid {

namespace {

constexpr double kLeastOpacity = 1e-7;                 ///< of a peak that is wanted: a logarithm has no place for 0
constexpr double kMostOpacity = 1 - 2e-7;              ///< beyond, extinction is capped (docs/method.md, "Visibility")
constexpr double kCoarseGoal = 2e-4;                   ///< F on coarser volumes
constexpr double kTinyShare = 1e-3;                    ///< added to shares before their logarithm is taken
constexpr int kMostCoarseMoves = 40;                   ///< of one descent
constexpr std::size_t kBatch = 8;                      ///< candidates in one call of the engine
constexpr int kSpread = 64;                            ///< starts, where it is stuck
constexpr std::size_t kRefined = 3;                    ///< of them, that are followed
constexpr double kLeastSpread = 1e-4, kMostSpread = 3; ///< their optical depths

double depthOf(double x) { return -std::log1p(-std::clamp(x, kLeastOpacity, kMostOpacity)); }
double logDepth(double x) { return std::log(depthOf(x)); }
double logOpacity(double x) { return std::log(std::max(x, kLeastOpacity)); }

bool lower(const OptimizeState& a, const OptimizeState& b) {
    return a.objective < b.objective || (std::isnan(b.objective) && !std::isnan(a.objective));
}

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
      m_arrive(std::move(arrive)), m_goal(std::min(kNewtonGoal, options.tolerance)) {
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
    Point capped = x;
    for (std::size_t f = 0; f < x.size(); ++f)
        if (!m_held[f]) capped[f] = std::min(x[f], kMostOpacity);
    ++m_evaluations;
    VwsFunction::Linear linear = m_levels[level]->jacobian(capped, m_job);
    return {stateOf(linear.vws, x, level), std::move(linear.derivative)};
}

void NewtonSearch::arrive(const OptimizeState& state) {
    ++(state.level == 0 ? m_moves : m_coarseMoves);
    m_arrive(state);
}

bool NewtonSearch::mayMove(std::size_t level) const {
    return level == 0 ? m_moves < m_options.maxIterations : m_coarseMoves < kMostCoarseMoves;
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

NewtonSearch::Point NewtonSearch::stepped(const Linear& at, const Step& step) const {
    const std::size_t n = m_targets.size();
    const auto logOf = step.variable == Variable::Depth ? logDepth : logOpacity;
    std::vector<double> byLog(n, 0.0); // dx/dy
    for (std::size_t j = 0; j < n; ++j) {
        const double x = std::clamp(at.state.opacity[j], kLeastOpacity, kMostOpacity);
        if (!m_held[j]) byLog[j] = step.variable == Variable::Depth ? (1 - x) * depthOf(x) : x;
    }
    Matrix a(n, std::vector<double>(n, 0.0));
    std::vector<double> g(n, 0.0), lowest(n, 0.0), highest(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        const double w = at.state.vws[i], t = m_targets[i];
        // ln((W + ε)/(t + ε)), weighted by t: linear in y where features do not hide each other.
        const bool ratio = step.residual == Residual::Ratio;
        const double scale = ratio ? 1 / (w + kTinyShare) : 1, weight = ratio ? t + kTinyShare : 1;
        const double residual = ratio ? std::log((w + kTinyShare) / (t + kTinyShare)) : w - t;
        for (std::size_t j = 0; j < n; ++j) {
            const double d = at.derivative[i][j] * byLog[j] * scale * weight;
            if (d == 0) continue;
            g[j] += d * residual;
            for (std::size_t k = 0; k < n; ++k) a[j][k] += d * at.derivative[i][k] * byLog[k] * scale;
        }
    }
    double most = 0;
    for (std::size_t j = 0; j < n; ++j) most = std::max(most, a[j][j]);
    for (std::size_t j = 0; j < n; ++j) {
        a[j][j] += std::max(step.damping * most, 1e-200);
        if (m_held[j]) continue;
        const double y = logOf(at.state.opacity[j]);
        lowest[j] = std::clamp(logOf(m_limits[j].lowest) - y, -step.reach, 0.0);
        highest[j] = std::clamp(logOf(m_limits[j].highest) - y, 0.0, step.reach);
    }
    const std::vector<double> p = boxedStep(a, g, lowest, highest);
    Point x = at.state.opacity;
    for (std::size_t j = 0; j < n; ++j) {
        if (p[j] == 0) continue;
        const double y = std::exp(logOf(x[j]) + p[j]);
        x[j] =
            std::clamp(step.variable == Variable::Depth ? -std::expm1(-y) : y, m_limits[j].lowest, m_limits[j].highest);
    }
    return x;
}

/// Steps of one batch, the boldest first; those whose shares, as the derivatives foretell them, differ by less than
/// F/20 are one.
std::vector<NewtonSearch::Point> NewtonSearch::candidates(const Linear& at, double caution) const {
    const auto same = [&](const Point& a, const Point& b) {
        for (const Variable variable : {Variable::Depth, Variable::Opacity}) {
            double square = 0;
            for (std::size_t i = 0; i < a.size(); ++i) {
                double w = 0;
                for (std::size_t j = 0; j < a.size(); ++j) {
                    if (a[j] == b[j]) continue;
                    const double x = std::clamp(at.state.opacity[j], kLeastOpacity, kMostOpacity);
                    w += at.derivative[i][j] * (variable == Variable::Depth
                                                    ? (1 - x) * depthOf(x) * (logDepth(a[j]) - logDepth(b[j]))
                                                    : x * (logOpacity(a[j]) - logOpacity(b[j])));
                }
                square += w * w;
            }
            if (std::sqrt(square / static_cast<double>(a.size())) > 0.05 * at.state.objective) return false;
        }
        return true;
    };
    std::vector<Point> points;
    for (const auto& [damping, reach] : {std::pair{1e-7, 4.0}, {1e-3, 2.0}, {3e-2, 1.0}, {0.3, 0.4}})
        for (const Variable variable : {Variable::Depth, Variable::Opacity})
            for (const Residual residual : {Residual::Ratio, Residual::Difference}) {
                const Point x = stepped(at, {variable, residual, damping / caution, reach * caution});
                if (points.size() < kBatch && x != at.state.opacity &&
                    std::none_of(points.begin(), points.end(), [&](const Point& p) { return same(p, x); }))
                    points.push_back(x);
            }
    return points;
}

/// Downhill on the level of `at`, to below `goal` if that goes. `borrowed`: the derivatives are those of a coarser
/// copy, which will do for as long as they bring F down fast.
OptimizeState NewtonSearch::descend(Linear at, double goal, bool borrowed) {
    constexpr int kFailures = 3, kSlowMoves = 4;
    constexpr double kSlow = 0.98; // of F that a move leaves
    constexpr double kFast = 0.3;  // likewise
    const auto level = static_cast<std::size_t>(at.state.level);
    double caution = 1;
    int failures = 0, slow = 0;
    bool known = true; // the derivatives at at.state
    while (at.state.objective >= goal && mayMove(level) && failures < kFailures && slow < kSlowMoves) {
        m_job.throwIfStopped();
        if (!known) at = linearize(level, at.state.opacity);
        known = true;
        const std::vector<Point> points = candidates(at, caution);
        if (points.empty() && borrowed) {
            known = borrowed = false;
            continue;
        }
        if (points.empty()) break;
        std::vector<OptimizeState> states = evaluate(level, points);
        const auto best = std::min_element(states.begin(), states.end(), lower);
        if (!lower(*best, at.state)) {
            if (borrowed) {
                known = borrowed = false;
                continue;
            }
            caution /= 10;
            ++failures;
            continue;
        }
        borrowed = borrowed && best->objective < kFast * at.state.objective;
        slow = best->objective > kSlow * at.state.objective ? slow + 1 : 0;
        failures = 0;
        caution = std::min(1.0, caution * 3);
        at.state = std::move(*best);
        known = borrowed;
        arrive(at.state);
    }
    return at.state;
}

/// From the end of a descent on a coarse level through finer ones, up to that on the volume.
OptimizeState NewtonSearch::refined(OptimizeState from) {
    for (int level = from.level - 1; level >= 0; --level) {
        const auto here = static_cast<std::size_t>(level);
        // W differs little from one level to the next, and its derivatives do, too: those of the copy are cheaper.
        Linear at = linearize(here + 1, from.opacity);
        at.state = evaluate(here, {from.opacity})[0];
        m_coarseMoves = 0;
        arrive(at.state);
        from = descend(std::move(at), level == 0 ? m_goal : kCoarseGoal, true);
    }
    return from;
}

/// The best of starts spread over all opacities, followed downhill; on the coarsest volume.
std::vector<OptimizeState> NewtonSearch::spread(const OptimizeState& best) {
    const std::size_t level = m_levels.size() - 1;
    const double least = -std::expm1(-kLeastSpread), most = -std::expm1(-kMostSpread);
    std::vector<OptimizeState> states;
    for (int first = 0; first < kSpread; first += static_cast<int>(kBatch)) {
        std::vector<Point> points;
        for (int p = first; p < first + static_cast<int>(kBatch); ++p) {
            Point x = best.opacity;
            for (std::size_t f = 0; f < x.size(); ++f) {
                if (m_held[f]) continue;
                const double lo = logDepth(std::max(m_limits[f].lowest, std::min(least, m_limits[f].highest)));
                const double hi = std::max(lo, logDepth(std::min(m_limits[f].highest, most)));
                x[f] = -std::expm1(-std::exp(lo + (hi - lo) * halton(p + 1, kPrimes[f % std::size(kPrimes)])));
                x[f] = std::clamp(x[f], m_limits[f].lowest, m_limits[f].highest);
            }
            points.push_back(std::move(x));
        }
        for (OptimizeState& s : evaluate(level, points)) states.push_back(std::move(s));
    }
    m_spreadStarts += kSpread;
    std::stable_sort(states.begin(), states.end(), lower);
    std::vector<OptimizeState> ends;
    for (std::size_t i = 0; i < kRefined && mayMove(level); ++i) {
        m_coarseMoves = 0;
        ends.push_back(descend(linearize(level, states[i].opacity), level == 0 ? m_goal : kCoarseGoal));
        if (ends.back().objective < kCoarseGoal) break;
    }
    std::stable_sort(ends.begin(), ends.end(), lower);
    return ends;
}

StopReason NewtonSearch::run(const std::vector<double>& start) {
    const std::size_t coarsest = m_levels.size() - 1;
    const Point x = inside(start);
    // Where the first move is one on the volume, it needs the derivatives there.
    std::optional<Linear> first;
    if (coarsest == 0 && x == start) first = linearize(0, x);
    OptimizeState best = first ? first->state : evaluate(0, {start})[0]; // on the volume
    m_arrive(best);

    const auto done = [&] { return best.objective < m_goal || !mayMove(0); };
    const auto consider = [&](OptimizeState state) {
        if (lower(state, best)) best = std::move(state);
    };
    bool spreadOut = !m_options.restarts;
    const auto spreadFrom = [&](const OptimizeState& from) {
        spreadOut = true;
        return spread(from);
    };
    if (!done() && coarsest > 0) {
        OptimizeState state = descend(linearize(coarsest, x), kCoarseGoal);
        if (state.objective >= kCoarseGoal && !spreadOut) {
            auto ends = spreadFrom(state);
            if (!ends.empty() && lower(ends[0], state)) state = std::move(ends[0]);
        }
        consider(refined(std::move(state)));
    } else if (!done()) {
        if (!first) {
            first = linearize(0, x);
            arrive(first->state);
        }
        consider(descend(std::move(*first), m_goal));
    }
    if (!done() && !spreadOut)
        for (OptimizeState& end : spreadFrom(best))
            if (!done()) consider(refined(std::move(end)));
    if (best.objective < m_options.tolerance) return StopReason::Converged;
    return mayMove(0) ? StopReason::NoProgress : StopReason::MaxIterations;
}

} // namespace pellucid
