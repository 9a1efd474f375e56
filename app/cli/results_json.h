// Refinements and optimizations as the JSON that commands promise, keys in the order of the documentation.
#pragma once

#include "optimize/optimizer.h"
#include "optimize/refine.h"
#include "output.h"

namespace pellucid::cli {

/// The objects of `refine --json` and `optimize --json`, without what the commands add ("engine", "seconds").
Json jsonFromRefinement(const RefineResult& result);
Json jsonFromOptimization(const OptimizeResult& result, const OptimizeOptions& options);

} // namespace pellucid::cli
