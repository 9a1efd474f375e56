// The panel of what is cut away: the part of the box, and oblique planes. Picture and figures are of what is left.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include <QWidget>

#include "render/clipping.h"

class QAction;
class QDoubleSpinBox;
class QPushButton;

namespace pellucid::gui {

class Services;

class ClipPanel : public QWidget {
    Q_OBJECT
public:
    /// `handles` shows them in the picture.
    ClipPanel(Services& services, QAction& handles, QWidget* parent = nullptr);

    QSize sizeHint() const override; ///< without scrolling

private:
    /// One oblique plane; hidden where there is none of its number.
    struct PlaneRow {
        QWidget* widget;
        std::array<QDoubleSpinBox*, 4> boxes; ///< normal, offset
    };
    QWidget* makeBox();
    PlaneRow makeRow(std::size_t index);
    void follow();
    void editBox(int axis, bool upper, double percent);
    void editPlane(std::size_t index, int number, double value);
    void changePlanes(const QString& text, const std::function<void(std::vector<ClipPlane>&)>& change);

    Services& m_services;
    std::array<std::array<QDoubleSpinBox*, 2>, 3> m_box{}; ///< [axis][lower, upper], per cent of the box
    std::array<PlaneRow, kMostClipPlanes> m_planes{};
    QPushButton *m_add, *m_reset;
};

} // namespace pellucid::gui
