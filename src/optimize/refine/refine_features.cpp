#include "optimize/refine/refine_features.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "optimize/refine/refine_edges.h"
#include "optimize/solve/least_variance.h"

namespace pellucid {

namespace {

constexpr double kLeastKept = 0.25; ///< of a feature that gives way to the one that is meant

/// α just below and just above x.
std::pair<double, double> opacitiesAbout(const TransferFunction& tf, double x) {
    const std::vector<ControlPoint> points = tf.pointsWithEnds();
    const auto below = std::ranges::lower_bound(points, x, {}, &ControlPoint::x);
    const double from = below != points.end() && below->x == x ? below->opacity : tf.opacity(x);
    return {from, tf.opacity(x)};
}

/// ∫ over [a, b) of α·d·density, exactly; `factor` has d of pointsWithEnds(), linear in between.
double integral(const std::vector<double>& density, const std::vector<ControlPoint>& points,
                const std::vector<double>& factor, double a, double b) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const ControlPoint &p = points[i], &q = points[i + 1];
        const double lo = std::max(a, p.x), hi = std::min(b, q.x);
        if (!(hi > lo)) continue;
        const double s = (lo - p.x) / (q.x - p.x), t = (hi - p.x) / (q.x - p.x);
        const auto between = [](double from, double to, double at) { return from + (to - from) * at; };
        sum += edgeCoefficients(density, lo, hi, between(factor[i], factor[i + 1], s),
                                between(factor[i], factor[i + 1], t))
                   .weight(between(p.opacity, q.opacity, s), between(p.opacity, q.opacity, t));
    }
    return sum;
}

/// The same for each feature.
std::vector<double> integrals(const std::vector<double>& density, const TransferFunction& tf,
                              const std::vector<double>& factor) {
    const std::vector<ControlPoint> points = tf.pointsWithEnds();
    std::vector<double> all;
    for (const Feature& f : tf.features) all.push_back(integral(density, points, factor, f.a, f.b));
    return all;
}

/// p as a density over [0,1].
std::vector<double> densityOf(const Histogram& histogram) {
    std::vector<double> density;
    for (std::size_t b = 0; b < histogram.counts.size(); ++b)
        density.push_back(histogram.p(b) * static_cast<double>(histogram.counts.size()));
    return density;
}

std::vector<double> ones(const TransferFunction& tf) { return std::vector<double>(tf.pointsWithEnds().size(), 1.0); }

std::size_t indexOfLeast(const std::vector<double>& values) {
    return static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
}

/// The features as the search moves them: parts of Σ α·p.
class Parts {
public:
    explicit Parts(const FeatureLine& line) : m_line(line), m_start(line.peak.size()), m_now(line.peak.size()) {
        for (std::size_t f = 0; f < m_now.size(); ++f) m_start[f] = m_now[f] = line.peak[f] * line.amount[f];
    }
    double room(std::size_t f) const { return m_line.amount[f] - m_now[f]; }
    double spare(std::size_t f) const { return m_now[f] - m_line.lowest(f); }
    double weight(std::size_t f) const { return m_line.weight[f] * m_now[f] / m_line.amount[f]; }
    void add(std::size_t f, double by) { m_now[f] = std::clamp(m_now[f] + by, m_line.lowest(f), m_line.amount[f]); }
    /// Peaks; those that have not moved as they were.
    std::vector<double> peaks() const {
        std::vector<double> peaks = m_line.peak;
        for (std::size_t f = 0; f < peaks.size(); ++f)
            if (m_line.movable[f] && m_now[f] != m_start[f]) peaks[f] = std::min(1.0, m_now[f] / m_line.amount[f]);
        return peaks;
    }

private:
    const FeatureLine& m_line;
    std::vector<double> m_start, m_now;
};

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The greedy search: takes from the heaviest, gives to the lightest, or to what is meant, while that evens weights
/// out.
std::vector<double> greedyPeaks(const FeatureLine& line, const RefineOptions& options, RefineResult& result,
                                EnergyCurve& curve, const JobControl& job) {
    Parts parts(line);
    const double whole = line.movableAmount();
    const auto rise = [&](std::size_t down, std::size_t up) {
        if (options.stepUp) return *options.stepUp / options.stepDown;
        const auto significance = [&](std::size_t f) { return line.information[f] / line.amount[f]; };
        return significance(up) > 0 ? std::min(significance(down) / significance(up), kLargestStepRatio)
                                    : kLargestStepRatio;
    };
    const auto energy = [&] {
        std::vector<double> weights;
        for (std::size_t f = 0; f < line.features(); ++f)
            if (line.movable[f]) weights.push_back(parts.weight(f));
        return energyOf(weights);
    };
    std::vector<double> best = line.peak;
    double bestEnergy = result.energyMovableBefore;
    const int patience = 2 * static_cast<int>(line.features() + 1);
    for (int sinceBest = 0;
         result.iterations < options.maxIterations && !(options.untilStable && sinceBest >= patience);) {
        job.throwIfStopped();
        std::size_t heaviest = kNone, lightest = kNone; // of equals the lower index
        for (std::size_t f = 0; f < line.features(); ++f) {
            if (!line.movable[f]) continue;
            if (f != line.meant && parts.spare(f) > 0 &&
                (heaviest == kNone || parts.weight(f) > parts.weight(heaviest)))
                heaviest = f;
            if ((!line.meant || f == line.meant) && parts.room(f) > 0 &&
                (lightest == kNone || parts.weight(f) < parts.weight(lightest)))
                lightest = f;
        }
        // What is meant stands out, too, where it is opaque and others go on giving way.
        if (heaviest == kNone || heaviest == lightest || (lightest == kNone && !line.meant)) break;
        double taken = std::min(options.stepDown * whole, parts.spare(heaviest));
        if (lightest != kNone) {
            const double ratio = rise(heaviest, lightest);
            if (!line.meant) taken = std::min(taken, parts.room(lightest) / ratio);
            parts.add(lightest, taken * ratio);
        }
        parts.add(heaviest, -taken);
        ++result.iterations;
        ++sinceBest;
        const double now = energy();
        curve.add(now);
        if (now < bestEnergy) {
            bestEnergy = now;
            best = parts.peaks();
            sinceBest = 0;
        }
    }
    return best;
}

