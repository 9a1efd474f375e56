// The panel of the picture: how it is made, what is behind it, one feature alone, and which values are looked at.
#pragma once

#include <QWidget>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSpinBox;
class QToolButton;

namespace pellucid::gui {

class OpenController;
class Services;

class DisplayPanel : public QWidget {
    Q_OBJECT
public:
    DisplayPanel(Services& services, OpenController& opening, QWidget* parent = nullptr);

private:
    void follow();
    void chooseBackground(bool top);
    void editWindow();

    Services& m_services;
    OpenController& m_opening;
    QComboBox* m_mode;
    QToolButton* m_background;
    QCheckBox* m_gradient;
    QToolButton* m_top;
    QComboBox* m_feature;
    QComboBox* m_finest;
    QDoubleSpinBox *m_lo, *m_hi;
    QPushButton* m_wholeRange;
    QSpinBox* m_component;
    QLabel* m_note;
};

} // namespace pellucid::gui
