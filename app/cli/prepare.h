// Gets ready to measure: engine and saliency; tells how a search goes.
#pragma once

#include <functional>
#include <string>

#include "progress.h"
#include "session/workspace.h"

namespace pellucid::cli {

struct Prepared {
    std::string engine; ///< its name
    double saliencySeconds = 0;
};

/// The engine first, since there may be none, then the saliency. What `workspace` computes next begins with the sweeps.
Prepared prepare(Workspace& workspace, const MeasureInput& input, Progress& progress);

/// Tells of each move of a search, from its start on.
std::function<void(const OptimizeState&)> movesTold(Progress& progress);

} // namespace pellucid::cli
