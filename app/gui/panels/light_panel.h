// The panel of light: what makes shapes visible. No figure depends on it.
#pragma once

#include <vector>

#include <QWidget>

#include "render/render_settings.h"

class QAction;
class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QPushButton;
class QSlider;

namespace pellucid::gui {

class Services;

class LightPanel : public QWidget {
    Q_OBJECT
public:
    /// `light` puts it on and off.
    LightPanel(Services& services, QAction& light, QWidget* parent = nullptr);

    QSize sizeHint() const override; ///< without scrolling

private:
    /// A number of the light, by a slider and a box.
    struct Row {
        double Light::*value;
        double lo, hi;
        bool logarithmic; ///< on the slider
        QSlider* slider;
        QDoubleSpinBox* box;
        QString name;
        int positionOf(double number) const;
        double numberAt(int position) const;
    };
    void addRow(QFormLayout& form, const char* name, const QString& label, const QString& tip, double Light::*value,
                double lo, double hi, bool logarithmic = false);
    void follow();
    void edit(const Row& row, double number);
    void editDirection();

    Services& m_services;
    QCheckBox* m_on;
    QComboBox* m_preset;
    std::vector<Row> m_rows;
    QDoubleSpinBox *m_right, *m_up; ///< degrees, where the light comes from
    QPushButton* m_fromEye;
    bool m_showing = false; ///< the controls show, they do not edit
};

} // namespace pellucid::gui
