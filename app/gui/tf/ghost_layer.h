// The curve as it was before the latest refinement, behind the curve.
#pragma once

#include <memory>

#include "tf/tf_canvas.h"

namespace pellucid::gui {

class Workbench;

/// Adds it to the canvas, which it keeps up to date.
void addGhostLayer(Workbench& bench, TfCanvas& canvas);

} // namespace pellucid::gui
