// What samples tell: means and medians, how strongly two series of numbers go together, and how sure that is.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>

#include "base/enum_names.h"

namespace pellucid {

/// Between which two numbers a figure lies; NaN where that cannot be told.
struct Interval {
    double low = std::numeric_limits<double>::quiet_NaN(), high = std::numeric_limits<double>::quiet_NaN();
    bool contains(double value) const { return low <= value && value <= high; }
};

/// The mean of a sample of a normal distribution.
struct Mean {
    std::size_t count = 0;
    double value = std::numeric_limits<double>::quiet_NaN();     ///< NaN of none
    double deviation = std::numeric_limits<double>::quiet_NaN(); ///< standard, of n − 1; NaN of fewer than two
    Interval interval; ///< value ± t·deviation/√n, by Student's t with n − 1 degrees of freedom; NaN likewise
};
/// `confidence` of the interval, (0, 1).
Mean meanOf(std::span<const double> x, double confidence = 0.95);

double median(std::span<const double> x); ///< of an even number the mean of the two in the middle; NaN of none

/// Student's t below which the share `p` in (0, 1) of its distribution with `degrees` > 0 of freedom lies.
double studentQuantile(double p, double degrees);

enum class CorrelationKind {
    Pearson,  ///< of the numbers themselves: whether they lie on a line
    Spearman, ///< of their ranks, equal ones sharing the mean of theirs: whether one grows with the other
    Kendall   ///< τ-b, of pairs: how many are in the same order, without those that are equal
};
template <>
inline constexpr auto kNamesOf<CorrelationKind> = enumNames("correlation", "pearson", "spearman", "kendall");

struct BootstrapOptions {
    double confidence = 0.95; ///< of the interval, (0, 1)
    int resamples = 2000;     ///< with replacement; 0: no interval
    std::uint32_t seed = 1;
};

/// What a figure is of some of the things 0 … count − 1: `drawn` has as many numbers as there are things, some several
/// times. NaN: it has no value.
using FigureOfDrawn = std::function<double(std::span<const std::size_t> drawn)>;
/// Percentiles of the figure over resamples of the things (bootstrap); those without a value do not count.
Interval bootstrapInterval(std::size_t count, const FigureOfDrawn& figure, const BootstrapOptions& options = {});

struct Correlation {
    double value = 0;  ///< [−1, 1]; NaN where there are fewer than two pairs, or all numbers of a series are equal
    double p = 1;      ///< two-sided, of no correlation; NaN likewise, and of fewer than three pairs
    Interval interval; ///< bootstrapInterval() over the pairs
};

/// The coefficient alone. `x` and `y` have the same length; numbers are finite.
double coefficient(CorrelationKind kind, std::span<const double> x, std::span<const double> y);

/// p is exact for Spearman of up to 9 pairs and Kendall of fewer than 50, both without equal numbers; else by Student's
/// t with n − 2 degrees of freedom (Pearson, Spearman) and the normal distribution with the variance of ties (Kendall).
/// Throws Error where the lengths differ, or a number is not finite.
Correlation correlation(CorrelationKind kind, std::span<const double> x, std::span<const double> y,
                        const BootstrapOptions& options = {});

} // namespace pellucid
