// A convex quadratic program: numbers as even as bounds and a constant sum of the variables allow (docs/method.md,
// "Entropy refinement").
#pragma once

#include <cstddef>
#include <vector>

#include "base/job.h"

namespace pellucid {

/// Bounds of each variable, 0 ≤ lower ≤ upper ≤ 1; empty: 0 and 1 for all.
struct VariableBounds {
    std::vector<double> lower = {}, upper = {};
    double low(std::size_t v) const { return lower.empty() ? 0 : lower[v]; }
    double high(std::size_t v) const { return upper.empty() ? 1 : upper[v]; }
};

/// Minimises Σ (e_i − ē)², e = A x + b, subject to the bounds of x and Σ x = total.
struct LeastVariance {
    std::size_t variables = 0;
    std::vector<std::vector<double>> rows; ///< A, one row of `variables` numbers per e_i
    std::vector<double> constants;         ///< b
    double total = 0;                      ///< clamped to what the bounds allow
    VariableBounds bounds = {};
};

struct LeastVarianceAnswer {
    std::vector<double> x;
    double energy = 0;
    int steps = 0; ///< linear systems solved
    /// Largest violation of the optimality conditions, by the largest element of AᵀA: there is a λ with gradient + λ =
    /// 0 between the bounds, ≥ 0 at the lower, ≤ 0 at the upper one. Energies within the least one plus about its
    /// square.
    double residual = 0;
};

/// Primal active sets over dense matrices, O(variables³) per step, as many steps as bounds are met and left, about. The
/// answer has no larger energy than `start` (moved to the total). Where many x are equally good it stays near `start`.
/// Throws Cancelled.
LeastVarianceAnswer solve(const LeastVariance& problem, const std::vector<double>& start, const JobControl& job = {});

/// The nearest x within the bounds and with Σ x = total (clamped to what is possible).
std::vector<double> nearestOfTotal(std::vector<double> x, double total, const VariableBounds& bounds = {});

} // namespace pellucid
