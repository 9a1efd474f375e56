#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <unsupported/Eigen/SpecialFunctions>

#include "base/error.h"

namespace pellucid {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

using Numbers = std::vector<double>;

/// Indices in the order of `less`.
template <class Less>
std::vector<std::size_t> ordered(std::size_t count, const Less& less) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), less);
    return order;
}

/// Calls body(first, end) for each run of equal numbers in a sorted series.
template <class Equal, class Body>
void forRuns(std::size_t count, const Equal& equal, const Body& body) {
    for (std::size_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && equal(first, end);) ++end;
        body(first, end);
    }
}

/// From 1 on; equal numbers share the mean of their ranks.
Numbers ranksOf(std::span<const double> x) {
    const auto order = ordered(x.size(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
    Numbers ranks(x.size());
    forRuns(
        x.size(), [&](std::size_t a, std::size_t b) { return x[order[a]] == x[order[b]]; },
        [&](std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i) ranks[order[i]] = static_cast<double>(first + end + 1) / 2;
        });
    return ranks;
}

/// Divides by the largest size, so that squares neither overflow nor vanish.
void scale(Numbers& v) {
    const double top = std::abs(*std::ranges::max_element(v, {}, [](double value) { return std::abs(value); }));
    for (double& value : v) value /= top > 0 ? top : 1;
}

/// Less their mean, in some unit.
Numbers centred(std::span<const double> x) {
    Numbers d(x.begin(), x.end());
    scale(d);
    const double mean = std::accumulate(d.begin(), d.end(), 0.0) / static_cast<double>(d.size());
    for (double& value : d) value -= mean;
    scale(d);
    return d;
}

bool varies(std::span<const double> x) {
    return std::ranges::any_of(x, [&](double value) { return value != x.front(); });
}

double pearson(std::span<const double> x, std::span<const double> y) {
    if (!varies(x) || !varies(y)) return kNone;
    const Numbers dx = centred(x), dy = centred(y);
    const auto product = [](const Numbers& a, const Numbers& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    };
    return std::clamp(product(dx, dy) / std::sqrt(product(dx, dx) * product(dy, dy)), -1.0, 1.0);
}

/// Pairs of equal numbers, and what their sizes t add to the variance of Kendall's S.
struct Ties {
    double pairs = 0;  ///< Σ t(t−1)/2
    double second = 0; ///< Σ t(t−1)
    double third = 0;  ///< Σ t(t−1)(t−2)
    double spread = 0; ///< Σ t(t−1)(2t+5)
};
Ties tiesOf(std::span<const double> x) {
    Numbers sorted(x.begin(), x.end());
    std::ranges::sort(sorted);
    Ties ties;
    forRuns(
        sorted.size(), [&](std::size_t a, std::size_t b) { return sorted[a] == sorted[b]; },
        [&](std::size_t first, std::size_t end) {
            const auto t = static_cast<double>(end - first);
            ties.pairs += t * (t - 1) / 2;
            ties.second += t * (t - 1);
            ties.third += t * (t - 1) * (t - 2);
            ties.spread += t * (t - 1) * (2 * t + 5);
        });
    return ties;
}

/// Sorts v[first, end) and says how many pairs were in the wrong order (merge sort).
double inversions(Numbers& v, Numbers& scratch, std::size_t first, std::size_t end) {
    if (end - first < 2) return 0;
    const std::size_t middle = (first + end) / 2;
    double count = inversions(v, scratch, first, middle) + inversions(v, scratch, middle, end);
    std::size_t a = first, b = middle;
    for (std::size_t i = first; i < end; ++i) {
        if (b == end || (a < middle && v[a] <= v[b])) {
            scratch[i] = v[a++];
        } else {
            scratch[i] = v[b++];
            count += static_cast<double>(middle - a);
        }
    }
    std::copy(scratch.begin() + static_cast<std::ptrdiff_t>(first), scratch.begin() + static_cast<std::ptrdiff_t>(end),
              v.begin() + static_cast<std::ptrdiff_t>(first));
    return count;
}

/// Kendall's S: pairs in the same order less those in the opposite one (Knight's algorithm).
double kendallS(std::span<const double> x, std::span<const double> y) {
    const auto n = static_cast<double>(x.size());
    const auto order =
        ordered(x.size(), [&](std::size_t a, std::size_t b) { return x[a] != x[b] ? x[a] < x[b] : y[a] < y[b]; });
    double both = 0;
    forRuns(
        x.size(),
        [&](std::size_t a, std::size_t b) { return x[order[a]] == x[order[b]] && y[order[a]] == y[order[b]]; },
        [&](std::size_t first, std::size_t end) {
            const auto t = static_cast<double>(end - first);
            both += t * (t - 1) / 2;
        });
    Numbers by(x.size()), scratch(x.size());
    for (std::size_t i = 0; i < by.size(); ++i) by[i] = y[order[i]];
    const double opposite = inversions(by, scratch, 0, by.size());
    return n * (n - 1) / 2 - tiesOf(x).pairs - tiesOf(y).pairs + both - 2 * opposite;
}

double kendall(std::span<const double> x, std::span<const double> y) {
    const auto n = static_cast<double>(x.size());
    const double all = n * (n - 1) / 2, ofX = all - tiesOf(x).pairs, ofY = all - tiesOf(y).pairs;
    return ofX > 0 && ofY > 0 ? std::clamp(kendallS(x, y) / std::sqrt(ofX) / std::sqrt(ofY), -1.0, 1.0) : kNone;
}

/// Two-sided p of Student's t = r·√((n−2)/(1−r²)).
double studentP(double r, std::size_t n) {
    if (n < 3) return kNone;
    // P(|T| > t) = I_{ν/(ν+t²)}(ν/2, 1/2), and ν/(ν+t²) = 1 − r².
    return Eigen::numext::betainc((static_cast<double>(n) - 2) / 2, 0.5, 1 - r * r);
}

/// Two-sided p of ranks without ties, from all orders of them.
double exactSpearmanP(const Numbers& x, const Numbers& y) {
    const auto squares = [&](const Numbers& other) {
        double sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - other[i]) * (x[i] - other[i]);
        return sum; // of whole numbers: exact
    };
    const double found = squares(y);
    Numbers order = y;
    std::ranges::sort(order);
    double below = 0, above = 0, all = 0; // or equal
    do {
        const double sum = squares(order);
        below += sum <= found;
        above += sum >= found;
        ++all;
    } while (std::next_permutation(order.begin(), order.end()));
    return std::min(1.0, 2 * std::min(below, above) / all);
}

