#include "panels/time_strip.h"

#include <algorithm>
#include <cmath>

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include "widgets/controls.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kBins = 64;
constexpr double kMargin = 6, kMarks = 13, kHeld = 3; // pixels: at the sides, the row of marks, the line below

} // namespace

TimeStrip::TimeStrip(QWidget* parent) : QWidget(parent), Spoken(*this, QAccessible::Slider) {
    setObjectName("timeStrip");
    setAccessibleName(tr("Time histogram"));
    setWhatsThis(
        tr("The histograms of all frames, with their keys. A click or a drag goes to a frame, and so do the arrow "
           "keys."));
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void TimeStrip::setSeries(std::shared_ptr<const TimeSeries> series, const ValueRange& window) {
    if (series == m_series && window == m_window) return;
    m_series = std::move(series);
    m_window = window;
    m_counts.assign(static_cast<std::size_t>(count()), {});
    m_marks.resize(static_cast<std::size_t>(count()));
    m_dragging = false;
    refresh();
}

void TimeStrip::setFrame(int frame, std::optional<int> awaited) {
    if (frame == m_frame && awaited == m_awaited) return;
    m_frame = frame;
    m_awaited = awaited;
    update();
}

void TimeStrip::setMarks(std::vector<FrameMark> marks) {
    marks.resize(static_cast<std::size_t>(count()));
    if (marks == m_marks) return;
    m_marks = std::move(marks);
    update();
}

void TimeStrip::refresh() {
    bool more = m_image.isNull() || m_image.width() != std::max(1, count());
    for (std::size_t f = 0; f < m_counts.size(); ++f) {
        if (!m_counts[f].empty()) continue;
        m_counts[f] = m_series->countsIn(static_cast<int>(f), m_window, kBins);
        more = more || !m_counts[f].empty();
    }
    if (more) draw();
}

void TimeStrip::draw() {
    m_image = QImage(std::max(1, count()), kBins, QImage::Format_ARGB32);
    m_image.fill(Qt::transparent);
    double most = 1;
    for (const auto& counts : m_counts)
        for (const double c : counts) most = std::max(most, c);
    const double scale = 1 / std::log1p(most);
    for (std::size_t f = 0; f < m_counts.size(); ++f)
        for (std::size_t b = 0; b < m_counts[f].size(); ++b)
            m_image.setPixelColor(static_cast<int>(f), kBins - 1 - static_cast<int>(b),
                                  between(theme::kPanel, theme::kCurve, std::log1p(m_counts[f][b]) * scale));
    update();
}

QRectF TimeStrip::plot() const {
    return {kMargin, kMarks, std::max(1.0, width() - 2 * kMargin), std::max(1.0, height() - kMarks - kHeld - 2)};
}

QRectF TimeStrip::rectOf(int frame) const {
    const QRectF r = plot();
    const double step = r.width() / std::max(1, count());
    return {r.left() + frame * step, r.top(), step, r.height()};
}

int TimeStrip::frameAt(double x) const {
    const QRectF r = plot();
    return std::clamp(static_cast<int>(std::floor((x - r.left()) / r.width() * count())), 0, std::max(0, count() - 1));
}

void TimeStrip::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const QRectF r = plot();
    painter.fillRect(r, theme::kPanel);
    if (count() == 0) return;
    painter.drawImage(r, m_image);
    painter.setPen(QPen(theme::kLine, 1));
    painter.drawRect(r);
    painter.setRenderHint(QPainter::Antialiasing);
    for (int f = 0; f < count(); ++f) paintState(painter, f);
    for (int f = 0; f < count(); ++f) paintKeys(painter, f); // over the bars
    painter.setBrush(Qt::NoBrush);
    const auto upright = [&](int frame, const QPen& pen) {
        painter.setPen(pen);
        const double x = rectOf(frame).center().x();
        painter.drawLine(QPointF(x, r.top()), QPointF(x, r.bottom()));
        return x;
    };
    if (m_hovered >= 0) upright(m_hovered, QPen(theme::kFaint, 1));
    if (m_awaited) upright(*m_awaited, QPen(theme::kAccent, 1, Qt::DotLine));
    const double x = upright(m_frame, QPen(theme::kAccent, 2));
    painter.setPen(QPen(theme::kKnob, 1));
    painter.setBrush(theme::kAccent);
    painter.drawPolygon(
        QPolygonF{{x - 5, r.bottom() + kHeld + 2}, {x, r.bottom() - 5}, {x + 5, r.bottom() + kHeld + 2}});
    if (hasFocus()) {
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(theme::kAccent, 1));
        painter.drawRect(r.adjusted(-1, -1, 1, 1));
    }
}

/// Whether it can be shown, would be shown at once, and has a transfer function of its own.
void TimeStrip::paintState(QPainter& painter, int frame) const {
    const FrameMark& mark = m_marks[static_cast<std::size_t>(frame)];
    const QRectF c = rectOf(frame);
    if (!mark.problem.isEmpty()) {
        painter.fillRect(c, QBrush(theme::kFalls, Qt::BDiagPattern));
        painter.setPen(QPen(theme::kFalls, 1.5));
        const QPointF m(c.center().x(), kMarks / 2);
        painter.drawLine(m + QPointF(-3, -3), m + QPointF(3, 3));
        painter.drawLine(m + QPointF(-3, 3), m + QPointF(3, -3));
    }
    if (mark.adapted) // a bar under the marks; pale where it is of other inputs
        painter.fillRect(QRectF(c.left(), kMarks - 3, c.width(), 2),
                         translucent(theme::kAccent, mark.stale ? 0.35 : 1));
    if (mark.held) painter.fillRect(QRectF(c.left(), c.bottom() + 2, c.width(), kHeld - 1), theme::kFaint);
}

