#include "prepare.h"

#include "base/round_numbers.h"

namespace pellucid::cli {

Prepared prepare(Workspace& workspace, const MeasureInput& input, Progress& progress) {
    Prepared prepared;
    prepared.engine = workspace.engine(input).name();
    workspace.weights(input, progress.phase("saliency"));
    prepared.saliencySeconds = workspace.seconds().saliency;
    return prepared;
}

std::function<void(const OptimizeState&)> movesTold(Progress& progress) {
    return [&progress, moves = 0](const OptimizeState& state) mutable {
        progress.tell(std::to_string(moves++) + " moves, distance " + plainText(state.objective));
    };
}

} // namespace pellucid::cli
