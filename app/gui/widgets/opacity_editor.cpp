#include "widgets/opacity_editor.h"

#include <algorithm>
#include <cmath>

#include <QDoubleSpinBox>
#include <QEvent>
#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QSlider>

namespace pellucid::gui {
namespace {

constexpr int kSteps = 1000;

}

OpacityEditor::OpacityEditor(QWidget* parent)
    : QWidget(parent), m_slider(new QSlider(Qt::Horizontal, this)), m_spin(new QDoubleSpinBox(this)) {
    setObjectName("opacityEditor");
    setAutoFillBackground(true);
    m_slider->setObjectName("opacitySlider");
    m_slider->setRange(0, kSteps);
    m_slider->setSingleStep(10);
    m_slider->setPageStep(50);
    m_slider->setMinimumWidth(60);
    m_spin->setObjectName("opacitySpin");
    m_spin->setRange(0, 1);
    m_spin->setDecimals(4);
    m_spin->setSingleStep(0.01);
    m_spin->setKeyboardTracking(false);
    m_spin->setFrame(false);
    m_spin->setButtonSymbols(QAbstractSpinBox::NoButtons);
    m_spin->setFixedWidth(QFontMetrics(font()).horizontalAdvance("0.0000") + 14);
    for (QWidget* widget : std::initializer_list<QWidget*>{m_slider, m_spin}) {
        widget->setToolTip(tr("Highest opacity of the feature: opacity of a path one voxel long (d0).\n"
                              "The slider is finer near zero."));
    }
    // The wheel scrolls the table; it must not change an opacity in passing.
    for (QWidget* widget : std::initializer_list<QWidget*>{m_slider, m_spin}) {
        widget->setFocusPolicy(Qt::StrongFocus);
        widget->installEventFilter(this);
    }
    setFocusProxy(m_slider);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(4, 0, 2, 0);
    row->setSpacing(4);
    row->addWidget(m_slider, 1);
    row->addWidget(m_spin);
    connect(m_slider, &QSlider::valueChanged, this, [this](int value) {
        const double root = static_cast<double>(value) / kSteps;
        m_opacity = root * root;
        const QSignalBlocker blocker(m_spin);
        m_spin->setValue(m_opacity);
        if (m_slider->isSliderDown()) {
            Q_EMIT dragged(m_opacity);
        } else {
            Q_EMIT edited(m_opacity);
        }
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
