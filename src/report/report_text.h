// Numbers as reports print them, the same in every locale.
#pragma once

#include <string>

namespace pellucid {

std::string fixedText(double value, int decimals); ///< "0.407"
std::string shortText(double value);               ///< at most four significant digits: "0.0312", "1.2e-05"

} // namespace pellucid
