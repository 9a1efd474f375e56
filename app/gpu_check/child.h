// Work that a driver may crash or hang in is done by this program itself, started again with other arguments: a part
// that ends badly takes nothing else with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json.h"

namespace pellucid::gpu_check {

struct PartResult {
    std::optional<Json> answer; ///< what the part said by answerPart()
    std::string skipped;        ///< the reason where it printed "SKIPPED: reason"
    std::string problem;        ///< of the answer, or without one how it ended: "ended by signal 11 (…)"; empty: none
    double seconds = 0;
};

/// Runs /proc/self/exe with these arguments, for `limitSeconds` at most. Throws Error where no process can be started.
PartResult runPart(const std::vector<std::string>& arguments, double limitSeconds);

/// In the started program: hands the result to runPart(). Once.
void answerPart(const Json& answer);

} // namespace pellucid::gpu_check
