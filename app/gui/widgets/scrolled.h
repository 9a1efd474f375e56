// The content of a dock, which may be larger than the dock.
#pragma once

#include <QScrollArea>

namespace pellucid::gui {

/// Scrolls what there is no room for: a window of 640 x 400 has a dock on the right, one at the bottom, and the
/// picture.
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
