// What a control is called, and what it tells of itself.
#pragma once

#include <QString>
#include <QWidget>

namespace pellucid::gui {

/// Gives the widget its object name, by which tests and style sheets find it, and its tool tip. Returns the widget.
template <class W>
W* named(W* widget, const QString& id, const QString& tip = {}) {
    widget->setObjectName(id);
    widget->setToolTip(tip);
    return widget;
}

} // namespace pellucid::gui
