// What the menu of targets does: presets of all targets, locks of one.
#pragma once

class QMenu;

namespace pellucid::gui {

class Services;

void addTargetActions(Services& services);
/// The entries of the menu of targets.
void fillTargetMenu(QMenu& menu, Services& services);
/// Those of a feature's opacity in an optimization: lock and limits.
void fillLimitsMenu(QMenu& menu, Services& services);

} // namespace pellucid::gui
