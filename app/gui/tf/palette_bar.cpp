#include "tf/palette_bar.h"

#include <QContextMenuEvent>
#include <QKeyEvent>
#include <QMenu>
#include <QPainter>

#include "controllers/refine_controller.h"
#include "services/services.h"
#include "widgets/controls.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kTop = 4;                                  // of the colours, pixels; the marker's head is above
constexpr double kHead = 5;                                 // half the width of the marker's head
constexpr double kStep = 1.0 / 128, kFineStep = 1.0 / 1024; // of the whole, by keys

} // namespace

PaletteBar::PaletteBar(Services& services, RefineController& refining, TfCanvas& canvas)
    : QWidget(&canvas), Spoken(*this, QAccessible::Slider), m_services(services), m_refining(refining),
      m_canvas(canvas) {
    setObjectName("paletteBar");
    setAccessibleName(tr("Palette"));
    setWhatsThis(
        tr("The colours of the values. A click refines the transfer function for the value clicked; arrow keys "
           "move the marker."));
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setCursor(Qt::PointingHandCursor);
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.series != after.series) m_dragging = false;
        if (!(before.tf == after.tf) || !(before.session.refine == after.session.refine)) update();
    });
    connect(&canvas.axis(), &IntensityAxis::changed, this, qOverload<>(&QWidget::update));
    connect(&canvas, &TfCanvas::arranged, this, &PaletteBar::place);
    place();
    connect(&services.selection(), &Selection::hoveredChanged, this, qOverload<>(&QWidget::update));
    const QString place = tr("Palette, below the curve");
    services.actions().addGestures({{place, tr("Click, drag"), tr("refine so that this value stands out")},
                                    {place, tr("Arrow keys (Shift: finer)"), tr("move what stands out")},
                                    {place, tr("Delete, Esc, right click"), tr("clear the priority")}});
}

void PaletteBar::place() {
    const QRectF strip = m_canvas.strip();
    setGeometry(0, static_cast<int>(strip.top()), m_canvas.width(), static_cast<int>(strip.height()));
}

QRectF PaletteBar::strip() const {
    const QRectF strip = m_canvas.strip(); // of a canvas that begins where this does
    return {strip.left(), kTop, strip.width(), height() - kTop};
}

QPointF PaletteBar::positionOf(double intensity) const {
    const QRectF r = strip();
    return {m_canvas.axis().toPixel(intensity, r), r.center().y()};
}

double PaletteBar::intensityAt(const QPointF& position) const {
    return m_canvas.axis().toIntensity(position.x(), strip());
}

QString PaletteBar::valueText(double intensity) const {
    const Volume& volume = *m_services.scene().volume;
    return numberText(volume.valueOfIntensity(intensity), volume.range().hi - volume.range().lo);
}

std::optional<double> PaletteBar::marked() const {
    const RefineSettings& favoured = *m_services.store().session().refine;
    const bool known = favoured.hue && m_services.scene().volume && !m_services.scene().colors;
    return known ? m_refining.options().priority.intensity : favoured.intensity;
}

void PaletteBar::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), theme::kWindow);
    if (!m_services.store().hasVolume()) return;
    const QRectF r = strip();
    const TfSampler sampler(m_services.scene().tf);
    for (double x = r.left(); x < r.right(); ++x) {
        const double width = std::min(1.0, r.right() - x);
        painter.fillRect(QRectF(x, r.top(), width, r.height()),
                         colorFromRgb(sampler.color(m_canvas.axis().toIntensity(x + width / 2, r))));
    }
    QFont small = font();
    small.setPointSizeF(small.pointSizeF() * 0.85);
    painter.setFont(small);
    painter.setPen(theme::kFaint);
    painter.drawText(QRectF(0, r.top(), r.left() - 5, r.height()), Qt::AlignRight | Qt::AlignVCenter, tr("palette"));
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(hasFocus() ? theme::kAccent : theme::kLine, 1));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(r.adjusted(-0.5, -0.5, 0.5, 0.5));
    const auto line = [&](double x, const QColor& color, double width) {
        painter.setPen(QPen(color, width));
        painter.drawLine(QPointF(x, r.top()), QPointF(x, r.bottom()));
    };
    const auto inside = [&](double x) { return x >= r.left() - 0.5 && x <= r.right() + 0.5; };
    if (const auto hovered = m_hovered ? m_hovered : m_services.selection().hoveredIntensity())
        if (const double x = positionOf(*hovered).x(); inside(x)) {
            line(x, QColor(0, 0, 0, 150), 3);
            line(x, QColor(255, 255, 255, 200), 1);
        }
    const double x = marked() ? positionOf(*marked()).x() : -1;
    if (!marked() || !inside(x)) return;
    line(x, QColor(0, 0, 0, 200), 4);
    line(x, Qt::white, 2);
    painter.setPen(QPen(QColor(0, 0, 0, 200), 1));
    painter.setBrush(QColor(Qt::white));
    painter.drawPolygon(QPolygonF({QPointF(x - kHead, 0.5), QPointF(x + kHead, 0.5), QPointF(x, r.top() + 1)}));
}