/// Two-sided p of S without ties, from the number of orders that have so many pairs the right way round.
double exactKendallP(double s, std::size_t n) {
    Numbers share{1}; // of the orders of i numbers, by the number of pairs in the same order
    for (std::size_t i = 2; i <= n; ++i) {
        Numbers next(share.size() + i - 1, 0.0);
        for (std::size_t k = 0; k < share.size(); ++k)
            for (std::size_t j = 0; j < i; ++j) next[k + j] += share[k] / static_cast<double>(i);
        share = std::move(next);
    }
    const auto found = static_cast<std::size_t>(std::lround((s + static_cast<double>(n * (n - 1)) / 2) / 2));
    const auto middle = share.begin() + static_cast<std::ptrdiff_t>(found);
    const double below = std::accumulate(share.begin(), middle + 1, 0.0);
    const double above = std::accumulate(middle, share.end(), 0.0);
    return std::min(1.0, 2 * std::min(below, above));
}

double kendallP(std::span<const double> x, std::span<const double> y) {
    const Ties ofX = tiesOf(x), ofY = tiesOf(y);
    const double s = kendallS(x, y);
    if (x.size() < 50 && ofX.pairs == 0 && ofY.pairs == 0) return exactKendallP(s, x.size());
    const auto n = static_cast<double>(x.size());
    double variance =
        (n * (n - 1) * (2 * n + 5) - ofX.spread - ofY.spread) / 18 + ofX.second * ofY.second / (2 * n * (n - 1));
    if (n > 2) variance += ofX.third * ofY.third / (9 * n * (n - 1) * (n - 2));
    return std::erfc(std::abs(s) / std::sqrt(2 * variance));
}

/// The value below which the part `part` of the sorted numbers lies, interpolated between them.
double percentile(const Numbers& sorted, double part) {
    const double at = part * static_cast<double>(sorted.size() - 1);
    const auto low = static_cast<std::size_t>(at);
    const std::size_t high = std::min(low + 1, sorted.size() - 1);
    return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

/// P(T ≤ t) for t ≤ 0.
double studentLowerTail(double t, double degrees) {
    return 0.5 * Eigen::numext::betainc(degrees / 2, 0.5, degrees / (degrees + t * t));
}

} // namespace

