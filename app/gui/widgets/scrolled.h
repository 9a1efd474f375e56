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

/// Around the content of a dock, which may be larger than it: a window of 640 x 400 has a dock on the right, one at the
/// bottom, and the picture.
class DockScroll : public QScrollArea {
public:
    DockScroll(QWidget* content, Qt::DockWidgetArea area)
        : m_most(area == Qt::BottomDockWidgetArea ? kBelow : kBeside) {
        setWidget(content);
        setWidgetResizable(true);
        setFrameShape(QFrame::NoFrame);
        setFocusPolicy(Qt::NoFocus);
    }
    QSize sizeHint() const override { return widget()->sizeHint(); }
    QSize minimumSizeHint() const override { return leastOfContent().boundedTo(m_most); }
    /// Smaller, and it scrolls.
    QSize leastOfContent() const { return widget()->minimumSizeHint().expandedTo(widget()->minimumSize()); }

private:
    static constexpr QSize kBeside{360, 200}, kBelow{240, 120}; // logical pixels
    QSize m_most;                                               ///< that it may ask for
};

} // namespace pellucid::gui
