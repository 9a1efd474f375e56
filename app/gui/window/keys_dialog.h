// All that mouse and keys do, as a table that can be searched.
#pragma once

#include <QDialog>

namespace pellucid::gui {

class Actions;

/// As high as the table where the screen has the room, and scrolled where it has not.
class KeysDialog : public QDialog {
    Q_OBJECT
public:
    KeysDialog(const Actions& actions, QWidget* parent);
};

} // namespace pellucid::gui
