// The Transfer function menu: presets, and features from the curve.
#pragma once

namespace pellucid::gui {

class Workbench;
void addTfActions(Workbench& bench);

} // namespace pellucid::gui
