// The curve as it was before the latest refinement, behind the curve.
#pragma once

#include "tf/tf_canvas.h"

namespace pellucid::gui {

class RefineController;

/// Adds it to the canvas, which it keeps up to date.
void addGhostLayer(RefineController& refining, TfCanvas& canvas);

} // namespace pellucid::gui
