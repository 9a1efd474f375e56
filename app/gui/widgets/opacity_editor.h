// A slider and a number for one opacity, fine near zero.
#pragma once

#include <QWidget>

class QDoubleSpinBox;
class QSlider;

namespace pellucid::gui {

/// The slider's position is √α, so that a third of it covers opacities up to 0.1.
class OpacityEditor : public QWidget {
    Q_OBJECT
public:
    explicit OpacityEditor(QWidget* parent = nullptr);

    double opacity() const { return m_opacity; }
    void setOpacity(double opacity); ///< shows it; emits nothing

Q_SIGNALS:
    void dragged(double opacity); ///< while the slider is held
    void released();              ///< the end of a drag
    void edited(double opacity);  ///< typed, or by keys and wheel

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    QSlider* m_slider;
    QDoubleSpinBox* m_spin;
    double m_opacity = 0;
};

} // namespace pellucid::gui
