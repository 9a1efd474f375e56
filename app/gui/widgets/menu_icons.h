// Menus whose icons are larger than usual.
#pragma once

namespace pellucid::gui {

/// Property of a menu: a QSize, that of its icons in logical pixels.
inline constexpr auto kMenuIconSize = "menuIconSize";

} // namespace pellucid::gui
