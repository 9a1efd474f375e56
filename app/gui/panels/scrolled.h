// A panel that may be lower than what it holds.
#pragma once

#include <QScreen>
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

/// What the least size of a dock in `area` may be, so that all of the window fits a screen of this size.
inline QSize mostRoom(Qt::DockWidgetArea area, const QSize& screen) {
    const bool beside = area == Qt::LeftDockWidgetArea || area == Qt::RightDockWidgetArea;
    return {screen.width() * (beside ? 56 : 40) / 100, screen.height() * (beside ? 40 : 30) / 100};
}

/// Around the content of a dock: scrolls it where the screen is too small for the least that it needs.
class DockScroll : public QScrollArea {
public:
    DockScroll(QWidget* content, Qt::DockWidgetArea area) : m_area(area) {
        setWidget(content);
        setWidgetResizable(true);
        setFrameShape(QFrame::NoFrame);
        setFocusPolicy(Qt::NoFocus);
    }
    QSize sizeHint() const override { return widget()->sizeHint(); }
    QSize minimumSizeHint() const override {
        const QSize least = widget()->minimumSizeHint().expandedTo(widget()->minimumSize());
        return least.boundedTo(mostRoom(m_area, screen()->availableSize()));
    }

private:
    Qt::DockWidgetArea m_area;
};

} // namespace pellucid::gui
