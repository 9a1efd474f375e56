#include "optimize/newton.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "optimize/solve/boxed_step.h"

namespace pellucid {

namespace {

constexpr double kCoarseGoal = 1e-3;                   ///< F of estimates, which are farther off than that
constexpr double kTinyShare = 1e-3;                    ///< added to shares before their logarithm is taken
constexpr int kMostCoarseMoves = 40;                   ///< of one descent
constexpr std::size_t kBatch = 8;                      ///< candidates in one call of the engine
constexpr int kSpread = 64;                            ///< starts, where it is stuck
constexpr std::size_t kRefined = 3;                    ///< of them, that are followed
constexpr double kLeastSpread = 1e-4, kMostSpread = 3; ///< their optical depths
constexpr double kContent = 0.5;                       ///< part of a goal below which less F is no gain
constexpr double kFarStrength = 0.3;                   ///< likewise, that are worth another search
constexpr double kNearStrength = 0.1;                  ///< ln of coverages that are as good as equal
constexpr double kShareStep = 0.1;                     ///< of ln τ, for differences of shares
constexpr double kLogStep = 0.05;                      ///< of ln τ, for differences of coverages

/// The n-th number of the van der Corput sequence to a prime base: dimensions of Halton's lattice.
double halton(int n, int base) {
    double value = 0, digit = 1.0 / base;
    for (; n > 0; n /= base, digit /= base) value += digit * (n % base);
    return value;
}

constexpr int kPrimes[] = {2,  3,  5,  7,  11, 13, 17, 19, 23, 29,  31,  37,  41,  43,  47,  53,
                           59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103, 107, 109, 113, 127, 131};

/// Of the derivatives `d` at x₀, which after the move to x₁ are to say what was seen there (Broyden).
void mend(Matrix& d, const OptimizeState& from, const OptimizeState& to) {
    const Vector dx = vectorOf(to.opacity) - vectorOf(from.opacity);
    // Opacities of 0.001 and of 0.9 move alike.
    const Vector scale = vectorOf(to.opacity).cwiseMax(vectorOf(from.opacity));
    const Vector part = (scale.array() > 0).select(dx.array() / scale.array().square(), 0.0);
    const double square = part.dot(dx);
    if (square < 1e-12) return;
    d += (vectorOf(to.vws) - vectorOf(from.vws) - d * dx) / square * part.transpose();
}

/// By all that was seen around `at`, the nearest last, so that it counts most.
void mendBySeen(Matrix& d, const NewtonSearch::Place& at, const std::vector<NewtonSearch::Place>& seen) {
    constexpr double kFar = 1; // ln of opacities: beyond, derivatives are others
    const auto logs = [](const OptimizeState& state) {
        return vectorOf(state.opacity).array().max(kLeastOpacity).log();
    };
    std::vector<std::pair<double, const OptimizeState*>> near;
    for (const auto& place : seen) {
        const double distance = (logs(place.state) - logs(at.state)).abs().maxCoeff();
        if (distance > 0 && distance < kFar) near.emplace_back(distance, &place.state);
    }
    std::ranges::stable_sort(near, std::greater{}, &std::pair<double, const OptimizeState*>::first);
    for (const auto& [distance, state] : near) mend(d, at.state, *state);
}

} // namespace

NewtonSearch::NewtonSearch(const std::vector<const VwsFunction*>& levels, const std::vector<double>& targets,
                           const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                           const PictureGoal* goal, const JobControl& job, Arrive arrive)
    : m_levels(levels), m_targets(targets), m_options(options), m_goal(goal), m_job(job), m_arrive(std::move(arrive)),
      m_goalDistance(std::min(kNewtonGoal, options.tolerance)),
      // A target of 0 is met by the lowest opacity, and x is not moved any more.
      m_depths(limits, targets), m_opacities(limits, targets, LogDepths::Log::Opacity) {}

NewtonSearch::Place NewtonSearch::placeOf(const std::vector<double>& vws, const Point& x, std::size_t level,
                                          Coverage look) const {
    Place place{{objectiveOf(vws, m_targets), vws, x, static_cast<int>(level)}, std::move(look)};
    if (!m_goal) return place;
    place.lack = m_goal->lack(place.look);
    place.miss = m_goal->miss(place.look);
    for (const double s : m_goal->shortfalls(place.look)) place.shortfall += s > 0 ? s * s : 0;
    return place;
}

std::vector<NewtonSearch::Place> NewtonSearch::evaluate(std::size_t level, const std::vector<Point>& candidates) {
    const auto vws = m_levels[level]->evaluate(candidates, m_job);
    m_evaluations += static_cast<int>(candidates.size());
    std::vector<Coverage> looks(candidates.size());
    if (m_goal) looks = m_goal->looks(candidates, level == 0 ? PictureGoal::Rays::All : PictureGoal::Rays::Some);
    std::vector<Place> places;
    for (std::size_t i = 0; i < candidates.size(); ++i)
        places.push_back(placeOf(vws[i], candidates[i], level, std::move(looks[i])));
    if (level == 0) m_places.insert(m_places.end(), places.begin(), places.end());
    return places;
}

NewtonSearch::Linear NewtonSearch::linearize(std::size_t level, const Point& x) {
    ++m_evaluations;
    VwsFunction::Linear linear = m_levels[level]->jacobian(m_depths.capped(x), m_job);
    Coverage look;
    if (m_goal) look = m_goal->looks({x}, level == 0 ? PictureGoal::Rays::All : PictureGoal::Rays::Some)[0];
    Linear at{placeOf(linear.vws, x, level, std::move(look)), matrixOf(linear.derivative)};
    if (level == 0) m_places.push_back(at.place);
    return at;
}

NewtonSearch::GoalRows NewtonSearch::goalRows(const Place& at, const Weights& weights) const {
    GoalRows rows;
    if (!m_goal || (weights.floor == 0 && weights.strength == 0)) return rows;
    const std::vector<std::size_t>& features = m_depths.features();
    std::vector<Point> points{at.state.opacity};
    Vector changes(m_depths.count());
    for (std::size_t p = 0; p < features.size(); ++p) {
        const double y = logDepthOf(at.state.opacity[features[p]]);
        changes[p] = y + kLogStep <= logDepthOf(kMostOpacity) ? kLogStep : -kLogStep;
        points.push_back(at.state.opacity);
        points.back()[features[p]] = opacityOfLogDepth(y + changes[p]);
    }
    const std::vector<Coverage> looks = m_goal->looks(points, PictureGoal::Rays::Some);
    const std::vector<double> here = m_goal->shortfalls(looks[0]);
    std::vector<std::vector<double>> values; // per point: those that count, the strength last
    for (const Coverage& look : looks) {
        std::vector<double>& v = values.emplace_back();
        const std::vector<double> shortfalls = m_goal->shortfalls(look);
        for (std::size_t k = 0; k < here.size(); ++k)
            if (weights.floor > 0 && here[k] > 0) v.push_back(weights.floor * shortfalls[k]);
        if (weights.strength > 0) v.push_back(weights.strength * m_goal->excess(look));
    }
    rows.residuals = vectorOf(values[0]);
    rows.byLogDepth.resize(rows.residuals.size(), m_depths.count());
    for (std::size_t p = 0; p < features.size(); ++p)
        rows.byLogDepth.col(p) = (vectorOf(values[p + 1]) - rows.residuals) / changes[p];
    return rows;
}

void NewtonSearch::arrive(const OptimizeState& state) {
    ++(state.level == 0 ? m_moves : m_coarseMoves);
    if (state.level > 0 && m_forFloors)
        return; // the way to the floors is long, and begins beside the one that is shown
    if (m_places.empty())
        m_waiting.push_back(state);
    else
        m_arrive(state);
}

bool NewtonSearch::mayMove(std::size_t level) const {
    return level == 0 ? m_moves < m_options.maxIterations : m_coarseMoves < kMostCoarseMoves;
}

double NewtonSearch::goalOf(const Place& place) const { return place.state.level == 0 ? m_goalDistance : kCoarseGoal; }

double NewtonSearch::score(const Place& place, const Weights& weights) const {
    // What is good enough is not paid for with strength. NaN stays.
    const double f = std::max(place.state.objective, kContent * goalOf(place));
    return f * f + weights.floor * weights.floor * place.shortfall +
           weights.strength * weights.strength * place.miss * place.miss;
}

bool NewtonSearch::isBetter(const Place& a, const Place& b, const Weights& weights) const {
    const double here = score(a, weights), there = score(b, weights);
    return here < there || (std::isnan(there) && !std::isnan(here));
}

const NewtonSearch::Place& NewtonSearch::bestIn(const std::vector<Place>& places, const Weights& weights) const {
    return *std::ranges::min_element(places, [&](const Place& a, const Place& b) { return isBetter(a, b, weights); });
}

bool NewtonSearch::isThere(const Place& place, const Weights& weights) const {
    return place.state.objective < goalOf(place) && (weights.floor == 0 || place.lack < kShownLack) &&
           (weights.strength == 0 || place.miss < kNearStrength);
}

bool NewtonSearch::isGood(const Place& place) const { return isThere(place, {0, m_goal ? 1.0 : 0.0}); }

/// Small is good: what is above the floors, where they count, comes before what is not; where F is good enough places
/// are alike, and the one nearest to the wanted strength is taken.
double NewtonSearch::rank(const Place& place, bool floors) const {
    const double f = std::isnan(place.state.objective) ? 1e9 : place.state.objective;
    const double goal = goalOf(place);
    return 100 * (floors && place.lack > kShownLack ? place.lack : 0) + std::max(f, goal) +
           (m_goal ? 1e-4 * std::min(place.miss, 5.0) : 0.1 * std::min(f, goal));
}

/// Of the places on the volume.
NewtonSearch::Place NewtonSearch::bestOf(bool floors) const {
    return *std::ranges::min_element(m_places, {}, [&](const Place& place) { return rank(place, floors); });
}

NewtonSearch::Place NewtonSearch::nearest() const {
    Place best = bestOf(false);
    // Unless another strength was asked for, nothing that is farther from the targets than the start is an answer.
    return m_options.coverage || best.state.objective <= start().state.objective ? best : start();
}

NewtonSearch::Place NewtonSearch::visible() const {
    Place best = bestOf(true);
    const bool startShows = start().lack <= std::max(best.lack, kShownLack);
    return m_options.coverage || !startShows || best.state.objective <= start().state.objective ? best : start();
}

/// `x` with all optical depths times one factor, so that the picture has about the wanted coverage times `part`.
NewtonSearch::Point NewtonSearch::atStrength(const Point& x, double part) const {
    if (!m_goal) return x;
    std::vector<Point> points{x};
    const Vector y = m_depths.from(x);
    for (double change = -8; change <= 5; change += 0.5)
        points.push_back(m_depths.opacities((y.array() + change).matrix(), x));
    const std::vector<Coverage> looks = m_goal->looks(points, PictureGoal::Rays::Some);
    const auto off = [&](const Coverage& look) { return std::abs(m_goal->excess(look) - std::log(part)); };
    std::size_t best = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
        if (off(looks[i]) < off(looks[best]) - 0.1) best = i;
    return points[best];
}

NewtonSearch::Point NewtonSearch::stepped(const Linear& at, const GoalRows& rows, const Step& step) const {
    const Point& x = at.place.state.opacity;
    const auto w = vectorOf(at.place.state.vws).array(), t = vectorOf(m_targets).array();
    const Eigen::Index n = t.size(), goals = rows.residuals.size();
    Matrix j(n + goals, m_depths.count());
    Vector r(n + goals);
    j.topRows(n) = step.unknowns.derivatives(at.derivative, x);
    r.head(n) = w - t;
    if (step.residual == Residual::Ratio) {
        // ln((W + ε)/(t + ε)), weighted by t: linear in y where features do not hide each other.
        const Vector root = (t + kTinyShare).sqrt();
        r.head(n) = root.array() * ((w + kTinyShare) / (t + kTinyShare)).log();
        j.topRows(n).array().colwise() *= root.array() / (w + kTinyShare);
    }
    if (goals > 0) { // from ln τ to the unknowns at hand
        j.bottomRows(goals) =
            rows.byLogDepth * (step.unknowns.slopes(x).cwiseQuotient(m_depths.slopes(x))).asDiagonal();
        r.tail(goals) = rows.residuals;
    }
    const double most = m_depths.count() > 0 ? j.colwise().squaredNorm().maxCoeff() : 0;
    const Vector y = step.unknowns.from(x);
    const auto [lowest, highest] = step.unknowns.stepsFrom(y, step.reach);
    const Vector p = leastSquaresStep(j, r, lowest, highest, std::max(step.damping * most, 1e-200));
    return step.unknowns.opacities(y + p, x);
}

/// Steps of one batch, the boldest first; those whose residuals, as the derivatives foretell them, differ by less than
/// a twentieth of what they are here count as one.
std::vector<NewtonSearch::Point> NewtonSearch::candidates(const Linear& at, const GoalRows& rows,
                                                          double caution) const {
    const Point& x = at.place.state.opacity;
    const double here = at.place.state.objective * at.place.state.objective + rows.residuals.squaredNorm();
    const auto same = [&](const Point& a, const Point& b) {
        const Vector byDepth = m_depths.from(a) - m_depths.from(b);
        const double goals = rows.residuals.size() > 0 ? (rows.byLogDepth * byDepth).squaredNorm() : 0;
        for (const LogDepths* unknowns : {&m_depths, &m_opacities}) {
            const Vector change = unknowns->derivatives(at.derivative, x) * (unknowns->from(a) - unknowns->from(b));
            if (change.squaredNorm() / static_cast<double>(change.size()) + goals > 0.05 * 0.05 * here) return false;
        }
        return true;
    };
    std::vector<Point> points;
    for (const auto& [damping, reach] : {std::pair{1e-7, 4.0}, {1e-3, 2.0}, {3e-2, 1.0}, {0.3, 0.4}})
        for (const LogDepths* unknowns : {&m_depths, &m_opacities})
            for (const Residual residual : {Residual::Ratio, Residual::Difference}) {
                const Point next = stepped(at, rows, {*unknowns, residual, damping / caution, reach * caution});
                if (points.size() < kBatch && next != x &&
                    std::ranges::none_of(points, [&](const Point& p) { return same(p, next); }))
                    points.push_back(next);
            }
    // What a straight line over- or undershoots: lanes that are left cost nothing.
    const std::size_t whole = points.size();
    const Vector y = m_depths.from(x);
    for (const double part : {0.85, 1.15, 0.7, 1.3})
        for (std::size_t p = 0; p < whole && points.size() < kBatch; ++p)
            points.push_back(m_depths.opacities(y + part * (m_depths.from(points[p]) - y), x));
    return points;
}

/// Whether one of the points leaves no more than `part` of the distance from the wanted strength: rays alone tell, and
/// no sweep need be spent on points that do not.
bool NewtonSearch::strengthens(const Place& at, const std::vector<Point>& points, double part) const {
    std::vector<Point> all{at.state.opacity};
    all.insert(all.end(), points.begin(), points.end());
    const std::vector<Coverage> looks = m_goal->looks(all, PictureGoal::Rays::Some);
    const double here = m_goal->miss(looks[0]);
    return std::any_of(looks.begin() + 1, looks.end(),
                       [&](const Coverage& look) { return m_goal->miss(look) <= part * here; });
}

/// Downhill on the level of `at`, until it is there if that goes. `borrowed`: the derivatives are those of a rougher
/// estimate, which will do for as long as they bring F down fast; what is seen on the way mends them.
NewtonSearch::Place NewtonSearch::descend(Linear at, const Weights& weights, bool borrowed) {
    constexpr int kFailures = 3, kSlowMoves = 4;
    constexpr double kStronger = 0.85; // of the distance from the wanted strength that a move leaves which is for that
    constexpr double kSlow = 0.96;     // of the score that a move leaves
    constexpr double kFast = 0.1;      // likewise
    const auto level = static_cast<std::size_t>(at.place.state.level);
    double caution = 1;
    int failures = 0, slow = 0;
    double miss = std::numeric_limits<double>::infinity(); // where shares were met before
    bool known = true;                                     // the derivatives at at.place
    while (!isThere(at.place, weights) && mayMove(level) && failures < kFailures && slow < kSlowMoves) {
        if (isThere(at.place, {weights.floor, 0})) {
            if (level == 0 && m_levels.size() > 1) break; // the strength has been seen to along the rays
            if (at.place.miss > kStronger * miss) break;
            miss = at.place.miss;
        }
        m_job.throwIfStopped();
        if (!known) at = linearize(level, at.place.state.opacity);
        known = true;
        const std::vector<Point> points = candidates(at, goalRows(at.place, weights), caution);
        if (points.empty() && borrowed) {
            known = borrowed = false;
            continue;
        }
        if (points.empty()) break;
        if (isThere(at.place, {weights.floor, 0}) && !strengthens(at.place, points, kStronger)) break;
        std::vector<Place> places = evaluate(level, points);
        const Place best = bestIn(places, weights);
        if (!isBetter(best, at.place, weights)) {
            if (borrowed) {
                known = borrowed = false;
                continue;
            }
            caution /= 10;
            ++failures;
            continue;
        }
        const double left = score(best, weights) / score(at.place, weights);
        borrowed = borrowed && left < kFast;
        slow = left > kSlow ? slow + 1 : 0;
        failures = 0;
        caution = std::min(1.0, caution * 3);
        if (borrowed) {
            places.push_back(at.place);
            mendBySeen(at.derivative, best, places);
        }
        at.place = best;
        known = borrowed;
        arrive(at.place.state);
    }
    return at.place;
}

/// Weights of the descents one after the other: first all count alike, so that the way is short; then what cannot be
/// had besides the shares weighs ever less, and the floors ever more.
std::vector<NewtonSearch::Weights> NewtonSearch::phases(bool floors) const {
    if (!m_goal) return {{}};
    if (floors) return {{1, 0.05}, {10, 0.005}, {30, 5e-4}};
    return {{0, 0.05}, {0, 0.005}, {0, 5e-4}};
}

/// Where a feature has become solid its derivatives are tiny, and it stays so. In a faint picture shares go with
/// opacities, and the way from there to a stronger one is short.
std::vector<NewtonSearch::Point> NewtonSearch::startsFor(const Point& x) const {
    constexpr double kFainter = 0.3;
    if (!m_goal) return {x};
    return {atStrength(x, 1), atStrength(x, kFainter)};
}

/// The best of `starts`, followed downhill by the roughest estimate and from there by finer ones, but for the volume.
NewtonSearch::Place NewtonSearch::byEstimates(const std::vector<Point>& starts, bool floors) {
    const std::vector<Weights> weights = phases(floors);
    const auto better = [&](const Place& a, const Place& b) { return rank(a, floors) < rank(b, floors); };
    const auto down = [&](Linear at, bool borrowed) {
        for (std::size_t i = 0; i < weights.size(); ++i) {
            m_coarseMoves = 0;
            if (i > 0) at = linearize(static_cast<std::size_t>(at.place.state.level), at.place.state.opacity);
            at.place = descend(at, weights[i], borrowed && i == 0);
            if (isThere(at.place, {weights[i].floor, 0})) break;
        }
        return at.place;
    };
    std::size_t level = m_levels.size() - 1;
    std::vector<Place> ends;
    for (const Point& x : starts) {
        ends.push_back(down(linearize(level, x), false));
        if (isThere(ends.back(), weights[0])) break;
    }
    Place best = *std::ranges::min_element(ends, better);
    if (!isThere(best, {weights.back().floor, 0}) && m_options.restarts)
        for (const Place& p : spread(level, best.state.opacity, weights[0]))
            if (Place end = down(linearize(level, p.state.opacity), false); better(end, best)) best = std::move(end);
    while (--level > 0) {
        // W differs little from one level to the next, and its derivatives do, too: those of the rougher one are
        // cheaper.
        Linear at = linearize(level + 1, best.state.opacity);
        std::vector<Point> points{best.state.opacity};
        for (const Point& x : starts) points.push_back(x);
        std::vector<Place> here = evaluate(level, points);
        at.place = here[0];
        arrive(at.place.state);
        // What does not hold there was no hint.
        const auto first = std::ranges::min_element(here, better);
        best = first == here.begin() ? down(std::move(at), true) : down(linearize(level, first->state.opacity), false);
    }
    return best;
}

/// Starts spread over all opacities: the best few of them, on a level.
std::vector<NewtonSearch::Place> NewtonSearch::spread(std::size_t level, const Point& best, const Weights& weights) {
    const Vector least = m_depths.clamped(Vector::Constant(m_depths.count(), std::log(kLeastSpread)));
    const Vector most = m_depths.highest().cwiseMin(std::log(kMostSpread)).cwiseMax(least);
    std::vector<Place> places;
    for (int first = 0; first < kSpread; first += static_cast<int>(kBatch)) {
        std::vector<Point> points;
        for (int p = first; p < first + static_cast<int>(kBatch); ++p) {
            Vector y = least;
            for (Eigen::Index i = 0; i < y.size(); ++i)
                y[i] += (most[i] - least[i]) * halton(p + 1, kPrimes[m_depths.features()[i] % std::size(kPrimes)]);
            points.push_back(m_depths.opacities(y, best));
        }
        for (Place& place : evaluate(level, points)) places.push_back(std::move(place));
    }
    m_spreadStarts += kSpread;
    std::ranges::stable_sort(places, [&](const auto& a, const auto& b) { return isBetter(a, b, weights); });
    places.resize(std::min(places.size(), kRefined));
    return places;
}

/// From where the estimates end to the volume. One batch looks there at the start, if that is not known yet, at that
/// end, and as far as lanes are left at what each opacity changes there: these derivatives, or those of the estimate,
/// will do for as long as moves bring F down fast.
void NewtonSearch::refine(const Place& from, const Point& start, bool floors) {
    const Weights weights = m_goal ? Weights{floors ? 30.0 : 0.0, 2e-3} : Weights{};
    Linear at = linearize(1, from.state.opacity);
    std::vector<Point> points;
    const bool first = m_places.empty();
    if (first) points.push_back(start);
    points.push_back(from.state.opacity);
    const std::size_t base = points.size() - 1;
    const std::vector<std::size_t>& free = m_depths.features();
    const bool differs = points.size() + free.size() <= kBatch;
    const Vector y = m_depths.from(from.state.opacity);
    for (Eigen::Index i = 0; differs && i < y.size(); ++i) {
        Vector moved = y;
        moved[i] += y[i] + kShareStep <= m_depths.highest()[i] ? kShareStep : -kShareStep;
        points.push_back(m_depths.opacities(m_depths.clamped(moved), from.state.opacity));
    }
    std::vector<Place> places = evaluate(0, points);
    if (first) {
        begin();
        m_job.throwIfStopped();
        if (isGood(this->start())) return;
        places.erase(places.begin());
    }
    const Place& best = bestIn(places, weights);
    if (differs) {
        const OptimizeState& here = places[base - (first ? 1 : 0)].state;
        for (std::size_t k = 0; k < free.size(); ++k) {
            const OptimizeState& moved = places[base + 1 - (first ? 1 : 0) + k].state;
            const double change = moved.opacity[free[k]] - here.opacity[free[k]];
            if (change != 0) at.derivative.col(free[k]) = (vectorOf(moved.vws) - vectorOf(here.vws)) / change;
        }
    } else {
        mendBySeen(at.derivative, best, places);
    }
    at.place = best;
    arrive(at.place.state);
    if (!isBetter(at.place, this->start(), weights)) return; // a hint that does not hold on the volume
    descend(std::move(at), weights, true);
}

/// The start is known: what had to wait for it goes into the history behind it.
void NewtonSearch::begin() {
    const bool isThere = isGood(start());
    m_arrive(start().state);
    for (const OptimizeState& state : m_waiting) {
        m_job.throwIfStopped();
        if (!isThere) m_arrive(state); // else nothing needs a hint
    }
    m_waiting.clear();
}

void NewtonSearch::toShares(const std::vector<Point>& starts) {
    const Point& start = starts.front();
    const Point x = m_depths.inside(start);
    const bool coarse = m_levels.size() > 1;
    const auto done = [&] { return bestOf(false).state.objective < m_goalDistance || !mayMove(0); };
    const auto down = [&](Linear at) {
        const std::vector<Weights> all = phases(false);
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (i > 0) at = linearize(0, at.place.state.opacity);
            at.place = descend(at, all[i]);
            if (at.place.state.objective < m_goalDistance || !mayMove(0)) return;
        }
    };
    const bool known = !m_places.empty(); // the start, by look()
    std::optional<Linear> first;
    if (coarse && mayMove(0)) {
        refine(byEstimates(startsFor(x), false), start, false);
    } else if (x == start && mayMove(0)) { // the first move is one on the volume, and needs the derivatives there
        first = linearize(0, x);
        if (!known) begin();
    } else if (!known) {
        evaluate(0, {start});
        begin();
    }
    if (starts.size() > 1) evaluate(0, {starts.begin() + 1, starts.end()});
    if (isGood(this->start()) || !mayMove(0)) return;
    if (coarse && done()) return;
    if (!first) {
        first = linearize(0, coarse ? x : atStrength(x, 1));
        arrive(first->place.state);
    }
    down(std::move(*first));
    const auto isStrong = [&] { return bestOf(false).miss < kFarStrength; };
    if (m_goal && !coarse && done() && !isStrong() && mayMove(0)) down(linearize(0, startsFor(x).back()));
    for (std::size_t i = 1; i < starts.size() && !done(); ++i) down(linearize(0, starts[i]));
    if (done() || !m_options.restarts) return;
    for (const Place& p : spread(coarse ? 1 : 0, bestOf(false).state.opacity, {})) {
        if (done()) return;
        down(linearize(0, p.state.opacity));
    }
}

