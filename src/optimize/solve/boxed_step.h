// The minimum of a convex quadratic function within bounds: the step of every search here.
#pragma once

#include "base/job.h"
#include "optimize/solve/matrix.h"

namespace pellucid {

enum class Sum { Free, Kept };

/// The p with lowest ≤ p ≤ highest, and Σ p = 0 where the sum is kept, that minimises ½·pᵀAp + gᵀp, by active sets. A
/// is n×n, symmetric and positive definite; every range holds 0. Exact but for rounding, O(n³) for each bound that is
/// met or left. `systems`: adds how many linear systems that took. Throws Cancelled.
Vector boxedStep(const Matrix& a, const Vector& g, const Vector& lowest, const Vector& highest, Sum sum = Sum::Free,
                 const JobControl& job = {}, int* systems = nullptr);

/// The d with lowest ≤ d ≤ highest that minimises |r + J d|² + ridge·|d|², ridge > 0; every range holds 0.
Vector leastSquaresStep(const Matrix& jacobian, const Vector& residual, const Vector& lowest, const Vector& highest,
                        double ridge);

} // namespace pellucid