/// The least energy at constant Σ α·p.
std::vector<double> exactPeaks(const FeatureLine& line, const RefineOptions& options, RefineResult& result,
                               const JobControl& job) {
    std::vector<std::size_t> movable;
    double largest = 0;
    for (std::size_t f = 0; f < line.features(); ++f)
        if (line.movable[f]) {
            movable.push_back(f);
            largest = std::max(largest, line.amount[f]);
        }
    std::vector<double> peaks = line.peak;
    if (movable.empty()) return peaks;
    const std::size_t n = movable.size();
    Vector start(n);
    LeastVariance problem{Matrix::Zero(n, n), Vector::Zero(n), start, start,
                          options.total.value_or(line.movableAmount()) / largest}; // in parts of `largest`
    for (std::size_t v = 0; v < n; ++v) {
        const std::size_t f = movable[v];
        const double now = line.peak[f] * line.amount[f];
        start[v] = now / largest;
        problem.lowest[v] = line.lowest(f) / largest;
        problem.highest[v] = (line.meant && f != line.meant ? now : line.amount[f]) / largest;
        problem.rows(v, v) = line.weight[f] / line.amount[f] * largest;
    }
    const LeastVarianceAnswer answer = solve(problem, start, job);
    result.iterations = answer.steps;
    for (std::size_t v = 0; v < n; ++v)
        if (answer.x[v] != start[v]) peaks[movable[v]] = std::min(1.0, answer.x[v] * largest / line.amount[movable[v]]);
    return peaks;
}

} // namespace

bool movesFeatures(const TransferFunction& tf, const RefineOptions& options) {
    if (options.profile == Profile::Published) return false;
    if (options.method == RefineMethod::Exact && options.priority.any() && tf.features.size() > 1) return true;
    for (const Feature& f : tf.features)
        for (const Feature& g : tf.features)
            if (f.b == g.a && f.a < g.a) {
                const auto [below, above] = opacitiesAbout(tf, g.a);
                if (below > 0 || above > 0) return true;
            }
    return false;
}

bool isHeld(const TransferFunction& tf, const Feature& feature) {
    return std::ranges::any_of(tf.points, [&](const ControlPoint& p) {
        return p.fixed && p.opacity > 0 && p.x >= feature.a && p.x <= feature.b;
    });
}

std::vector<RefineEdge> refineEdges(const TransferFunction& tf, const RefineOptions& options) {
    std::vector<RefineEdge> edges;
    if (movesFeatures(tf, options)) {
        for (const Feature& f : tf.features) edges.push_back({f.a, f.b, !f.hidden && !isHeld(tf, f)});
        return edges;
    }
    const std::vector<ControlPoint> points = tf.pointsWithEnds();
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        edges.push_back({points[i].x, points[i + 1].x,
                         (!points[i].fixed || !points[i + 1].fixed) &&
                             (options.profile != Profile::Published || points[i].opacity > 0)});
    return edges;
}

