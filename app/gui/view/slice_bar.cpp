#include "view/slice_bar.h"

#include <cmath>

#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSlider>
#include <QToolButton>

#include "services/services.h"
#include "store/view_edits.h"
#include "widgets/number_box.h"
#include "widgets/number_text.h"

namespace pellucid::gui {

SliceBar::SliceBar(Services& services, QWidget* parent)
    : QWidget(parent), m_services(services), m_strength(new QSlider(Qt::Horizontal, this)),
      m_lo(new QDoubleSpinBox(this)), m_hi(new QDoubleSpinBox(this)), m_reset(new QToolButton(this)) {
    setObjectName("sliceBar");
    setAutoFillBackground(true);
    m_strength->setObjectName("sliceStrength");
    m_strength->setRange(0, 100);
    m_strength->setPageStep(10);
    m_strength->setFixedWidth(110);
    m_strength->setToolTip(tr("How much of the slices the transfer function colours, 0 (grey alone) to 100 %\n"
                              "(colours alone); it colours what is opaque"));
    m_lo->setObjectName("greyLo");
    m_hi->setObjectName("greyHi");
    m_lo->setToolTip(tr("Value that is black in the slices, in the units of the data; right drag in a slice"));
    m_hi->setToolTip(tr("Value that is white in the slices, in the units of the data; right drag in a slice"));
    for (QDoubleSpinBox* box : {m_lo, m_hi}) {
        box->setKeyboardTracking(false);
        box->setRange(-1e300, 1e300);
        box->setFixedWidth(QFontMetrics(font()).horizontalAdvance("-00000.000") + 26);
        connect(box, &QDoubleSpinBox::valueChanged, this, &SliceBar::editWindow);
    }
    m_reset->setObjectName("greyReset");
    m_reset->setText(tr("Reset"));
    m_reset->setToolTip(tr("Black and white at the ends of the range of values; right double-click in a slice"));
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(8, 3, 8, 3);
    row->setSpacing(6);
    auto* colors = new QLabel(tr("Co&lours"), this);
    colors->setBuddy(m_strength);
    auto* grey = new QLabel(tr("Gre&y"), this);
    grey->setBuddy(m_lo);
    row->addWidget(colors);
    row->addWidget(m_strength);
    row->addSpacing(10);
    row->addWidget(grey);
    row->addWidget(m_lo);
    row->addWidget(new QLabel(QString(QChar(0x2013)), this));
    row->addWidget(m_hi);
    row->addWidget(m_reset);
    row->addStretch(1);
    connect(m_strength, &QSlider::valueChanged, this, &SliceBar::editStrength);
    connect(m_strength, &QSlider::sliderReleased, this, [this] { m_services.store().commit(); });
    connect(m_reset, &QToolButton::clicked, this, [this] { resetGreyWindow(m_services.store()); });
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || !before.session.slices.isSame(after.session.slices)) follow();
    });
    connect(&services, &Services::readOnlyChanged, this, &SliceBar::follow);
    follow();
}

void SliceBar::editStrength(int percent) {
    const QString text = tr("Colours of the slices");
    const auto change = [percent](Session& session) {
        session.slices.edit([percent](SliceViews& s) { s.tfStrength = percent / 100.0; });
    };
    if (m_strength->isSliderDown())
        m_services.store().preview(text, change);
    else
        m_services.store().edit(text, "sliceStrength", change);
}

void SliceBar::editWindow() {
    ValueRange window = greyWindowOf(m_services.scene());
    // Only the box that was edited counts: the other one shows a rounded number.
    (sender() == m_lo ? window.lo : window.hi) = sender() == m_lo ? m_lo->value() : m_hi->value();
    if (!(window.lo < window.hi)) return follow(); // nothing lies between them
    m_services.store().edit(tr("Window of grey"), "greyWindow",
                            [&](Session& session) { session.slices.edit([&](SliceViews& s) { s.window = window; }); });
}

void SliceBar::follow() {
    if (!m_services.store().hasVolume()) return;
    const Scene& scene = m_services.scene();
    setEnabled(!m_services.isReadOnly());
    const QSignalBlocker quiet(m_strength), low(m_lo), high(m_hi);
    if (!m_strength->isSliderDown())
        m_strength->setValue(static_cast<int>(std::lround(100 * scene.session.slices->tfStrength)));
    const ValueRange window = greyWindowOf(scene), all = scene.data->range();
    const double span = all.hi - all.lo;
    for (QDoubleSpinBox* box : {m_lo, m_hi}) {
        box->setDecimals(decimalsFor(span));
        box->setSingleStep(span > 0 ? span / 100 : 1);
    }
    showNumber(*m_lo, window.lo);
    showNumber(*m_hi, window.hi);
    m_reset->setEnabled(scene.session.slices->window.has_value());
}

} // namespace pellucid::gui
