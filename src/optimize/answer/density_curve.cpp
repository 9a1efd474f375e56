#include "optimize/answer/density_curve.h"

#include <algorithm>
#include <cmath>

#include "optimize/solve/log_depths.h"

namespace pellucid {

namespace {

constexpr double kRidge = 1e-6;    // directions that change no W by as much as 0.001 per factor e are free
constexpr double kFirstStep = 0.5; // of the largest change of ln τ
constexpr double kLongest = 1, kShortest = 1.0 / 32;
constexpr double kOff = 0.02;      // F after a step that is too long
constexpr int kMostSteps = 40;     // to each end
constexpr double kFaintest = 0.1;  // of the largest coverage
constexpr double kFreedom = 0.1;   // of a direction that must be left for the curve to go on
constexpr double kPast = 0.95;     // of the largest coverage: it was the largest
constexpr int kStill = 4;          // steps in a row without growth
constexpr double kGrowth = 1e-3;   // of coverage per factor e of τ, below which it grows no longer
constexpr double kSpacing = 0.35;  // of the curve's points
constexpr double kHeld = 3e-4;     // F at which shares count as held
constexpr double kDropped = 0.008; // F at which they do not
constexpr int kCorrections = 4;
constexpr double kMostCorrection = 0.5;

/// A place on the way, as the function that is followed has it.
struct Place {
    Numbers y;
    Rows derivative; ///< of W with respect to y
    double coverage = 0;
};

Numbers differences(const Numbers& a, const Numbers& b) { return plus(a, -1, b); }

class Tracer {
public:
    Tracer(const DensityProblem& problem, const std::vector<double>& start, const JobControl& job)
        : m_problem(problem), m_along(problem.coarse ? *problem.coarse : problem.full), m_depths(problem.limits, start),
          m_drawn(drawnFeatures(withFeatureOpacities(problem.full.base(), start))), m_job(job) {}

    const LogDepths& depths() const { return m_depths; }
    const std::vector<char>& drawn() const { return m_drawn; }
    int evaluations = 0;

    double coverageAt(const Numbers& y) const { return coveragesAt({y})[0]; }
    std::vector<double> coveragesAt(const std::vector<Numbers>& places) const {
        std::vector<TransferFunction> tfs;
        for (const Numbers& y : places) tfs.push_back(withFeatureOpacities(m_problem.full.base(), m_depths.opacity(y)));
        std::vector<double> coverages;
        for (const auto& a : m_problem.rays.appearances(tfs, m_drawn)) coverages.push_back(a.alpha);
        return coverages;
    }

    /// Both ways from the start, coverage ascending. `least`: of coverage, as a part of the largest.
    std::vector<Place> trace(double least) {
        Place start{m_depths.start(), {}, 0}; // later the strongest of a way
        start.coverage = coverageAt(start.y);
        if (m_depths.count() == 0 || m_problem.rays.rays() == 0) return {start};
        const VwsFunction::Linear linear = at(start.y);
        m_shares = linear.vws;
        start.derivative = m_depths.derivatives(linear.derivative, start.y);
        Numbers up(m_depths.count(), 1.0);
        if (Numbers v = onCurve(start, up, false); largestOf(v) > kFreedom) {
            for (double& x : v) x /= largestOf(v);
            up = v;
        }
        if (const auto c = coveragesAt({plus(start.y, 0.1, up), plus(start.y, -0.1, up)}); c[0] < c[1])
            for (double& x : up) x = -x;
        Numbers down = up;
        for (double& x : down) x = -x;
        std::vector<Place> stronger = follow(start, up, kPast), fainter;
        const auto most = [&] {
            const auto at = std::max_element(stronger.begin(), stronger.end(), weaker);
            return at == stronger.end() ? start.coverage : std::max(start.coverage, at->coverage);
        };
        if (least < 1) {
            fainter = follow(start, down, least);
            // Beyond the largest coverage a curve may go on, denser and fainter: what hides others grows. Where the
            // start lies there the long way down is on the other side.
            const double end = fainter.empty() ? start.coverage : fainter.back().coverage;
            if (end > 2 * least * most() && !stronger.empty() && stronger.back().coverage < most())
                if (std::vector<Place> other = follow(start, up, least);
                    !other.empty() && other.back().coverage < end) {
                    fainter = std::move(other);
                    stronger.clear();
                    const auto top = std::max_element(fainter.begin(), fainter.end(), weaker);
                    if (top->coverage > start.coverage) {
                        start = *top;
                        fainter.erase(fainter.begin(), top + 1);
                    }
                }
        }
        std::vector<Place> path(fainter.rbegin(), fainter.rend());
        path.push_back(start);
        const auto strongest = std::max_element(stronger.begin(), stronger.end(), weaker);
        if (strongest != stronger.end() && strongest->coverage > start.coverage)
            path.insert(path.end(), stronger.begin(), strongest + 1);
        return ascending(std::move(path), start.coverage);
    }

private:
    static bool weaker(const Place& a, const Place& b) { return a.coverage < b.coverage; }

