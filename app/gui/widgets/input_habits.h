// Habits of the toolkit that are in people's way, mended in one place.
#pragma once

#include <QObject>

namespace pellucid::gui {

inline constexpr auto kKeepsSpace = "keepsSpace";

/// Installed on the application:
/// - undo in a number box that holds a finished number is the program's undo, not the box's own;
/// - a button, a list, or what has the property kKeepsSpace, keeps the space bar while it has the focus;
/// - Tab leaves a table for the next control, where arrow keys go from cell to cell;
/// - a control without a label is named by the first words of its tool tip, for screen readers;
/// - tool tips stay within the window that they belong to.
class InputHabits : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;
};

} // namespace pellucid::gui