double median(std::span<const double> x) {
    Numbers sorted(x.begin(), x.end());
    std::ranges::sort(sorted);
    return sorted.empty() ? kNone : percentile(sorted, 0.5);
}

double studentQuantile(double p, double degrees) {
    if (p > 0.5) return -studentQuantile(1 - p, degrees);
    double low = -1, high = 0;
    while (studentLowerTail(low, degrees) > p) {
        high = low;
        low *= 2;
    }
    for (double middle = (low + high) / 2; low < middle && middle < high; middle = (low + high) / 2)
        (studentLowerTail(middle, degrees) > p ? high : low) = middle;
    return (low + high) / 2;
}

Mean meanOf(std::span<const double> x, double confidence) {
    Mean mean;
    mean.count = x.size();
    if (x.empty()) return mean;
    const auto n = static_cast<double>(x.size());
    mean.value = std::accumulate(x.begin(), x.end(), 0.0) / n;
    if (x.size() < 2) return mean;
    double squares = 0;
    for (const double value : x) squares += (value - mean.value) * (value - mean.value);
    mean.deviation = std::sqrt(squares / (n - 1));
    const double half = studentQuantile((1 + confidence) / 2, n - 1) * mean.deviation / std::sqrt(n);
    mean.interval = {mean.value - half, mean.value + half};
    return mean;
}

Interval bootstrapInterval(std::size_t count, const FigureOfDrawn& figure, const BootstrapOptions& options) {
    std::mt19937 random(options.seed);
    std::vector<std::size_t> drawn(count);
    Numbers found;
    for (int n = 0; n < options.resamples; ++n) {
        // Not std::uniform_int_distribution, which is another one in every standard library.
        for (std::size_t& one : drawn)
            one = static_cast<std::size_t>(static_cast<double>(random()) / 4294967296.0 * static_cast<double>(count));
        if (const double value = figure(drawn); !std::isnan(value)) found.push_back(value);
    }
    if (found.empty()) return {};
    std::ranges::sort(found);
    return {percentile(found, (1 - options.confidence) / 2), percentile(found, (1 + options.confidence) / 2)};
}

double coefficient(CorrelationKind kind, std::span<const double> x, std::span<const double> y) {
    switch (kind) {
    case CorrelationKind::Pearson:
        return pearson(x, y);
    case CorrelationKind::Spearman:
        return pearson(ranksOf(x), ranksOf(y));
    case CorrelationKind::Kendall:
        return kendall(x, y);
    }
    return kNone;
}

Correlation correlation(CorrelationKind kind, std::span<const double> x, std::span<const double> y,
                        const BootstrapOptions& options) {
    if (x.size() != y.size()) throw Error("the series differ in length", "correlation", "give pairs of numbers");
    const auto isFinite = [](double v) { return std::isfinite(v); };
    if (!std::ranges::all_of(x, isFinite) || !std::ranges::all_of(y, isFinite))
        throw Error("a number is not finite", "correlation", "leave its pair out");
    Correlation answer{coefficient(kind, x, y), kNone, {}};
    if (std::isnan(answer.value)) return answer;
    if (kind == CorrelationKind::Kendall) {
        answer.p = x.size() < 3 ? kNone : kendallP(x, y);
    } else {
        const bool few = kind == CorrelationKind::Spearman && x.size() >= 3 && x.size() <= 9;
        answer.p = few && tiesOf(x).pairs == 0 && tiesOf(y).pairs == 0 ? exactSpearmanP(ranksOf(x), ranksOf(y))
                                                                       : studentP(answer.value, x.size());
    }
    Numbers ofX(x.size()), ofY(y.size());
    answer.interval = bootstrapInterval(
        x.size(),
        [&](std::span<const std::size_t> drawn) {
            for (std::size_t i = 0; i < drawn.size(); ++i) {
                ofX[i] = x[drawn[i]];
                ofY[i] = y[drawn[i]];
            }
            return coefficient(kind, ofX, ofY);
        },
        options);
    return answer;
}

} // namespace pellucid
