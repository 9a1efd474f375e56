// The curve as it was before the latest refinement, behind the curve.
#pragma once

namespace pellucid::gui {

class RefineController;
class TfCanvas;

/// Has the canvas show it, while RefineController::isGhostShown(), and keeps it up to date.
void addGhostLayer(RefineController& refining, TfCanvas& canvas);

} // namespace pellucid::gui