std::vector<double> opacityParts(const Histogram& histogram, const TransferFunction& tf) {
    return integrals(densityOf(histogram), tf, ones(tf));
}

std::optional<std::size_t> prioritizedFeature(const Histogram& histogram, const TransferFunction& tf,
                                              const RefinePriority& priority, Profile profile) {
    if (tf.features.empty()) return {};
    std::vector<double> distance;
    if (priority.intensity) {
        const double x = *priority.intensity;
        if (const int holds = featureAt(tf.features, x); holds >= 0) return static_cast<std::size_t>(holds);
        for (const Feature& f : tf.features) distance.push_back(std::max(f.a - x, x - f.b));
    } else if (!priority.region.empty()) {
        const TransferFunction full = withFullPeaks(tf);
        const std::vector<double> density = densityOf(histogram);
        distance = integrals(density, full, pointFactors(full, priority, profile));
        const std::vector<double> amount = integrals(density, full, ones(full));
        for (std::size_t f = 0; f < distance.size(); ++f)
            distance[f] = amount[f] > 0 && !tf.features[f].hidden ? distance[f] / amount[f]
                                                                  : std::numeric_limits<double>::infinity();
    } else {
        return {};
    }
    const std::size_t nearest = indexOfLeast(distance);
    return std::isfinite(distance[nearest]) ? std::optional(nearest) : std::nullopt;
}

TransferFunction withOpacitiesOf(const TransferFunction& tf, const TransferFunction& refined) {
    if (refined.points.size() != tf.points.size()) return withFeatureOpacities(tf, featureOpacities(refined));
    TransferFunction result = tf;
    for (std::size_t i = 0; i < tf.points.size(); ++i) result.points[i].opacity = refined.points[i].opacity;
    return result;
}

FeatureLine::FeatureLine(const Histogram& histogram, const TransferFunction& tf, const RefinePriority& priority)
    : peak(featureOpacities(tf)), meant(prioritizedFeature(histogram, tf, priority)) {
    const TransferFunction full = withFullPeaks(tf);
    const std::vector<double> significance = informationOf(histogram);
    weight = integrals(significance, full, pointFactors(full, priority));
    information = integrals(significance, full, ones(full));
    amount = integrals(densityOf(histogram), full, ones(full));
    for (std::size_t f = 0; f < peak.size(); ++f)
        movable.push_back(amount[f] > 0 && !tf.features[f].hidden && !isHeld(tf, tf.features[f]));
    if (meant) weight[*meant] = 0;
}

std::vector<double> FeatureLine::weights() const {
    std::vector<double> all;
    for (std::size_t f = 0; f < features(); ++f) all.push_back(weight[f] * peak[f]);
    return all;
}

std::vector<double> FeatureLine::movableWeights() const {
    std::vector<double> some;
    for (std::size_t f = 0; f < features(); ++f)
        if (movable[f]) some.push_back(weight[f] * peak[f]);
    return some;
}

double FeatureLine::movableAmount() const {
    double sum = 0;
    for (std::size_t f = 0; f < features(); ++f)
        if (movable[f]) sum += peak[f] * amount[f];
    return sum;
}

double FeatureLine::lowest(std::size_t feature) const {
    if (!meant) return 0;
    return (feature == meant ? 1 : kLeastKept) * peak[feature] * amount[feature];
}

RefineResult refineFeatures(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options,
                            const JobControl& job) {
    FeatureLine line(histogram, tf, options.priority);
    RefineResult result;
    result.tf = tf;
    result.edgesBefore = line.weights();
    result.energyBefore = edgeEnergy(result.edgesBefore);
    result.energyMovableBefore = energyOf(line.movableWeights());
    result.factors = pointFactors(tf, options.priority);
    EnergyCurve curve;
    curve.add(result.energyMovableBefore);
    // What is meant and cannot be moved would only lose by what others do.
    if (!line.meant || line.movable[*line.meant]) {
        const bool exact = options.method == RefineMethod::Exact;
        const std::vector<double> peaks =
            exact ? exactPeaks(line, options, result, job) : greedyPeaks(line, options, result, curve, job);
        if (peaks != line.peak) result.tf = withFeatureOpacities(tf, peaks);
        line.peak = peaks;
        if (exact) curve.add(energyOf(line.movableWeights()));
    }
    result.edgesAfter = line.weights();
    result.energyAfter = edgeEnergy(result.edgesAfter);
    result.energyMovableAfter = energyOf(line.movableWeights());
    curve.moveInto(result);
    return result;
}

} // namespace pellucid