void NewtonSearch::look(const OptimizeState& state) {
    Coverage look;
    if (m_goal) look = m_goal->looks({state.opacity})[0];
    m_places.push_back(placeOf(state.vws, state.opacity, 0, std::move(look)));
}

void NewtonSearch::follow(const Point& start) {
    evaluate(0, {start});
    begin();
    if (isGood(this->start()) && this->start().lack <= kShownLack) return;
    Point x = m_depths.inside(start);
    for (const Weights& weights : phases(true)) {
        if (!mayMove(0)) return;
        const Place end = descend(linearize(0, x), weights);
        if (isThere(end, {weights.floor, 0})) return;
        x = end.state.opacity;
    }
}

void NewtonSearch::toFloors(const std::vector<Point>& starts) {
    if (!m_goal || !mayMove(0)) return;
    std::vector<Point> from;
    for (const Point& x : starts) from.push_back(atStrength(m_depths.inside(x), 1));
    if (m_levels.size() > 1) {
        m_forFloors = true;
        refine(byEstimates(from, true), starts.front(), true);
        if (bestOf(true).lack <= kShownLack) return;
    }
    const std::vector<Weights> weights = phases(true);
    Place best = bestIn(evaluate(0, from), weights.front());
    for (const Weights& w : weights) {
        if (!mayMove(0)) return;
        best = descend(linearize(0, best.state.opacity), w);
    }
}

} // namespace pellucid
