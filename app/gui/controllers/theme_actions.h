// The choice between a dark and a light window.
#pragma once

#include "widgets/theme.h"

namespace pellucid::gui {

class Services;

/// The theme of the latest choice on this machine; dark before the first.
Theme keptTheme();
void addThemeActions(Services& services);

} // namespace pellucid::gui
