#include "volume/robust_range.h"

#include <algorithm>

namespace pellucid {

namespace {

constexpr double kTail = 0.0005;
constexpr double kKept = 0.5, kMargin = 0.1; // of the width between the percentiles
constexpr double kCommon = 0.3;              // share from which on one single value counts as filled in
constexpr double kFar = 2.0;                 // widths between a filler and everything else

} // namespace

double quantile(const std::vector<double>& sorted, double q) {
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1) + 0.5)];
}

Run longestRun(const std::vector<double>& sorted) {
    Run longest;
    for (std::size_t i = 0, j = 0; i < sorted.size(); i = j) {
        while (j < sorted.size() && sorted[j] == sorted[i]) ++j;
        if (j - i > longest.length) longest = {i, j - i};
    }
    return longest;
}

RobustRange robustRange(std::vector<double> values, const ValueRange& data) {
    if (values.empty() || !(data.lo < data.hi)) return {data, {}};
    std::sort(values.begin(), values.end());
    const auto [begin, length] = longestRun(values);
    const double common = values[begin];
    const bool manyAlike = static_cast<double>(length) >= kCommon * static_cast<double>(values.size());
    if (manyAlike)
        values.erase(values.begin() + static_cast<std::ptrdiff_t>(begin),
                     values.begin() + static_cast<std::ptrdiff_t>(begin + length));
    if (values.empty()) return {data, {}};

    ValueRange core{quantile(values, kTail), quantile(values, 1 - kTail)};
    RobustRange result;
    if (manyAlike) {
        const double width = core.hi - core.lo;
        if (width > 0 && (core.lo - common > kFar * width || common - core.hi > kFar * width) &&
            (common == data.lo || common == data.hi))
            result.filler = common;
        else
            core = {std::min(core.lo, common), std::max(core.hi, common)};
    }
    const double width = core.hi - core.lo;
    if (!(width > 0)) return {data, {}};
    const auto end = [&](double beyond) { return beyond <= kKept * width ? beyond : kMargin * width; };
    result.range = {core.lo - end(core.lo - data.lo), core.hi + end(data.hi - core.hi)};
    // Subtracting and adding again may miss the data's end by a rounding.
    if (core.lo - data.lo <= kKept * width) result.range.lo = data.lo;
    if (data.hi - core.hi <= kKept * width) result.range.hi = data.hi;
    return result;
}

} // namespace pellucid
