#include "panels/panel.h"

namespace pellucid::gui {

/// A function of a panel's own file, which says what the panel is.
using Panel = PanelInfo();
Panel transferFunctionPanel, playerPanel, featuresPanel, refinePanel, influencePanel, convergencePanel, displayPanel,
    lightPanel, clipPanel, overlayPanel, fieldsPanel, galleryPanel, viewsPanel, settingsPanel, spacePanel,
    variablesPanel, temporalPanel, keyframesPanel, pictureSaliencyPanel, comparePanel, measuresPanel;

std::vector<PanelInfo> panelRegistry() {
    return {transferFunctionPanel(),
            playerPanel(), // beside the one before it, which has no tabs yet: else it would become a tab, too
            featuresPanel(),
            refinePanel(),
            influencePanel(),
            convergencePanel(),
            displayPanel(),
            lightPanel(),
            clipPanel(),
            overlayPanel(),
            fieldsPanel(),
            measuresPanel(),
            pictureSaliencyPanel(),
            comparePanel(),
            galleryPanel(),
            viewsPanel(),
            settingsPanel(),
            spacePanel(),
            variablesPanel(),
            temporalPanel(),
            keyframesPanel()};
}

} // namespace pellucid::gui
