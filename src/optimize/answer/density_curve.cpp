#include "optimize/answer/density_curve.h"

#include <algorithm>
#include <cmath>

#include "optimize/solve/boxed_step.h"
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
constexpr double kSolid = 0.999; // as good as 1: ln τ goes on from here without that anything changes

/// A place on the way, as the function that is followed has it.
struct Place {
    Vector y;
    Matrix derivative; ///< of W with respect to y
    double coverage = 0;
};

std::vector<OpacityLimits> belowSolid(std::vector<OpacityLimits> limits, std::size_t features) {
    limits.resize(features);
    for (OpacityLimits& limit : limits) limit.highest = std::max(limit.lowest, std::min(limit.highest, kSolid));
    return limits;
}

double largestOf(const Vector& v) { return v.size() == 0 ? 0 : v.lpNorm<Eigen::Infinity>(); }

class Tracer {
public:
    Tracer(const DensityProblem& problem, const std::vector<double>& start, const JobControl& job)
        : m_problem(problem), m_along(problem.coarse ? *problem.coarse : problem.full),
          m_start(within(belowSolid(problem.limits, start.size()), start)),
          m_depths(belowSolid(problem.limits, start.size()), m_start),
          m_drawn(drawnFeatures(withFeatureOpacities(problem.full.base(), start))), m_job(job) {}

    const std::vector<char>& drawn() const { return m_drawn; }
    std::vector<double> opacities(const Vector& y) const { return m_depths.opacities(y, m_start); }
    int evaluations = 0;

    std::vector<double> coveragesAt(const std::vector<Vector>& places) const {
        std::vector<TransferFunction> tfs;
        for (const Vector& y : places) tfs.push_back(withFeatureOpacities(m_problem.full.base(), opacities(y)));
        std::vector<double> coverages;
        for (const auto& a : m_problem.rays.appearances(tfs, m_drawn)) coverages.push_back(a.alpha);
        return coverages;
    }

