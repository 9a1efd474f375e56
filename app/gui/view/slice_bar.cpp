#include "view/slice_bar.h"

#include <cmath>

#include <QSignalBlocker>
#include <QSlider>

#include "services/services.h"
#include "store/edits.h"
#include "store/view_edits.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/number_box.h"
#include "widgets/number_text.h"

namespace pellucid::gui {

SliceBar::SliceBar(Services& services, QWidget* parent)
    : QWidget(parent), m_services(services),
      m_strength(named(new QSlider(Qt::Horizontal, this), "sliceStrength",
                       tr("How much of the slices the transfer function colours, 0 (grey alone) to 100 %\n"
                          "(colours alone); it colours what is opaque"))),
      m_lo(named(new QDoubleSpinBox(this), "greyLo",
                 tr("Value that is black in the slices, in the units of the data; right drag in a slice"))),
      m_hi(named(new QDoubleSpinBox(this), "greyHi",
                 tr("Value that is white in the slices, in the units of the data; right drag in a slice"))),
      m_reset(named(toolButton(tr("Reset"), this), "greyReset",
                    tr("Black and white at the ends of the range of values; right double-click in a slice"))),
      m_ofField(new QLabel(tr("A field is shown: its colours and range are in the panel Fields"), this)) {
    setObjectName("sliceBar");
    m_ofField->setObjectName("sliceFieldNote");
    setAutoFillBackground(true);
    m_strength->setRange(0, 100);
    m_strength->setPageStep(10);
    m_strength->setFixedWidth(110);
    for (QDoubleSpinBox* box : {m_lo, m_hi}) {
        box->setKeyboardTracking(false);
        box->setRange(-1e300, 1e300);
        box->setFixedWidth(QFontMetrics(font()).horizontalAdvance("-00000.000") + 26);
        connect(box, &QDoubleSpinBox::valueChanged, this, [this, box] { editWindow(*box); });
    }
    auto* colors = new QLabel(tr("Co&lours"), this);
    colors->setBuddy(m_strength);
    auto* grey = new QLabel(tr("Gre&y"), this);
    grey->setBuddy(m_lo);
    auto* to = new QLabel(QString(QChar(0x2013)), this);
    setLayout(inset(rowOf({colors, m_strength, Cell::gap(10), grey, m_lo, to, m_hi, m_reset, Cell::gap(10), m_ofField,
                           Cell::rest()},
                          6),
                    {8, 3, 8, 3}));
    connect(m_strength, &QSlider::valueChanged, this, &SliceBar::editStrength);
    connect(m_strength, &QSlider::sliderReleased, this, [this] { m_services.store().commit(); });
    connect(m_reset, &QToolButton::clicked, this, [this] { resetGreyWindow(m_services.store()); });
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || !before.session.slices.isSame(after.session.slices) ||
            !before.session.field.isSame(after.session.field))
            follow();
    });
    connect(&services, &Services::readOnlyChanged, this, &SliceBar::follow);
    follow();
}

void SliceBar::editStrength(int percent) {
    const QString text = tr("Colours of the slices");
    const auto change = changing(&Session::slices, [percent](SliceViews& s) { s.tfStrength = percent / 100.0; });
    if (m_strength->isSliderDown())
        m_services.store().preview(text, change);
    else
        m_services.store().edit(text, "sliceStrength", change);
}

void SliceBar::editWindow(const QDoubleSpinBox& box) {
    ValueRange window = greyWindowOf(m_services.scene());
    (&box == m_lo ? window.lo : window.hi) = box.value(); // the other box shows a rounded number
    if (!(window.lo < window.hi)) return follow();        // nothing lies between them
    editPart(m_services.store(), &Session::slices, tr("Window of grey"), "greyWindow",
             [&](SliceViews& s) { s.window = window; });
}

void SliceBar::follow() {
    if (!m_services.store().hasVolume()) return;
    const Scene& scene = m_services.scene();
    const bool field = scene.session.field->kind.has_value();
    for (QWidget* widget : std::initializer_list<QWidget*>{m_strength, m_lo, m_hi})
        widget->setEnabled(!m_services.isReadOnly() && !field);
    m_ofField->setVisible(field);
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
    m_reset->setEnabled(!m_services.isReadOnly() && !field && scene.session.slices->window.has_value());
}

} // namespace pellucid::gui
