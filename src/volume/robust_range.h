// A range of values that a few wild ones do not stretch.
#pragma once

#include <optional>
#include <vector>

#include "volume/volume.h"

namespace pellucid {

/// The q-th quantile, q in [0,1], of values that ascend and are not none: the one at the nearest place.
double quantile(const std::vector<double>& sorted, double q);

/// Equal values that follow each other.
struct Run {
    std::size_t begin = 0, length = 0;
};
/// The longest run of values that ascend; of equal ones the first.
Run longestRun(const std::vector<double>& sorted);

struct RobustRange {
    ValueRange range; ///< lo < hi where the values differ
    /// A value outside `range` that many voxels share: a filler that the file does not declare as missing.
    std::optional<double> filler;
};

/// The part of `data` (smallest and largest value) that the values fill: from the 0.05th to the 99.95th percentile of
/// what is not the most common value, and further at each end: to the end of `data` where that is less than half of
/// this width away, else by a tenth of it. `values`: finite, a sample of the data, in any order.
RobustRange robustRange(std::vector<double> values, const ValueRange& data);

} // namespace pellucid
