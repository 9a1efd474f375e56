// Habits of the toolkit that are in people's way, mended in one place.
#pragma once

#include <QObject>

namespace pellucid::gui {

/// Installed on the application:
/// - undo in a number box that holds a finished number is the program's undo, not the box's own;
/// - a button or list that has the focus keeps the space bar, whatever shortcut that is;
/// - tool tips stay within the window that they belong to.
class InputHabits : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;
};

} // namespace pellucid::gui
