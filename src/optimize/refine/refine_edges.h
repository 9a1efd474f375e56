// What greedy, its reference and the exact method share: the edges of a transfer function as numbers.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "optimize/refine/refine.h"

namespace pellucid {

/// Of a derived step up to the step down, where what is raised weighs next to nothing.
inline constexpr double kLargestStepRatio = 16;

/// −p ln p of each bin: significance per unit of opacity (3.2).
std::vector<double> informationOf(const Histogram& histogram);

/// The place of an intensity among whole bins, where the first stands for 0 and the last for 1: value/255 is `value`
/// whatever rounding has made of it.
double wholeBin(double x, std::size_t bins);

/// e(i) is linear in the opacities at its two ends: e = left·α_i + right·α_{i+1}.
struct EdgeCoefficients {
    double left = 0, right = 0;
    double weight(double leftOpacity, double rightOpacity) const { return left * leftOpacity + right * rightOpacity; }
};

/// Exact integrals over [x0, x1] of the two hat functions times d, linear from d0 to d1, times the piecewise constant
/// information.
EdgeCoefficients edgeCoefficients(const std::vector<double>& information, double x0, double x1, double d0, double d1);
/// The same, of the published profile: sums over the whole bins of [x0, x1) in the place of integrals.
EdgeCoefficients summedCoefficients(const std::vector<double>& information, double x0, double x1, double d0, double d1);

/// pointsWithEnds() as arrays, and the edges between them.
struct EdgeLine {
    EdgeLine(const Histogram& histogram, const TransferFunction& tf, const RefinePriority& priority,
             Profile profile = Profile::Default);

    Profile profile;
    std::vector<double> x, opacity, factor;
    std::vector<char> fixed;
    std::vector<double> information;            ///< −p ln p of each bin
    std::vector<double> pointInformation;       ///< −p ln p at each point
    std::vector<EdgeCoefficients> coefficients; ///< one per edge
    std::vector<std::size_t> participating;     ///< edges with a movable end; published: that begin above opacity 0
    std::size_t firstOwn = 0;                   ///< index of the transfer function's first own point

    std::size_t points() const { return x.size(); }
    std::size_t edges() const { return coefficients.size(); }
    double significance(std::size_t point) const { return opacity[point] * pointInformation[point]; }
    /// Whether the greedy choice skips an edge at its present opacities.
    bool isSkipped(std::size_t edge) const { return profile == Profile::Published && !(opacity[edge] > 0); }
    /// Computes `coefficients` and `pointInformation` from `information`.
    void weigh();
    std::vector<double> weights() const;
    std::vector<double> participatingWeights() const;
    TransferFunction withOpacities(const TransferFunction& tf) const; ///< `tf` with these opacities
    /// The end of an edge that a step moves: the one of larger (or smaller) significance, of equals the lower one; a
    /// fixed end gives way to the other.
    std::size_t endToMove(std::size_t edge, bool larger) const;
    /// The step up where `down` has been chosen to be lowered and `up` to be raised.
    double stepUp(const RefineOptions& options, std::size_t down, std::size_t up) const;
};

/// Σ (e − ē)², in an order of its own that is always the same.
double energyOf(std::span<const double> weights);

/// The curve of energies: every value while there is room, then every second one, and so on.
class EnergyCurve {
public:
    void add(double energy);
    void moveInto(RefineResult& result);

private:
    static constexpr std::size_t kMost = 1000;
    std::vector<double> m_values;
    long m_stride = 1, m_count = 0;
};

/// Everything of a result that does not depend on the method; `line` has the start's opacities.
RefineResult startOf(const EdgeLine& line, const TransferFunction& tf);
/// Puts the answer in: `line` has its opacities.
void finish(RefineResult& result, const EdgeLine& line, const TransferFunction& tf);

/// The answer of RefineMethod::Exact.
RefineResult refineExact(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options,
                         const JobControl& job);

} // namespace pellucid
