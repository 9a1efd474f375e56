#include "prepare.h"

namespace pellucid::cli {

Prepared prepare(Workspace& workspace, const MeasureInput& input, Progress& progress) {
    Prepared prepared;
    prepared.engine = workspace.engine(input).name();
    workspace.weights(input, progress.phase("saliency"));
    prepared.saliencySeconds = workspace.seconds().saliency;
    return prepared;
}

} // namespace pellucid::cli
