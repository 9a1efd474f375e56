// The line above a panel: its name, what it has to say or to set there, and the buttons of the dock.
#pragma once

#include <QWidget>

class QDockWidget;
class QHBoxLayout;

namespace pellucid::gui {

class FittingRow;

/// Low, so that it takes little of the picture's room; controls of a panel may stand in it.
class DockTitle : public QWidget {
    Q_OBJECT
public:
    explicit DockTitle(QDockWidget& dock);

    /// To be filled with controls of the panel.
    FittingRow& controls() { return *m_controls; }
    /// That of the dock a panel is made for; null: it has none, as in tests of a panel alone.
    static DockTitle* of(QWidget* dock);

    QSize sizeHint() const override;
    QSize minimumSizeHint() const override { return {0, sizeHint().height()}; }

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    FittingRow* m_controls;
};

} // namespace pellucid::gui
