// Above the views, while slices are shown: how slices look.
#pragma once

#include <QWidget>

class QDoubleSpinBox;
class QLabel;
class QSlider;
class QToolButton;

namespace pellucid::gui {

class Services;

/// How strong the transfer function's colours are, and the window of grey in data units; of the data, not of a field.
class SliceBar : public QWidget {
    Q_OBJECT
public:
    explicit SliceBar(Services& services, QWidget* parent = nullptr);

private:
    void follow();
    void editStrength(int percent);
    void editWindow(const QDoubleSpinBox& box);

    Services& m_services;
    QSlider* m_strength;
    QDoubleSpinBox *m_lo, *m_hi;
    QToolButton* m_reset;
    QLabel* m_ofField; ///< why the rest is greyed out
};

} // namespace pellucid::gui