    /// Without what turns back.
    static std::vector<Place> ascending(std::vector<Place> path, double startCoverage) {
        std::vector<Place> kept;
        for (Place& p : path)
            if (kept.empty() || p.coverage > kept.back().coverage + 1e-9)
                kept.push_back(std::move(p));
            else if (p.coverage == startCoverage)
                kept.back() = std::move(p);
        return kept;
    }

    VwsFunction::Linear at(const Numbers& y) {
        m_job.throwIfStopped();
        VwsFunction::Linear linear = m_along.jacobian(m_depths.opacity(y), {m_job.stop, {}});
        ++evaluations;
        m_job.report(1 - 1.0 / (1 + evaluations / 8.0));
        return linear;
    }

    /// What is left of `direction` where no W may change, nor, where `bounded`, an unknown leave its bounds.
    Numbers onCurve(const Place& place, const Numbers& direction, bool bounded) const {
        constexpr double kAny = 1e9;
        Numbers change(place.derivative.size(), 0.0), lowest(direction.size(), -kAny), highest(direction.size(), kAny);
        for (std::size_t r = 0; r < change.size(); ++r)
            for (std::size_t i = 0; i < direction.size(); ++i) change[r] += place.derivative[r][i] * direction[i];
        if (bounded)
            for (std::size_t i = 0; i < direction.size(); ++i) {
                if (place.y[i] >= m_depths.highest()[i] - 1e-9) highest[i] = -direction[i];
                if (place.y[i] <= m_depths.lowest()[i] + 1e-9) lowest[i] = -direction[i];
            }
        return plus(direction, 1, leastSquaresStep(place.derivative, change, lowest, highest, kRidge));
    }

    /// Ends where a bound leaves no way on, or the coverage is `past` of the largest; upwards also where it stays.
    std::vector<Place> follow(const Place& start, Numbers direction, double past) {
        std::vector<Place> path;
        Place place = start;
        double step = kFirstStep, best = start.coverage;
        int still = 0;
        for (int n = 0; n < kMostSteps; ++n) {
            Numbers v = onCurve(place, direction, true);
            const double length = largestOf(v);
            if (length < kFreedom) break;
            double reach = step;
            for (std::size_t i = 0; i < v.size(); ++i) {
                v[i] /= length;
                if (v[i] > 0) reach = std::min(reach, (m_depths.highest()[i] - place.y[i]) / v[i]);
                if (v[i] < 0) reach = std::min(reach, (m_depths.lowest()[i] - place.y[i]) / v[i]);
            }
            const Numbers y = m_depths.clamped(plus(place.y, reach, v));
            const VwsFunction::Linear linear = at(y);
            const Numbers residual = differences(linear.vws, m_shares);
            const double off = objectiveOf(linear.vws, m_shares);
            if (off > kOff) {
                if (reach < kShortest) break;
                step = reach / 2;
                continue;
            }
            Place next{y, m_depths.derivatives(linear.derivative, y), 0};
            next.y = m_depths.clamped(plus(y, 1, correction(next, residual)));
            next.coverage = coverageAt(next.y);
            const double gain = (next.coverage - place.coverage) / std::max(place.coverage, 1e-9);
            place = next;
            direction = v;
            path.push_back(std::move(next));
            best = std::max(best, place.coverage);
            still = std::abs(gain) < kGrowth * reach ? still + 1 : 0;
            if ((past >= kPast && still == kStill) || place.coverage <= past * best) break;
            if (off < kOff / 8) step = std::min(kLongest, 1.5 * step);
        }
        return path;
    }

