// Menus whose entries need no controller: each function adds those of one, in its own file.
#pragma once

#include "widgets/theme.h"

class QAction;

namespace pellucid::gui {

class Services;

void addAnnotationActions(Services& services); ///< switches of the annotations
void addSliceActions(Services& services);      ///< layouts, the crosshair, the window of grey
void addThemeActions(Services& services);      ///< a dark or a light window
void addVisionActions(Services& services);     ///< the window as other viewers see it
void addViewActions(Services& services);       ///< standard views, projection, the camera's history
/// Whether the handles of what is cut away are shown.
QAction& addClipHandlesAction(Services& services);

/// The theme of the latest choice on this machine; dark before the first.
Theme keptTheme();

} // namespace pellucid::gui
