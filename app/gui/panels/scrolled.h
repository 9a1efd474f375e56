// A panel that may be lower than what it holds.
#pragma once

#include <QScrollArea>
#include <QVBoxLayout>

namespace pellucid::gui {

/// Fills `panel`, which has no layout yet, with `content`, scrolled where there is no room for all of it.
inline void fillScrolled(QWidget* panel, QWidget* content) {
    auto* scroll = new QScrollArea(panel);
    scroll->setWidget(content);
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    auto* column = new QVBoxLayout(panel);
    column->setContentsMargins(0, 0, 0, 0);
    column->addWidget(scroll);
}

} // namespace pellucid::gui
