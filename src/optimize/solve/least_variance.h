// A convex quadratic program: numbers as even as bounds and a constant sum of the variables allow (docs/method.md,
// "Entropy refinement").
#pragma once

#include "base/job.h"
#include "optimize/solve/matrix.h"

namespace pellucid {

/// Minimises Σ (e_i − ē)², e = A x + b, subject to lowest ≤ x ≤ highest, both within [0,1], and Σ x = total.
struct LeastVariance {
    Matrix rows;      ///< A, a row per e_i, a column per variable
    Vector constants; ///< b
    Vector lowest, highest;
    double total = 0; ///< clamped to what the bounds allow
};

struct LeastVarianceAnswer {
    Vector x;
    double energy = 0;
    int steps = 0; ///< linear systems solved
};

/// O(variables³) per step, as many steps as bounds are met and left, about. The answer has no larger energy than
/// `start` (moved to the total). Where many x are equally good it stays near `start`. Throws Cancelled.
LeastVarianceAnswer solve(const LeastVariance& problem, const Vector& start, const JobControl& job = {});

/// The nearest x within the bounds and with Σ x = total (clamped to what is possible).
Vector nearestOfTotal(const Vector& x, double total, const Vector& lowest, const Vector& highest);

} // namespace pellucid
