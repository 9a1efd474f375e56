// A convex quadratic program: numbers as even as bounds and a constant sum of the variables allow (docs/method.md,
// "Entropy refinement").
#pragma once

#include <cstddef>
#include <vector>

#include "base/job.h"

namespace pellucid {

/// Minimises Σ (e_i − ē)², e = A x + b, subject to 0 ≤ x ≤ 1 and Σ x = total.
struct LeastVariance {
    std::size_t variables = 0;
    std::vector<std::vector<double>> rows; ///< A, one row of `variables` numbers per e_i
    std::vector<double> constants;         ///< b
    double total = 0;                      ///< clamped to [0, variables]
};

struct LeastVarianceAnswer {
    std::vector<double> x;
    double energy = 0;
    int steps = 0; ///< linear systems solved
    /// Largest violation of the optimality conditions, by the largest element of AᵀA: there is a λ with gradient + λ =
    /// 0 for 0 < x < 1, ≥ 0 where x = 0, ≤ 0 where x = 1. Energies within the least one plus about its square.
    double residual = 0;
};

/// Primal active sets over dense matrices, O(variables³) per step, as many steps as bounds are met and left, about. The
/// answer has no larger energy than `start` (moved to the total). Where many x are equally good it stays near `start`.
/// Throws Cancelled.
LeastVarianceAnswer solve(const LeastVariance& problem, const std::vector<double>& start, const JobControl& job = {});

/// The nearest x with 0 ≤ x ≤ 1 and Σ x = total (clamped to what is possible).
std::vector<double> nearestOfTotal(std::vector<double> x, double total);

} // namespace pellucid
