// What people set for this machine, whatever they look at.
#pragma once

#include <optional>

#include "base/setting.h"
#include "widgets/mouse_scheme.h"
#include "widgets/theme.h"

namespace pellucid::gui {

struct Preferences {
    Theme theme = Theme::Dark;
    MouseScheme mouse = MouseScheme::Pellucid;
    std::optional<double> memoryGiB; ///< of the whole program; empty: what the system has free
    int threads = 0;                 ///< 0: all cores
    int recentCount = 8;             ///< files that the list of recent ones keeps
    bool recentPictures = true;      ///< with a small picture of each
    bool recentAtStart = true;       ///< beside the sample of a start without a file
};

/// As they were kept; what is missing or not allowed there is as in Preferences{}.
Preferences keptPreferences();
void keepPreferences(const Preferences& preferences);
/// Threads, memory and mouse of this process, from now on. The theme is applyTheme()'s.
void applyPreferences(const Preferences& preferences);

} // namespace pellucid::gui
namespace pellucid {
template <>
std::span<const Setting> settingsOf<gui::Preferences>();
}
