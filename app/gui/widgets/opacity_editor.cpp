#include "widgets/opacity_editor.h"

#include <algorithm>
#include <cmath>

#include <QEvent>
#include <QSignalBlocker>
#include <QSlider>

#include "widgets/controls.h"
#include "widgets/layouts.h"

namespace pellucid::gui {
namespace {

constexpr int kSteps = 1000;

}

OpacityEditor::OpacityEditor(QWidget* parent)
    : QWidget(parent), m_slider(named(new QSlider(Qt::Horizontal, this), "opacitySlider")),
      m_spin(named(new QDoubleSpinBox(this), "opacitySpin")) {
    setObjectName("opacityEditor");
    setAutoFillBackground(true);
    m_slider->setRange(0, kSteps);
    m_slider->setSingleStep(10);
    m_slider->setPageStep(50);
    m_slider->setMinimumWidth(60);
    withLook(m_spin, {.decimals = 4, .step = 0.01});
    m_spin->setFrame(false);
    m_spin->setButtonSymbols(QAbstractSpinBox::NoButtons);
    m_spin->setFixedWidth(QFontMetrics(font()).horizontalAdvance("0.0000") + 14);
    for (QWidget* widget : std::initializer_list<QWidget*>{m_slider, m_spin}) {
        widget->setAccessibleName(tr("Opacity"));
        widget->setToolTip(tr("Highest opacity of the feature: opacity of a path one voxel long (d0).\n"
                              "The slider is finer near zero."));
        // The wheel scrolls the table; it must not change an opacity in passing.
        widget->setFocusPolicy(Qt::StrongFocus);
        widget->installEventFilter(this);
    }
    setFocusProxy(m_slider);
    setLayout(inset(rowOf({{m_slider, 1}, m_spin}, 4), {4, 0, 2, 0}));
    connect(m_slider, &QSlider::valueChanged, this, [this](int value) {
        const double root = static_cast<double>(value) / kSteps;
        m_opacity = root * root;
        const QSignalBlocker blocker(m_spin);
        m_spin->setValue(m_opacity);
        if (m_slider->isSliderDown())
            Q_EMIT dragged(m_opacity);
        else
            Q_EMIT edited(m_opacity);
    });
    connect(m_slider, &QSlider::sliderReleased, this, &OpacityEditor::released);
    connect(m_spin, &QDoubleSpinBox::valueChanged, this, [this](double value) {
        setOpacity(value);
        Q_EMIT edited(value);
    });
}

bool OpacityEditor::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::Wheel && !static_cast<QWidget*>(watched)->hasFocus()) {
        event->ignore();
        return true;
    }
    return QWidget::eventFilter(watched, event);
}

void OpacityEditor::setOpacity(double opacity) {
    m_opacity = std::clamp(opacity, 0.0, 1.0);
    const QSignalBlocker blockSlider(m_slider), blockSpin(m_spin);
    if (!m_slider->isSliderDown()) m_slider->setValue(static_cast<int>(std::lround(std::sqrt(m_opacity) * kSteps)));
    m_spin->setValue(m_opacity);
}

} // namespace pellucid::gui
