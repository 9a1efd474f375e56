#include "panels/panel.h"

// The registry: one line a panel. Each is a function of its own file that tells what the panel is.
// clang-format off
#define PELLUCID_PANELS(PANEL) \
    PANEL(transferFunctionPanel) \
    PANEL(playerPanel) /* below the one before it, which has no tabs yet: else it would become a tab, too */ \
    PANEL(featuresPanel) \
    PANEL(refinePanel) \
    PANEL(influencePanel) \
    PANEL(convergencePanel) \
    PANEL(displayPanel) \
    PANEL(lightPanel) \
    PANEL(clipPanel) \
    PANEL(fieldsPanel) \
    PANEL(galleryPanel) \
    PANEL(viewsPanel) \
    PANEL(settingsPanel) \
    PANEL(spacePanel) \
    PANEL(variablesPanel) \
    PANEL(temporalPanel) \
    /* the end, so that a new line changes no other */
// clang-format on

namespace pellucid::gui {

#define PELLUCID_DECLARE_PANEL(name) PanelInfo name();
PELLUCID_PANELS(PELLUCID_DECLARE_PANEL)
#undef PELLUCID_DECLARE_PANEL

std::vector<PanelInfo> panelRegistry() {
#define PELLUCID_CALL_PANEL(name) name(),
    return {PELLUCID_PANELS(PELLUCID_CALL_PANEL)};
#undef PELLUCID_CALL_PANEL
}

} // namespace pellucid::gui