    Numbers correction(const Place& place, const Numbers& residual) const {
        Numbers lowest, highest;
        for (std::size_t i = 0; i < place.y.size(); ++i) {
            lowest.push_back(std::max(-kMostCorrection, m_depths.lowest()[i] - place.y[i]));
            highest.push_back(std::min(kMostCorrection, m_depths.highest()[i] - place.y[i]));
        }
        return leastSquaresStep(place.derivative, residual, lowest, highest, kRidge);
    }

    const DensityProblem& m_problem;
    const VwsFunction& m_along;
    const LogDepths m_depths;
    const std::vector<char> m_drawn; ///< features that the coverage is of
    const JobControl& m_job;
    Numbers m_shares;
};

Place between(const Place& a, const Place& b, double t) {
    Place p = a;
    p.coverage += t * (b.coverage - a.coverage);
    for (std::size_t i = 0; i < p.y.size(); ++i) p.y[i] += t * (b.y[i] - a.y[i]);
    for (std::size_t r = 0; r < p.derivative.size(); ++r)
        for (std::size_t i = 0; i < p.y.size(); ++i)
            p.derivative[r][i] += t * (b.derivative[r][i] - a.derivative[r][i]);
    return p;
}

double distance(const Place& a, const Place& b) {
    return std::max(largestOf(differences(a.y, b.y)),
                    std::abs(std::log(std::max(b.coverage, 1e-9) / std::max(a.coverage, 1e-9))));
}

/// Evenly along the way, ends included.
std::vector<Place> spread(const std::vector<Place>& path) {
    std::vector<double> lengths{0};
    for (std::size_t i = 1; i < path.size(); ++i) lengths.push_back(lengths.back() + distance(path[i - 1], path[i]));
    if (path.size() < 2) return path;
    // Engines take eight at a time.
    const int count = 8 * std::clamp(static_cast<int>(std::ceil((lengths.back() / kSpacing + 1) / 8)), 1, 4);
    std::vector<Place> places;
    std::size_t segment = 1;
    for (int n = 0; n < count; ++n) {
        const double s = lengths.back() * n / (count - 1);
        while (segment + 1 < path.size() && lengths[segment] < s) ++segment;
        const double width = lengths[segment] - lengths[segment - 1];
        places.push_back(between(path[segment - 1], path[segment],
                                 width > 0 ? std::clamp((s - lengths[segment - 1]) / width, 0.0, 1.0) : 0));
    }
    return places;
}

} // namespace

std::vector<double> DensityCurve::at(double coverage) const {
    if (coverage <= faintest().coverage.coverage) return faintest().opacity;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const DensityPoint &a = points[i - 1], &b = points[i];
        if (coverage > b.coverage.coverage) continue;
        const double low = std::log(a.coverage.coverage);
        const double t = (std::log(coverage) - low) / (std::log(b.coverage.coverage) - low);
        std::vector<double> x;
        for (std::size_t f = 0; f < a.opacity.size(); ++f) {
            // What does not move keeps its bits.
            if (a.opacity[f] == b.opacity[f] || a.opacity[f] <= 0 || b.opacity[f] <= 0) {
                x.push_back(t < 0.5 ? a.opacity[f] : b.opacity[f]);
                continue;
            }
            const double from = logDepthOf(a.opacity[f]), to = logDepthOf(b.opacity[f]);
            x.push_back(opacityOfLogDepth(from + t * (to - from)));
        }
        return x;
    }
    return strongest().opacity;
}

