#include "tf/ghost_layer.h"

#include "controllers/refine_controller.h"
#include "tf/tf_canvas.h"

namespace pellucid::gui {

void addGhostLayer(RefineController& refining, TfCanvas& canvas) {
    canvas.setGhost([&refining]() -> const TransferFunction* {
        const Refinement* const latest = refining.isGhostShown() ? refining.latest() : nullptr;
        return latest == nullptr ? nullptr : &latest->before;
    });
    for (const auto changed : {&RefineController::refined, &RefineController::ghostChanged})
        QObject::connect(&refining, changed, &canvas, qOverload<>(&QWidget::update));
}

} // namespace pellucid::gui
