// Refinements and optimizations as the JSON that CLI.md promises.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "optimize/optimizer.h"
#include "optimize/refine.h"

namespace pellucid {

/// The objects of `refine --json` and `optimize --json`, without "seconds".
nlohmann::json jsonFromRefinement(const RefineResult& result);
nlohmann::json jsonFromOptimization(const OptimizeResult& result, const OptimizeOptions& options);

} // namespace pellucid
