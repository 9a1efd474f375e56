// Round numbers for axes.
#pragma once

#include <vector>

#include <QString>

#include "volume/volume.h"

namespace pellucid::gui {

/// Multiples of 1, 2 or 5 times a power of ten within [lo, hi], about `wanted` of them. Empty unless lo < hi, both
/// finite.
std::vector<double> axisTicks(double lo, double hi, int wanted);

/// `value` with as many digits as tell apart values in a range of width `span`.
QString numberText(double value, double span);

/// "-1024 – 2986": both ends with as many digits as the range needs.
QString rangeText(const ValueRange& range);

/// Decimals that a spin box needs for values in a range of width `span`, [0, 12].
int decimalsFor(double span);

} // namespace pellucid::gui
