#include "optimize/refine/refine_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pellucid {

std::vector<double> informationOf(const Histogram& histogram) {
    std::vector<double> g;
    g.reserve(histogram.counts.size());
    for (std::size_t b = 0; b < histogram.counts.size(); ++b) {
        const double p = histogram.p(b);
        g.push_back(p > 0 ? -p * std::log(p) : 0.0);
    }
    return g;
}

EdgeCoefficients edgeCoefficients(const std::vector<double>& information, double x0, double x1, double d0, double d1) {
    EdgeCoefficients e;
    if (!(x1 > x0)) return e;
    const int bins = static_cast<int>(information.size());
    const double perLength = 1 / (x1 - x0);
    // Simpson's rule is exact here: within a bin hat times d is a quadratic.
    double tLo = 0, dLo = d0;
    for (int b = histogramBin(x0, bins); b < bins && tLo < 1; ++b) {
        const double end = (b + 1.0) / bins;
        const double tHi = end < x1 ? (end - x0) * perLength : 1.0;
        const double tMid = (tLo + tHi) / 2;
        const double dMid = d0 + (d1 - d0) * tMid, dHi = d0 + (d1 - d0) * tHi;
        const double scale = information[static_cast<std::size_t>(b)] * (tHi - tLo) / 6;
        e.right += scale * (dLo * tLo + 4 * dMid * tMid + dHi * tHi);
        e.left += scale * (dLo * (1 - tLo) + 4 * dMid * (1 - tMid) + dHi * (1 - tHi));
        tLo = tHi;
        dLo = dHi;
    }
    e.left *= x1 - x0;
    e.right *= x1 - x0;
    return e;
}

double wholeBin(double x, std::size_t bins) {
    constexpr double kRounding = 1e-9; // of a bin
    const double place = x * static_cast<double>(bins - 1), whole = std::round(place);
    return std::abs(place - whole) < kRounding ? whole : place;
}

EdgeCoefficients summedCoefficients(const std::vector<double>& information, double x0, double x1, double d0,
                                    double d1) {
    EdgeCoefficients e;
    const double from = wholeBin(x0, information.size()), to = wholeBin(x1, information.size());
    for (double bin = std::ceil(from); bin < to; ++bin) {
        const double t = (bin - from) / (to - from);
        const double g = information[static_cast<std::size_t>(bin)] * (d0 + (d1 - d0) * t);
        e.left += g * (1 - t);
        e.right += g * t;
    }
    return e;
}

EdgeLine::EdgeLine(const Histogram& histogram, const TransferFunction& tf, const RefinePriority& priority,
                   Profile definitions)
    : profile(definitions), factor(pointFactors(tf, priority, definitions)), information(informationOf(histogram)) {
    const std::vector<ControlPoint> all = tf.pointsWithEnds();
    firstOwn = tf.points.empty() || tf.points.front().x > 0 ? 1 : 0;
    for (const ControlPoint& p : all) {
        x.push_back(p.x);
        opacity.push_back(p.opacity);
        fixed.push_back(p.fixed);
    }
    weigh();
    for (std::size_t i = 0; i < edges(); ++i)
        if ((!fixed[i] || !fixed[i + 1]) && !isSkipped(i)) participating.push_back(i);
}

void EdgeLine::weigh() {
    const bool published = profile == Profile::Published;
    const std::size_t bins = information.size();
    pointInformation.clear();
    for (const double at : x)
        pointInformation.push_back(
            information[published ? static_cast<std::size_t>(wholeBin(at, bins))
                                  : static_cast<std::size_t>(histogramBin(at, static_cast<int>(bins)))]);
    coefficients.clear();
    for (std::size_t i = 0; i + 1 < x.size(); ++i)
        coefficients.push_back(
            (published ? summedCoefficients : edgeCoefficients)(information, x[i], x[i + 1], factor[i], factor[i + 1]));
}

std::vector<double> EdgeLine::weights() const {
    std::vector<double> all(edges());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = coefficients[i].weight(opacity[i], opacity[i + 1]);
    return all;
}

std::vector<double> EdgeLine::participatingWeights() const {
    std::vector<double> some;
    some.reserve(participating.size());
    for (const std::size_t i : participating) some.push_back(coefficients[i].weight(opacity[i], opacity[i + 1]));
    return some;
}

TransferFunction EdgeLine::withOpacities(const TransferFunction& tf) const {
    TransferFunction result = tf;
    for (std::size_t i = 0; i < tf.points.size(); ++i) result.points[i].opacity = opacity[i + firstOwn];
    return result;
}

std::size_t EdgeLine::endToMove(std::size_t edge, bool larger) const {
    const std::size_t a = edge, b = edge + 1;
    if (fixed[a]) return b;
    if (fixed[b]) return a;
    const double sa = significance(a), sb = significance(b);
    return (larger ? sb > sa : sb < sa) ? b : a;
}

double EdgeLine::stepUp(const RefineOptions& options, std::size_t down, std::size_t up) const {
    if (options.stepUp) return *options.stepUp;
    const double lowered = significance(down), raised = significance(up);
    const double ratio = raised > 0 ? lowered / raised : kLargestStepRatio;
    return options.stepDown * std::min(ratio, kLargestStepRatio);
}

double energyOf(std::span<const double> weights) {
    if (weights.empty()) return 0;
    // Four sums side by side: one alone waits for every addition.
    constexpr std::size_t kLanes = 4;
    const std::size_t whole = weights.size() / kLanes * kLanes;
    std::array<double, kLanes> sum{}, energy{};
    for (std::size_t i = 0; i < whole; i += kLanes)
        for (std::size_t l = 0; l < kLanes; ++l) sum[l] += weights[i + l];
    for (std::size_t i = whole; i < weights.size(); ++i) sum[i - whole] += weights[i];
    const double mean = ((sum[0] + sum[1]) + (sum[2] + sum[3])) / static_cast<double>(weights.size());
    const auto square = [mean](double e) { return (e - mean) * (e - mean); };
    for (std::size_t i = 0; i < whole; i += kLanes)
        for (std::size_t l = 0; l < kLanes; ++l) energy[l] += square(weights[i + l]);
    for (std::size_t i = whole; i < weights.size(); ++i) energy[i - whole] += square(weights[i]);
    return (energy[0] + energy[1]) + (energy[2] + energy[3]);
}

void EnergyCurve::add(double energy) {
    if (m_count++ % m_stride != 0) return;
    if (m_values.size() == kMost) {
        for (std::size_t i = 0; 2 * i < kMost; ++i) m_values[i] = m_values[2 * i];
        m_values.resize(kMost / 2);
        m_stride *= 2;
        // The value at hand is the kMost-th of the old stride, which the new one keeps as well.
    }
    m_values.push_back(energy);
}

void EnergyCurve::moveInto(RefineResult& result) {
    result.energyCurve = std::move(m_values);
    result.energyCurveStride = static_cast<int>(m_stride);
}

RefineResult startOf(const EdgeLine& line, const TransferFunction& tf) {
    RefineResult result;
    result.tf = tf;
    result.edgesBefore = line.weights();
    result.energyBefore = edgeEnergy(result.edgesBefore);
    result.energyMovableBefore = result.energyMovableAfter = energyOf(line.participatingWeights());
    result.factors = line.factor;
    return result;
}

void finish(RefineResult& result, const EdgeLine& line, const TransferFunction& tf) {
    result.tf = line.withOpacities(tf);
    result.edgesAfter = line.weights();
    result.energyAfter = edgeEnergy(result.edgesAfter);
    result.energyMovableAfter = energyOf(line.participatingWeights());
}

} // namespace pellucid
