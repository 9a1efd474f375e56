#include "optimize/refine.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pellucid {

namespace {

/// −p ln p of each bin: significance per unit of opacity (3.2).
std::vector<double> informationOf(const Histogram& histogram) {
    std::vector<double> g;
    for (std::size_t b = 0; b < histogram.counts.size(); ++b) {
        const double p = histogram.p(b);
        g.push_back(p > 0 ? -p * std::log(p) : 0.0);
    }
    return g;
}

/// e(i) is linear in the opacities at its two ends: e = left·α_i + right·α_{i+1}.
struct EdgeCoefficients {
    double left = 0, right = 0;
};

/// Exact integrals of the two hat functions over [x0, x1] against the piecewise constant g.
EdgeCoefficients coefficients(const std::vector<double>& g, double x0, double x1) {
    EdgeCoefficients e;
    if (!(x1 > x0)) return e;
    const int bins = static_cast<int>(g.size());
    for (int b = histogramBin(x0, bins); b < bins && static_cast<double>(b) / bins < x1; ++b) {
        const double lo = std::max(x0, static_cast<double>(b) / bins), hi = std::min(x1, (b + 1.0) / bins);
        if (!(hi > lo)) continue;
        const double whole = g[static_cast<std::size_t>(b)] * (hi - lo);
        const double right = whole * ((lo + hi) / 2 - x0) / (x1 - x0); // the mean of a linear function is its midpoint
        e.right += right;
        e.left += whole - right;
    }
    return e;
}

double energyOver(const std::vector<double>& edges, const std::vector<std::size_t>& which) {
    if (which.empty()) return 0;
    double mean = 0, energy = 0;
    for (const std::size_t i : which) mean += edges[i];
    mean /= static_cast<double>(which.size());
    for (const std::size_t i : which) energy += (edges[i] - mean) * (edges[i] - mean);
    return energy;
}

/// The polyline of a transfer function with everything that greedy steps ask for.
class Polyline {
public:
    Polyline(const Histogram& histogram, const TransferFunction& tf) : points(tf.pointsWithEnds()) {
        const auto g = informationOf(histogram);
        for (const ControlPoint& p : points)
            m_information.push_back(g[static_cast<std::size_t>(histogramBin(p.x, static_cast<int>(g.size())))]);
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            m_coefficients.push_back(coefficients(g, points[i].x, points[i + 1].x));
            edges.push_back(0);
            updateEdge(i);
            if (!points[i].fixed || !points[i + 1].fixed) participating.push_back(i);
        }
    }

    double significance(std::size_t point) const { return points[point].opacity * m_information[point]; }

    void move(std::size_t point, double by) {
        points[point].opacity = std::clamp(points[point].opacity + by, 0.0, 1.0);
        if (point > 0) updateEdge(point - 1);
        if (point < edges.size()) updateEdge(point);
    }

    /// The end of an edge that a step moves: the one of larger (or smaller) significance, of equals the lower one; a
    /// fixed end gives way to the other.
    std::size_t endToMove(std::size_t edge, bool larger) const {
        const std::size_t a = edge, b = edge + 1;
        if (points[a].fixed) return b;
        if (points[b].fixed) return a;
        const double sa = significance(a), sb = significance(b);
        return (larger ? sb > sa : sb < sa) ? b : a;
    }

    std::vector<ControlPoint> points;
    std::vector<double> edges;
    std::vector<std::size_t> participating; ///< edges with a movable end

private:
    void updateEdge(std::size_t i) {
        edges[i] = m_coefficients[i].left * points[i].opacity + m_coefficients[i].right * points[i + 1].opacity;
    }
    std::vector<double> m_information;
    std::vector<EdgeCoefficients> m_coefficients;
};

constexpr double kLargestStepRatio =
    16; ///< of a derived step_up to step_down, where the raised end weighs next to nothing

double stepUp(const RefineOptions& options, double loweredSignificance, double raisedSignificance) {
    if (options.stepUp) return *options.stepUp;
    const double ratio = raisedSignificance > 0 ? loweredSignificance / raisedSignificance : kLargestStepRatio;
    return options.stepDown * std::min(ratio, kLargestStepRatio);
}

} // namespace

void RefineOptions::validate() const {
    if (!(stepDown > 0 && stepDown <= 1))
        throw UsageError("the step down lies in (0,1]", "refine", "correct the step");
    if (stepUp && !(*stepUp > 0 && *stepUp <= 1))
        throw UsageError("the step up lies in (0,1]", "refine", "correct the step");
    if (maxIterations < 0)
        throw UsageError("the number of iterations is not negative", "refine", "correct it");
}

std::vector<double> edgeWeights(const Histogram& histogram, const TransferFunction& tf) {
    return Polyline(histogram, tf).edges;
}

double edgeEnergy(const std::vector<double>& edges) {
    std::vector<std::size_t> all(edges.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    return energyOver(edges, all);
}

RefineResult refine(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options,
                    const JobControl& job) {
    options.validate();
    Polyline line(histogram, tf);
    const auto& which = line.participating;

    RefineResult result;
    result.tf = tf;
    result.edgesBefore = result.edgesAfter = line.edges;
    result.energyBefore = result.energyAfter = edgeEnergy(line.edges);
    result.energyMovableBefore = result.energyMovableAfter = energyOver(line.edges, which);
    std::vector<ControlPoint> best = line.points;

    const int patience = 2 * static_cast<int>(line.edges.size());
    int sinceBest = 0;
    while (!which.empty() && result.iterations < options.maxIterations && sinceBest < patience) {
        job.throwIfStopped();
        const auto lighter = [&](std::size_t a, std::size_t b) { return line.edges[a] < line.edges[b]; };
        // Of equal edges the lower index: max_element and min_element both keep the first.
        const std::size_t heaviest = *std::max_element(which.begin(), which.end(), lighter);
        const std::size_t lightest = *std::min_element(which.begin(), which.end(), lighter);
        const std::size_t down = line.endToMove(heaviest, true), up = line.endToMove(lightest, false);
        const double rise = stepUp(options, line.significance(down), line.significance(up));
        line.move(down, -options.stepDown);
        line.move(up, rise);
        ++result.iterations;
        ++sinceBest;
        const double energy = energyOver(line.edges, which);
        if (energy < result.energyMovableAfter) {
            result.energyMovableAfter = energy;
            result.edgesAfter = line.edges;
            best = line.points;
            sinceBest = 0;
        }
    }

    result.energyAfter = edgeEnergy(result.edgesAfter);
    const std::size_t firstOwn =
        best.size() > tf.points.size() && (tf.points.empty() || tf.points.front().x > 0) ? 1 : 0;
    for (std::size_t i = 0; i < tf.points.size(); ++i) result.tf.points[i].opacity = best[i + firstOwn].opacity;
    return result;
}

} // namespace pellucid
