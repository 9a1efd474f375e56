// The curve as it was before the latest refinement, behind the curve.
#pragma once

#include <memory>

#include "tf/tf_canvas.h"

namespace pellucid::gui {

class Services;

/// Adds it to the canvas, which it keeps up to date.
void addGhostLayer(Services& services, TfCanvas& canvas);

} // namespace pellucid::gui
