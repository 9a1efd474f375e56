// Round numbers, and numbers as texts, for axes, scales, legends and reports; the same in every locale.
#pragma once

#include <string>
#include <vector>

namespace pellucid {

/// Multiples of 1, 2 or 5 times a power of ten within [lo, hi], about `wanted` of them. Empty unless lo < hi, both
/// finite.
std::vector<double> axisTicks(double lo, double hi, int wanted);

/// The largest of 1, 2 or 5 times a power of ten that is at most `most`, which is > 0 and finite.
double roundNumberBelow(double most);

/// `value` with as many digits as tell apart values in a range of width `span`; the same in every locale.
std::string numberText(double value, double span);

std::string fixedText(double value, int decimals); ///< "0.407"
std::string plainText(double value);               ///< at most six significant digits: "0.957031", "1e+06"
std::string shortText(double value);               ///< at most four significant digits: "0.0312", "1.2e-05"
std::string exactText(double value);               ///< the fewest digits that read back as the same number

/// Decimals that tell apart values in a range of width `span`, [0, 12].
int decimalsFor(double span);

} // namespace pellucid