void TimeStrip::paintKeys(QPainter& painter, int frame) const {
    const FrameMark& mark = m_marks[static_cast<std::size_t>(frame)];
    const double x = rectOf(frame).center().x(), y = kMarks / 2 - 1;
    painter.setPen(QPen(theme::kKnob, 1.2));
    if (mark.tfKey) {
        painter.setBrush(theme::kAccent);
        painter.drawPolygon(QPolygonF{{x - 4, y}, {x, y - 4.5}, {x + 4, y}, {x, y + 4.5}});
    }
    if (mark.targetKey) {
        painter.setBrush(Qt::NoBrush);
        painter.drawEllipse(QPointF(x, y), 5.5, 5.5);
    }
}

QString TimeStrip::tipAt(const QPointF& at) const {
    if (count() == 0) return {};
    const int f = frameAt(at.x());
    const FrameMark& mark = m_marks[static_cast<std::size_t>(f)];
    QStringList lines{
        tr("%1 (%L2 of %L3)").arg(QString::fromStdString(m_series->listing().label(f))).arg(f + 1).arg(count())};
    const QRectF r = plot();
    const auto& counts = m_counts[static_cast<std::size_t>(f)];
    if (r.contains(at) && !counts.empty()) {
        const double s = std::clamp((r.bottom() - at.y()) / r.height(), 0.0, 1.0);
        const double span = m_window.hi - m_window.lo;
        const auto bin = static_cast<std::size_t>(std::min<double>(kBins - 1, s * kBins));
        lines << tr("about %L1 voxels of values around %2")
                     .arg(static_cast<qint64>(std::llround(counts[bin])))
                     .arg(numberText(m_window.lo + s * span, span));
    } else if (counts.empty() && mark.problem.isEmpty()) {
        lines << tr("not read yet");
    }
    return (lines << marksOf(f)).join('\n');
}

QStringList TimeStrip::marksOf(int frame) const {
    const FrameMark& mark = m_marks[static_cast<std::size_t>(frame)];
    QStringList lines;
    if (!mark.problem.isEmpty()) lines << tr("left out: %1").arg(mark.problem);
    if (mark.tfKey) lines << tr("key: a transfer function made by hand");
    if (mark.targetKey) lines << tr("key: targets of its own");
    if (mark.adapted)
        lines << (mark.stale ? tr("its transfer function is out of date and will be recomputed")
                             : tr("a transfer function was made for it"));
    return lines;
}

QString TimeStrip::spokenValue() const {
    if (m_frame >= count()) return tr("There is no series");
    QStringList parts{tr("frame %L1 of %L2, %3")
                          .arg(m_frame + 1)
                          .arg(count())
                          .arg(QString::fromStdString(m_series->listing().label(m_frame)))};
    if (m_awaited) parts << tr("frame %L1 is awaited").arg(*m_awaited + 1);
    return (parts << marksOf(m_frame)).join("; ");
}

std::optional<SpokenNumber> TimeStrip::spokenNumber() {
    if (count() == 0) return {};
    return SpokenNumber{m_frame + 1.0, 1, static_cast<double>(count()), 1,
                        [this](double frame) { Q_EMIT frameWanted(static_cast<int>(std::lround(frame)) - 1); }};
}

bool TimeStrip::event(QEvent* event) {
    if (event->type() == QEvent::PaletteChange) draw();
    return showsTip(*event, *this, [this](const QPoint& at) { return tipAt(at); }) || QWidget::event(event);
}

void TimeStrip::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || count() == 0) return event->ignore();
    m_dragging = true;
    Q_EMIT frameWanted(frameAt(event->position().x()));
}

void TimeStrip::mouseMoveEvent(QMouseEvent* event) {
    if (count() == 0) return;
    const int f = frameAt(event->position().x());
    if (m_dragging && f != m_awaited.value_or(m_frame)) Q_EMIT frameWanted(f);
    if (f != m_hovered) {
        m_hovered = f;
        update();
    }
}

void TimeStrip::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) m_dragging = false;
}

void TimeStrip::leaveEvent(QEvent*) {
    m_hovered = -1;
    update();
}

void TimeStrip::wheelEvent(QWheelEvent* event) {
    if (event->angleDelta().y() == 0) return event->ignore();
    Q_EMIT stepWanted(event->angleDelta().y() > 0 ? -1 : 1);
    event->accept();
}

void TimeStrip::keyPressEvent(QKeyEvent* event) {
    switch (event->key()) {
    case Qt::Key_Left:
        return Q_EMIT stepWanted(-1);
    case Qt::Key_Right:
        return Q_EMIT stepWanted(1);
    case Qt::Key_PageUp:
        return Q_EMIT stepWanted(-10);
    case Qt::Key_PageDown:
        return Q_EMIT stepWanted(10);
    default:
        return QWidget::keyPressEvent(event);
    }
}

} // namespace pellucid::gui
