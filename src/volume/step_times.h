// When the steps of a file are.
#pragma once

#include <string>

namespace pellucid {

/// When the steps of a file are: first, first + width, …
struct StepTimes {
    double first = 0, width = 1;
    std::string unit; ///< "s", "ms", …; empty: not known
};

} // namespace pellucid
