// Which bins of a histogram are seen, and how high they are drawn.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace pellucid::gui {

enum class HistogramScale {
    Log,       ///< log(1 + count)
    Linear,    ///< in proportion
    Percentile ///< in proportion to the 99.5th percentile of the bins' counts: one huge bin does not flatten the rest
};

/// The height that a bar has at most; bars of at most 1 leave room above them.
inline constexpr double kCutBar = 1.06;

/// Height of each bin, 1 for the largest; of Percentile kCutBar for those that are cut. All 0 where nothing is counted.
std::vector<double> barHeights(std::span<const double> counts, HistogramScale scale);

/// Bins of equal width over a part of the intensities: bin i is from lo + i·width to lo + (i + 1)·width.
struct SeenBins {
    double lo = 0, width = 1;
    std::vector<double> counts;

    /// Index of the bin of an intensity, −1: none.
    int at(double intensity) const;
};

/// The bins of `counts` (of the intensities [0,1], n bins of 1/n) as they are where all is seen.
SeenBins wholeBins(std::span<const std::uint64_t> counts);

/// The part [lo, hi] in about 256 to 512 bins, counted from the finer `counts`. `step`: intensities from one possible
/// value to the next, 0 where any is possible; bins are then around whole numbers of values, so that none is emptier
/// for having fewer of them. Bins do not move when the part does, unless its width passes a power of two.
SeenBins seenBins(std::span<const std::uint64_t> counts, double lo, double hi, double step);

} // namespace pellucid::gui
