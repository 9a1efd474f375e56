// The minimum of a quadratic function within a box: a step of Newton that stays within bounds.
#pragma once

#include <vector>

namespace pellucid {

/// A symmetric matrix, [row][column].
using Matrix = std::vector<std::vector<double>>;

/// The p with lowest ≤ p ≤ highest that minimises ½·pᵀAp + gᵀp, by active sets. A is n×n, symmetric and positive
/// definite; every range holds 0. Exact but for rounding.
std::vector<double> boxedStep(const Matrix& a, const std::vector<double>& g, const std::vector<double>& lowest,
                              const std::vector<double>& highest);

} // namespace pellucid
