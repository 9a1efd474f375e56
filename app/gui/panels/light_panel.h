// The panel of light: what makes shapes visible. No figure depends on it.
#pragma once

#include <QWidget>

#include "render/render_settings.h"

class QAction;
class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QPushButton;

namespace pellucid::gui {

class Services;

class LightPanel : public QWidget {
    Q_OBJECT
public:
    /// `light` puts it on and off.
    LightPanel(Services& services, QAction& light, QWidget* parent = nullptr);

    QSize sizeHint() const override; ///< without scrolling

private:
    void addDirection(QFormLayout& form);
    void follow();
    void editDirection();

    Services& m_services;
    QCheckBox* m_on;
    QComboBox* m_preset;
    QDoubleSpinBox *m_right, *m_up; ///< degrees, where the light comes from
    QPushButton* m_fromEye;
};

} // namespace pellucid::gui
