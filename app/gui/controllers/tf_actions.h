// The Transfer function menu: presets, and features from the curve.
#pragma once

namespace pellucid::gui {

class Services;
void addTfActions(Services& services);

} // namespace pellucid::gui
