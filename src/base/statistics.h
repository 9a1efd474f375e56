// How strongly two series of numbers go together.
#pragma once

#include <cstdint>
#include <span>

#include "base/enum_names.h"

namespace pellucid {

enum class CorrelationKind {
    Pearson,  ///< of the numbers themselves: whether they lie on a line
    Spearman, ///< of their ranks, equal ones sharing the mean of theirs: whether one grows with the other
    Kendall   ///< τ-b, of pairs: how many are in the same order, without those that are equal
};
template <>
inline constexpr auto kNamesOf<CorrelationKind> = enumNames("correlation", "pearson", "spearman", "kendall");

struct CorrelationOptions {
    double confidence = 0.95; ///< of the interval, (0, 1)
    int resamples = 2000;     ///< of pairs, with replacement (bootstrap); 0: no interval
    std::uint32_t seed = 1;
};

struct Correlation {
    double value = 0; ///< [−1, 1]; NaN where there are fewer than two pairs, or all numbers of a series are equal
    double p = 1;     ///< two-sided, of no correlation; NaN likewise, and of fewer than three pairs
    double low = 0, high = 0; ///< percentiles of the resamples; NaN where there are none
};

/// The coefficient alone. `x` and `y` have the same length; numbers are finite.
double coefficient(CorrelationKind kind, std::span<const double> x, std::span<const double> y);

/// p is exact for Spearman of up to 9 pairs and Kendall of fewer than 50, both without equal numbers; else by Student's
/// t with n − 2 degrees of freedom (Pearson, Spearman) and the normal distribution with the variance of ties (Kendall).
/// Throws Error where the lengths differ, or a number is not finite.
Correlation correlation(CorrelationKind kind, std::span<const double> x, std::span<const double> y,
                        const CorrelationOptions& options = {});

} // namespace pellucid
