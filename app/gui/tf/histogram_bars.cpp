#include "tf/histogram_bars.h"

#include <algorithm>
#include <cmath>

namespace pellucid::gui {
namespace {

constexpr double kPercentile = 0.995;

// Count of [from, to] in bins of equal width over [0,1], each spread evenly over its width.
double countBetween(std::span<const std::uint64_t> counts, double from, double to) {
    const auto n = static_cast<double>(counts.size());
    const double first = std::clamp(from * n, 0.0, n), last = std::clamp(to * n, 0.0, n);
    double sum = 0;
    for (auto i = static_cast<std::size_t>(first); i < counts.size() && static_cast<double>(i) < last; ++i) {
        const auto left = static_cast<double>(i);
        sum += static_cast<double>(counts[i]) * (std::min(left + 1, last) - std::max(left, first));
    }
    return sum;
}

} // namespace

std::vector<double> barHeights(std::span<const double> counts, HistogramScale scale) {
    std::vector<double> heights(counts.size(), 0.0);
    if (counts.empty()) return heights;
    double most = *std::max_element(counts.begin(), counts.end());
    if (!(most > 0)) return heights;
    if (scale == HistogramScale::Percentile) {
        std::vector<double> sorted(counts.begin(), counts.end());
        const auto rank = static_cast<std::size_t>(std::ceil(kPercentile * static_cast<double>(sorted.size()))) - 1;
        std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(rank), sorted.end());
        if (sorted[rank] > 0) most = sorted[rank];
    }
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double height =
            scale == HistogramScale::Log ? std::log1p(counts[i]) / std::log1p(most) : counts[i] / most;
        heights[i] = std::min(height, kCutBar);
    }
    return heights;
}

int SeenBins::at(double intensity) const {
    const double place = std::floor((intensity - lo) / width);
    const auto last = static_cast<double>(counts.size()) - 1;
    if (counts.empty() || place < 0 || place > last + 1) return -1;
    return static_cast<int>(std::min(place, last)); // the last bin is closed
}

SeenBins wholeBins(std::span<const std::uint64_t> counts) {
    return {0, 1.0 / static_cast<double>(std::max<std::size_t>(1, counts.size())), {counts.begin(), counts.end()}};
}

SeenBins seenBins(std::span<const std::uint64_t> counts, double lo, double hi, double step) {
    double width = std::exp2(std::floor(std::log2(hi - lo)) - 8);
    width = std::max(width, 1.0 / static_cast<double>(counts.size()));
    double origin = 0;
    if (step > 0 && step * static_cast<double>(counts.size()) >= 2) { // fine enough to tell values apart
        width = step * std::max(1.0, std::round(width / step));
        origin = -step / 2;
    }
    const double first = std::floor((lo - origin) / width), last = std::ceil((hi - origin) / width);
    SeenBins bins{origin + first * width, width, {}};
    for (double i = first; i < last; ++i)
        bins.counts.push_back(countBetween(counts, origin + i * width, origin + (i + 1) * width));
    return bins;
}

} // namespace pellucid::gui
