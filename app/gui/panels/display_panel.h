// The panel of the picture: light, clipping, one feature alone, and which values of the data are looked at.
#pragma once

#include <array>

#include <QWidget>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSpinBox;
class QToolButton;

namespace pellucid::gui {

class Workbench;

class DisplayPanel : public QWidget {
    Q_OBJECT
public:
    explicit DisplayPanel(Workbench& bench, QWidget* parent = nullptr);

private:
    void follow();
    void editClipping(int axis, bool upper, double percent);
    void editWindow();

    Workbench& m_bench;
    QCheckBox* m_shading;
    QToolButton* m_background;
    QComboBox* m_feature;
    std::array<std::array<QDoubleSpinBox*, 2>, 3> m_clip{}; ///< [axis][lower, upper], per cent of the box
    QPushButton* m_resetClip;
    QDoubleSpinBox *m_lo, *m_hi;
    QPushButton* m_wholeRange;
    QSpinBox* m_component;
    QLabel* m_note;
    bool m_showing = false; ///< the controls show, they do not edit
};

} // namespace pellucid::gui
