#include "density_slider.h"

#include <cmath>

#include <QEvent>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QSignalBlocker>
#include <QSlider>

#include "store/edits.h"
#include "tf/edit.h"

namespace pellucid::gui {
namespace {

constexpr double kPerDoubling = 100;

}

DensitySlider::DensitySlider(SessionStore& store, QWidget* parent)
    : QWidget(parent), m_store(store), m_slider(new QSlider(Qt::Horizontal, this)), m_factor(new QLabel(this)) {
    setObjectName("densityRow");
    m_slider->setObjectName("densitySlider");
    const int reach = static_cast<int>(std::lround(std::log2(kMostDensity) * kPerDoubling));
    m_slider->setRange(-reach, reach);
    m_slider->setSingleStep(10);
    m_slider->setPageStep(100);
    m_slider->setMinimumWidth(80);
    m_slider->setFocusPolicy(Qt::StrongFocus);
    m_slider->installEventFilter(this);
    m_factor->setObjectName("densityFactor");
    m_factor->setFixedWidth(m_factor->fontMetrics().horizontalAdvance(QStringLiteral("× 00.00")) + 4);
    m_factor->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    auto* label = new QLabel(tr("&Density"), this);
    label->setBuddy(m_slider);
    for (QWidget* widget : std::initializer_list<QWidget*>{label, m_slider, m_factor}) {
        widget->setToolTip(tr("Multiplies the extinction: everything denser or thinner; the shares change little.\n"
                              "Drag it, let go, drag on; Escape gives it up"));
    }
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(6);
    row->addWidget(label);
    row->addWidget(m_slider, 1);
    row->addWidget(m_factor);
    connect(m_slider, &QSlider::valueChanged, this, &DensitySlider::follow);
    connect(m_slider, &QSlider::sliderReleased, this, [this] {
        m_store.commit();
        springBack();
    });
    springBack();
}

double DensitySlider::factor() const { return std::exp2(m_slider->value() / kPerDoubling); }

void DensitySlider::follow() {
    if (m_givenUp || !m_store.hasVolume()) return springBack();
    m_factor->setText(QStringLiteral("× %1").arg(factor(), 0, 'f', 2));
    const TransferFunction& start = m_store.committed().tf;
    if (m_slider->isSliderDown()) {
        previewTf(m_store, withDensity(start, factor()), tr("Density"));
    } else {
        m_store.commit();
        editTf(m_store, withDensity(m_store.scene().tf, factor()), tr("Density"), QStringLiteral("density"));
        springBack();
    }
}

void DensitySlider::springBack() {
    const QSignalBlocker blocker(m_slider);
    m_slider->setValue(0);
    m_factor->setText(QStringLiteral("× 1.00"));
}

bool DensitySlider::eventFilter(QObject* watched, QEvent* event) {
    // The wheel scrolls the panel; it must not change a picture in passing.
    if (event->type() == QEvent::Wheel && !m_slider->hasFocus()) {
        event->ignore();
        return true;
    }
    // A second click finds the slider where the first has left it, at × 1: it must not jump to the mouse.
    if (event->type() == QEvent::MouseButtonDblClick) return true;
    if (event->type() == QEvent::MouseButtonRelease) m_givenUp = false;
    if (event->type() == QEvent::KeyPress && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape &&
        m_slider->isSliderDown()) {
        {
            const QSignalBlocker blocker(m_slider); // released, but not let go
            m_slider->setSliderDown(false);
        }
        m_givenUp = true;
        m_store.cancel();
        springBack();
        return true;
    }
    return QWidget::eventFilter(watched, event);
}

} // namespace pellucid::gui
