// What the menu of targets does: presets of all targets, locks of one.
#pragma once

class QMenu;

namespace pellucid::gui {

class Workbench;

void addTargetActions(Workbench& bench);
/// The entries of the menu of targets.
void fillTargetMenu(QMenu& menu, Workbench& bench);
/// Those of a feature's opacity in an optimization: lock and limits.
void fillLimitsMenu(QMenu& menu, Workbench& bench);

} // namespace pellucid::gui