void PaletteBar::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !m_services.isEditable()) return event->ignore();
    if (m_dragging) return;
    m_dragging = true;
    m_refining.dragPriority(intensityAt(event->position()));
}

void PaletteBar::mouseMoveEvent(QMouseEvent* event) {
    if (!m_services.store().hasVolume()) return;
    m_hovered = intensityAt(event->position());
    m_services.selection().setHoveredIntensity(m_hovered);
    // A change that this drag did not make (undo, say) has ended it.
    if (m_dragging && !m_services.store().isPreviewing()) m_dragging = false;
    if (m_dragging) m_refining.dragPriority(*m_hovered);
    update();
}

void PaletteBar::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !m_dragging) return;
    m_dragging = false;
    m_refining.endDrag();
}

void PaletteBar::contextMenuEvent(QContextMenuEvent* event) {
    if (!m_services.isEditable() || m_dragging) return;
    const double x =
        event->reason() == QContextMenuEvent::Keyboard ? marked().value_or(0.5) : intensityAt(QPointF(event->pos()));
    QMenu menu(this);
    menu.setObjectName("paletteMenu");
    menu.addAction(tr("Refine for %1").arg(valueText(x)), this, [this, x] { m_refining.prioritize(x); });
    QAction* nothing =
        menu.addAction(tr("Clear the priority"), &m_refining, qOverload<>(&RefineController::prioritizeNothing));
    nothing->setEnabled(marked().has_value());
    menu.exec(event->globalPos());
}

void PaletteBar::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape && m_dragging) {
        m_dragging = false;
        return m_refining.cancelDrag();
    }
    if (!m_services.isEditable() || m_dragging) return QWidget::keyPressEvent(event);
    const double step = event->modifiers().testFlag(Qt::ShiftModifier) ? kFineStep : kStep;
    const auto go = [&](double x) { m_refining.prioritize(std::clamp(x, 0.0, 1.0), QStringLiteral("palette-keys")); };
    const double middle = m_canvas.axis().middle();
    switch (event->key()) {
    case Qt::Key_Left:
        return go(marked() ? *marked() - step : middle);
    case Qt::Key_Right:
        return go(marked() ? *marked() + step : middle);
    case Qt::Key_Home:
        return go(0);
    case Qt::Key_End:
        return go(1);
    case Qt::Key_Delete:
    case Qt::Key_Backspace:
    case Qt::Key_Escape:
        if (marked()) m_refining.prioritizeNothing();
        return;
    default:
        QWidget::keyPressEvent(event);
    }
}

void PaletteBar::leaveEvent(QEvent*) {
    m_hovered.reset();
    m_services.selection().setHoveredIntensity({});
    update();
}

QString PaletteBar::spokenValue() const {
    return m_services.store().hasVolume() && marked() ? tr("Prioritized: value %1").arg(valueText(*marked()))
                                                      : tr("No value is prioritized");
}

std::optional<SpokenNumber> PaletteBar::spokenNumber() {
    if (!m_services.isEditable() || !m_services.store().hasVolume() || !marked()) return {};
    const Volume& volume = *m_services.scene().volume;
    const ValueRange range = volume.range();
    return SpokenNumber{
        volume.valueOfIntensity(*marked()), range.lo, range.hi, kStep * (range.hi - range.lo),
        [this](double value) { m_refining.prioritize(m_services.scene().volume->intensityOfValue(value)); }};
}

bool PaletteBar::event(QEvent* event) {
    const auto tip = [this](const QPoint& position) {
        QString text = tr("Value %1. Click: refine so that this value stands out; drag: the picture follows")
                           .arg(valueText(intensityAt(QPointF(position))));
        if (marked()) text += "\n" + spokenValue() + tr("; Esc: nothing");
        return text;
    };
    return (m_services.store().hasVolume() && showsTip(*event, *this, tip)) || QWidget::event(event);
}

} // namespace pellucid::gui