DensityCurve::Nearest DensityCurve::nearest(const std::vector<double>& opacity) const {
    const LogDepths depths({}, points.front().opacity);
    const Numbers y = depths.from(opacity);
    Nearest best{faintest().coverage.coverage, 1e9};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const DensityPoint &a = points[i == 0 ? 0 : i - 1], &b = points[i];
        const Numbers from = depths.from(a.opacity), way = plus(depths.from(b.opacity), -1, from);
        const Numbers offset = plus(y, -1, from);
        double along = 0, square = 0;
        for (std::size_t k = 0; k < y.size(); ++k) {
            along += offset[k] * way[k];
            square += way[k] * way[k];
        }
        const double t = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
        const double distance = largestOf(plus(offset, -t, way));
        if (distance < best.distance)
            best = {a.coverage.coverage * std::pow(b.coverage.coverage / a.coverage.coverage, t), distance};
    }
    // What has no place in ln τ is on the curve or it is not.
    for (std::size_t f = 0; f < opacity.size(); ++f)
        if ((opacity[f] <= 0) != (points.front().opacity[f] <= 0)) best.distance = 1e9;
    return best;
}

DensityCurve densityCurve(const DensityProblem& problem, const std::vector<double>& start,
                          const std::vector<double>& shares, const JobControl& job) {
    Tracer tracer(problem, start, job);
    const LogDepths& depths = tracer.depths();
    std::vector<Place> places = spread(tracer.trace(kFaintest));
    DensityCurve curve;
    curve.evaluations = tracer.evaluations;
    curve.shares = shares;

    // All of them at once on the full volume, with the derivatives that were met on the way.
    std::vector<std::vector<double>> vws(places.size());
    for (int round = 0; round <= kCorrections; ++round) {
        job.throwIfStopped();
        std::vector<std::size_t> open;
        std::vector<std::vector<double>> candidates;
        for (std::size_t p = 0; p < places.size(); ++p)
            if (vws[p].empty()) {
                open.push_back(p);
                candidates.push_back(depths.opacity(places[p].y));
            }
        if (open.empty()) break;
        if (curve.shares.empty()) candidates.push_back(start);
        const auto found = problem.full.evaluate(candidates, {job.stop, {}});
        curve.evaluations += static_cast<int>(candidates.size());
        if (curve.shares.empty()) curve.shares = found.back();
        for (std::size_t n = 0; n < open.size(); ++n) {
            Place& p = places[open[n]];
            vws[open[n]] = found[n];
            if (round == kCorrections || p.derivative.empty() || objectiveOf(found[n], curve.shares) < kHeld) continue;
            Numbers lowest, highest;
            for (std::size_t i = 0; i < p.y.size(); ++i) {
                lowest.push_back(std::max(-kMostCorrection, depths.lowest()[i] - p.y[i]));
                highest.push_back(std::min(kMostCorrection, depths.highest()[i] - p.y[i]));
            }
            const Numbers d =
                leastSquaresStep(p.derivative, differences(found[n], curve.shares), lowest, highest, kRidge);
            if (largestOf(d) < 1e-9) continue;
            p.y = depths.clamped(plus(p.y, 1, d));
            vws[open[n]].clear();
        }
    }

    std::vector<TransferFunction> tfs;
    for (const Place& p : places) tfs.push_back(withFeatureOpacities(problem.full.base(), depths.opacity(p.y)));
    const std::vector<Coverage> coverages = coverageOf(problem.rays, tfs, tracer.drawn());
    std::vector<DensityPoint> all;
    std::size_t best = 0;
    for (std::size_t p = 0; p < places.size(); ++p) {
        all.push_back({depths.opacity(places[p].y), vws[p], objectiveOf(vws[p], curve.shares), coverages[p]});
        if (all[p].objective < all[best].objective) best = p;
    }
    // From the best outwards, as long as shares are held.
    std::size_t first = best, last = best;
    while (first > 0 && all[first - 1].objective < kDropped) --first;
    while (last + 1 < all.size() && all[last + 1].objective < kDropped) ++last;
    for (std::size_t p = first; p <= last; ++p)
        if (curve.points.empty() || all[p].coverage.coverage > curve.points.back().coverage.coverage)
            curve.points.push_back(std::move(all[p]));
    job.report(1);
    return curve;
}

} // namespace pellucid