    /// Both ways from the start, coverage ascending. `least`: of coverage, as a part of the largest.
    std::vector<Place> trace(double least) {
        Place start{m_depths.from(m_start), {}, 0}; // later the strongest of a way
        start.coverage = coveragesAt({start.y})[0];
        if (m_depths.count() == 0 || m_problem.rays.rays() == 0) return {start};
        m_shares = lookAt(start);
        Vector up = Vector::Ones(m_depths.count());
        if (const Vector v = onCurve(start, up, false); largestOf(v) > kFreedom) up = v / largestOf(v);
        if (const auto c = coveragesAt({start.y + 0.1 * up, start.y - 0.1 * up}); c[0] < c[1]) up = -up;
        const Vector down = -up;
        std::vector<Place> stronger = follow(start, up, kPast), fainter;
        const auto most = [&] {
            const auto at = std::ranges::max_element(stronger, weaker);
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
                    const auto top = std::ranges::max_element(fainter, weaker);
                    if (top->coverage > start.coverage) {
                        start = *top;
                        fainter.erase(fainter.begin(), top + 1);
                    }
                }
        }
        std::vector<Place> path(fainter.rbegin(), fainter.rend());
        path.push_back(start);
        const auto strongest = std::ranges::max_element(stronger, weaker);
        if (strongest != stronger.end() && strongest->coverage > start.coverage)
            path.insert(path.end(), stronger.begin(), strongest + 1);
        return ascending(std::move(path), start.coverage);
    }

    /// The step from a place of shares `vws` to `wanted`.
    Vector correction(const Place& place, const std::vector<double>& vws, const std::vector<double>& wanted) const {
        const auto [lowest, highest] = m_depths.stepsFrom(place.y, kMostCorrection);
        return leastSquaresStep(place.derivative, vectorOf(vws) - vectorOf(wanted), lowest, highest, kRidge);
    }

    Vector clamped(const Vector& y) const { return m_depths.clamped(y); }

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

    /// W at the place, whose derivatives it fills in.
    std::vector<double> lookAt(Place& place) {
        m_job.throwIfStopped();
        const std::vector<double> x = opacities(place.y);
        VwsFunction::Linear linear = m_along.jacobian(x, {m_job.stop, {}});
        ++evaluations;
        m_job.report(1 - 1.0 / (1 + evaluations / 8.0));
        place.derivative = m_depths.derivatives(matrixOf(linear.derivative), x);
        return std::move(linear.vws);
    }

    /// What is left of `direction` where no W may change, nor, where `bounded`, an unknown leave its bounds.
    Vector onCurve(const Place& place, const Vector& direction, bool bounded) const {
        constexpr double kAny = 1e9;
        Vector lowest = Vector::Constant(direction.size(), -kAny), highest = -lowest;
        for (Eigen::Index i = 0; bounded && i < direction.size(); ++i) {
            if (place.y[i] >= m_depths.highest()[i] - 1e-9) highest[i] = 0;
            if (place.y[i] <= m_depths.lowest()[i] + 1e-9) lowest[i] = 0;
        }
        Matrix a = place.derivative.transpose() * place.derivative;
        a.diagonal().array() += kRidge;
        return boxedStep(a, -kRidge * direction, lowest, highest);
    }

    /// Ends where a bound leaves no way on, or the coverage is `past` of the largest; upwards also where it stays.
    std::vector<Place> follow(const Place& start, Vector direction, double past) {
        std::vector<Place> path;
        Place place = start;
        double step = kFirstStep, best = start.coverage;
        int still = 0;
        for (int n = 0; n < kMostSteps; ++n) {
            Vector v = onCurve(place, direction, true);
            const double length = largestOf(v);
            if (length < kFreedom) break;
            double reach = step;
            v /= length;
            for (Eigen::Index i = 0; i < v.size(); ++i) {
                if (v[i] > 0) reach = std::min(reach, (m_depths.highest()[i] - place.y[i]) / v[i]);
                if (v[i] < 0) reach = std::min(reach, (m_depths.lowest()[i] - place.y[i]) / v[i]);
            }
            Place next{m_depths.clamped(place.y + reach * v), {}, 0};
            const std::vector<double> vws = lookAt(next);
            const double off = objectiveOf(vws, m_shares);
            if (off > kOff) {
                if (reach < kShortest) break;
                step = reach / 2;
                continue;
            }
            next.y = m_depths.clamped(next.y + correction(next, vws, m_shares));
            next.coverage = coveragesAt({next.y})[0];
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

    const DensityProblem& m_problem;
    const VwsFunction& m_along;
    const std::vector<double> m_start; ///< within limits
    const LogDepths m_depths;
    const std::vector<char> m_drawn; ///< features that the coverage is of
    const JobControl& m_job;
    std::vector<double> m_shares;
};

Place between(const Place& a, const Place& b, double t) {
    Place p = a;
    p.coverage += t * (b.coverage - a.coverage);
    p.y += t * (b.y - a.y);
    p.derivative += t * (b.derivative - a.derivative);
    return p;
}

double distance(const Place& a, const Place& b) {
    return std::max(largestOf(a.y - b.y), std::abs(std::log(std::max(b.coverage, 1e-9) / std::max(a.coverage, 1e-9))));
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
    const LogDepths depths(belowSolid({}, opacity.size()), points.front().opacity);
    const Vector y = depths.from(opacity);
    Nearest best{faintest().coverage.coverage, 1e9};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const DensityPoint &a = points[i == 0 ? 0 : i - 1], &b = points[i];
        const Vector from = depths.from(a.opacity), way = depths.from(b.opacity) - from, offset = y - from;
        const double square = way.squaredNorm();
        const double t = square > 0 ? std::clamp(offset.dot(way) / square, 0.0, 1.0) : 0;
        const double distance = largestOf(offset - t * way);
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
                candidates.push_back(tracer.opacities(places[p].y));
            }
        if (open.empty()) break;
        if (curve.shares.empty()) candidates.push_back(start);
        const auto found = problem.full.evaluate(candidates, {job.stop, {}});
        curve.evaluations += static_cast<int>(candidates.size());
        if (curve.shares.empty()) curve.shares = found.back();
        for (std::size_t n = 0; n < open.size(); ++n) {
            Place& p = places[open[n]];
            vws[open[n]] = found[n];
            if (round == kCorrections || p.derivative.size() == 0 || objectiveOf(found[n], curve.shares) < kHeld)
                continue;
            const Vector d = tracer.correction(p, found[n], curve.shares);
            if (largestOf(d) < 1e-9) continue;
            p.y = tracer.clamped(p.y + d);
            vws[open[n]].clear();
        }
    }

    std::vector<TransferFunction> tfs;
    for (const Place& p : places) tfs.push_back(withFeatureOpacities(problem.full.base(), tracer.opacities(p.y)));
    const std::vector<Coverage> coverages = coverageOf(problem.rays, tfs, tracer.drawn());
    std::vector<DensityPoint> all;
    std::size_t best = 0;
    for (std::size_t p = 0; p < places.size(); ++p) {
        all.push_back({tracer.opacities(places[p].y), vws[p], objectiveOf(vws[p], curve.shares), coverages[p]});
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
