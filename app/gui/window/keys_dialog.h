// All that mouse and keys do, as a table that can be searched.
#pragma once

class QWidget;

namespace pellucid::gui {

class Actions;

/// Shows a dialog as high as the table where the screen has the room, and scrolled where it has not, until it is
/// closed.
void showKeys(const Actions& actions, QWidget* parent);

} // namespace pellucid::gui
