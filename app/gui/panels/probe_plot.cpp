#include "panels/probe_plot.h"

#include <algorithm>
#include <cmath>

#include <QMouseEvent>
#include <QPainter>

#include <glm/geometric.hpp>

#include "controllers/probe_controller.h"
#include "services/services.h"
#include "widgets/controls.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kPlotRow = 22, kStrip = 6;

QString unitOf(const Scene& scene) { return QString::fromUtf8(lengthUnit(scene.volume->geometry())); }

/// −1: of what is in none.
QString nameOf(const ProbeController& probe, int feature) {
    if (feature < 0) return QObject::tr("in no feature");
    return QString::fromStdString(probe.tf().features[static_cast<std::size_t>(feature)].name);
}

QString percentText(double share) { return QStringLiteral("%1 %").arg(100 * share, 0, 'f', 1); }

} // namespace

ProbePlot::ProbePlot(Services& services, ProbeController& probe, QWidget* parent)
    : QWidget(parent), Spoken(*this, QAccessible::Chart), m_services(services), m_probe(probe) {
    setObjectName("probePlot");
    setAccessibleName(tr("Values and opacity along the ray"));
    setMouseTracking(true);
    setToolTip(tr("Along the ray, from where it enters the volume at the left (depth in\n"
                  "the unit of the volume).\n"
                  "Area: the values, in the colours of the transfer function. Line: the opacity, 0 to 1,\n"
                  "that has accumulated. Below: which feature it is in."));
}

QString ProbePlot::valueText(const Scene& scene, double value) {
    const ValueRange range = scene.volume->range();
    const std::string unit = scene.unit.value_or("");
    return numberText(value, range.hi - range.lo) + (unit.empty() ? QString() : ' ' + QString::fromStdString(unit));
}

QRectF ProbePlot::plot() const {
    const int line = fontMetrics().height();
    return QRectF(rect()).adjusted(6, 4 + line, -6, -(line + kStrip + 8));
}

double ProbePlot::length() const { return m_probe.ray().samples.back().t; }
double ProbePlot::depthAt(double x) const {
    return std::clamp((x - plot().left()) / std::max(1.0, plot().width()), 0.0, 1.0) * length();
}
double ProbePlot::xOf(double depth) const { return plot().left() + depth / length() * plot().width(); }

const ProbeSample& ProbePlot::sampleAt(double depth) const {
    const auto& samples = m_probe.ray().samples;
    const auto next =
        std::lower_bound(samples.begin(), samples.end(), depth, [](const ProbeSample& s, double t) { return s.t < t; });
    if (next == samples.end()) return samples.back();
    return next == samples.begin() || next->t - depth < depth - (next - 1)->t ? *next : *(next - 1);
}

void ProbePlot::paintEvent(QPaintEvent*) {
    if (!m_probe.isActive()) return;
    const RayProbe& ray = m_probe.ray();
    const QRectF box = plot();
    QPainter painter(this);
    const QColor text = palette().color(QPalette::Text);
    painter.fillRect(box, palette().color(QPalette::Base));
    paintValues(painter);
    painter.setRenderHint(QPainter::Antialiasing);

    QPolygonF opacity;
    for (const ProbeSample& s : ray.samples) opacity << QPointF(xOf(s.t), box.bottom() - s.opacity * box.height());
    painter.setPen(QPen(palette().color(QPalette::Base), 4));
    painter.drawPolyline(opacity);
    painter.setPen(QPen(text, 2));
    painter.drawPolyline(opacity);

    painter.setPen(Qt::NoPen);
    for (const ProbeRun& run : ray.runs) {
        if (run.feature < 0) continue;
        const double left = xOf(run.begin), right = std::max(xOf(run.end), left + 1);
        const QColor color = colorFromRgb(m_probe.tf().features[static_cast<std::size_t>(run.feature)].color);
        painter.fillRect(QRectF(left, box.bottom() + 3, right - left, kStrip),
                         translucent(color, run.feature == m_probe.feature() ? 1 : 0.55));
    }

    // Where the mark is, and the mouse.
    const auto upright = [&](double t, const QPen& pen) {
        painter.setPen(pen);
        painter.drawLine(QPointF(xOf(t), box.top()), QPointF(xOf(t), box.bottom()));
    };
    const double place = glm::length(m_probe.place() - ray.entry);
    if (place <= length()) upright(place, QPen(text, 1, Qt::DashLine));
    if (m_hovered) upright(*m_hovered, QPen(palette().color(QPalette::Highlight), 1.5));
    paintAxes(painter);
}

QString ProbePlot::spokenValue() const {
    if (!m_probe.isActive()) return tr("Nothing is probed");
    QStringList parts;
    for (const ProbeRun& run : m_probe.ray().runs)
        parts << tr("%1 from %2 to %3 %4")
                     .arg(nameOf(m_probe, run.feature), numberText(run.begin, length()), numberText(run.end, length()),
                          unitOf(m_services.scene()));
    return (parts << tr("opacity %1").arg(percentText(m_probe.ray().alpha))).join("; ");
}

/// A column per pixel, as high as the intensity.
void ProbePlot::paintValues(QPainter& painter) const {
    const QRectF box = plot();
    const TfSampler sampler(m_probe.tf());
    QPolygonF outline;
    for (double x = box.left() + 0.5; x < box.right(); ++x) {
        const double s = sampleAt(depthAt(x)).intensity;
        if (std::isnan(s)) continue;
        const double top = box.bottom() - s * box.height();
        painter.fillRect(QRectF(x - 0.5, top, 1, box.bottom() - top),
                         translucent(colorFromRgb(sampler.color(s)), sampler.opacity(s) > 0 ? 0.85 : 0.25));
        outline << QPointF(x, top);
    }
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(palette().color(QPalette::PlaceholderText), 1));
    painter.drawPolyline(outline);
}

void ProbePlot::paintAxes(QPainter& painter) const {
    const QRectF box = plot();
    const ValueRange range = m_services.scene().volume->range();
    const QRectF above(box.left(), 0, box.width(), box.top() - 2),
        below(box.left(), box.bottom() + kStrip + 5, box.width(), height() - box.bottom() - kStrip - 5);
    painter.setPen(palette().color(QPalette::PlaceholderText));
    painter.drawText(above, Qt::AlignLeft | Qt::AlignVCenter, tr("value %1").arg(rangeText(range)));
    painter.drawText(above, Qt::AlignRight | Qt::AlignVCenter, tr("opacity 0 – 1"));
    painter.drawText(below, Qt::AlignLeft | Qt::AlignTop, QStringLiteral("0"));
    painter.drawText(below, Qt::AlignRight | Qt::AlignTop,
                     tr("depth %1 %2").arg(numberText(length(), length()), unitOf(m_services.scene())));
}

void ProbePlot::mouseMoveEvent(QMouseEvent* event) {
    event->accept();
    if (!m_probe.isActive()) return;
    m_hovered = depthAt(event->position().x());
    const ProbeSample& s = sampleAt(*m_hovered);
    const Volume& volume = *m_services.scene().volume;
    QString value = tr("invalid");
    std::optional<double> hovered;
    if (!std::isnan(s.intensity)) {
        const int f = featureAt(m_probe.tf().features, s.intensity);
        value = valueText(m_services.scene(), volume.valueOfIntensity(s.intensity));
        if (f >= 0) value += QStringLiteral(" (%1)").arg(nameOf(m_probe, f));
        hovered = s.intensity;
    }
    m_services.selection().setHoveredIntensity(hovered);
    Q_EMIT readOut(tr("depth %1 %2: value %3, opacity %4")
                       .arg(numberText(s.t, length()), unitOf(m_services.scene()), value, percentText(s.opacity)));
    update();
}

void ProbePlot::leaveEvent(QEvent*) {
    m_hovered.reset();
    m_services.selection().setHoveredIntensity({});
    Q_EMIT readOut({});
    update();
}

ProbeShares::ProbeShares(Services& services, ProbeController& probe, QWidget* parent)
    : QWidget(parent), Spoken(*this, QAccessible::Chart), m_services(services), m_probe(probe) {
    setObjectName("probeShares");
    setAccessibleName(tr("Shares of the pixel"));
    setCursor(Qt::PointingHandCursor);
}

std::vector<ProbeShares::Row> ProbeShares::rows() const {
    std::vector<Row> rows;
    if (!m_probe.isActive()) return rows;
    const RayProbe& ray = m_probe.ray();
    for (std::size_t f = 0; f < ray.shares.size(); ++f) {
        const bool isMet = std::any_of(ray.runs.begin(), ray.runs.end(),
                                       [f](const ProbeRun& r) { return r.feature == static_cast<int>(f); });
        if (isMet) rows.push_back({static_cast<int>(f), ray.shares[f], percentText(ray.shares[f])});
    }
    if (ray.rest > 0) rows.push_back({-1, ray.rest, percentText(ray.rest)});
    return rows;
}

QRect ProbeShares::rowRect(int row) const { return {0, row * kPlotRow, width(), kPlotRow}; }
QSize ProbeShares::sizeHint() const { return {300, kPlotRow * std::max(1, static_cast<int>(rows().size()))}; }

void ProbeShares::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const auto all = rows();
    const int percent = fontMetrics().horizontalAdvance("100.0 % ");
    for (int i = 0; i < static_cast<int>(all.size()); ++i) {
        const Row& row = all[static_cast<std::size_t>(i)];
        const QRect box = rowRect(i);
        if (row.feature >= 0 && row.feature == m_probe.feature())
            painter.fillRect(box, translucent(palette().color(QPalette::Highlight), 0.3));
        QColor color = palette().color(QPalette::Mid);
        if (row.feature >= 0) color = colorFromRgb(m_probe.tf().features[static_cast<std::size_t>(row.feature)].color);
        painter.fillRect(QRect(box.left() + 4, box.top() + 5, 12, kPlotRow - 10), color);
        const int nameWidth = box.width() * 2 / 5 - 22;
        painter.setPen(palette().color(QPalette::Text));
        painter.drawText(QRect(box.left() + 22, box.top(), nameWidth, kPlotRow), Qt::AlignLeft | Qt::AlignVCenter,
                         fontMetrics().elidedText(nameOf(m_probe, row.feature), Qt::ElideRight, nameWidth));
        const QRectF bar(box.left() + 26 + nameWidth, box.top() + 6, box.width() - 30 - nameWidth - percent,
                         kPlotRow - 12);
        painter.fillRect(bar, palette().color(QPalette::Base));
        painter.fillRect(QRectF(bar.left(), bar.top(), bar.width() * std::min(1.0, row.share), bar.height()), color);
        painter.drawText(box.adjusted(0, 0, -4, 0), Qt::AlignRight | Qt::AlignVCenter, row.text);
    }
}

QString ProbeShares::spokenValue() const {
    QStringList parts;
    for (const Row& row : rows()) parts << tr("%1: %2").arg(nameOf(m_probe, row.feature), row.text);
    return parts.isEmpty() ? tr("Nothing is probed") : parts.join("; ");
}

int ProbeShares::rowAt(const QPoint& point) const {
    const int row = point.y() / kPlotRow;
    return point.y() >= 0 && row < static_cast<int>(rows().size()) ? row : -1;
}

void ProbeShares::mousePressEvent(QMouseEvent* event) {
    event->accept();
    const int row = rowAt(event->position().toPoint());
    if (row < 0 || event->button() != Qt::LeftButton) return;
    const int feature = rows()[static_cast<std::size_t>(row)].feature;
    if (feature >= 0)
        m_services.selection().setFeature(m_services.scene().tf.features[static_cast<std::size_t>(feature)].id);
}

bool ProbeShares::event(QEvent* event) {
    const auto textAt = [this](const QPoint& at) {
        const int row = rowAt(at);
        if (row < 0) return QString();
        const Row of = rows()[static_cast<std::size_t>(row)];
        return tr("%1 makes %2 of this pixel; all rows together make its opacity (alpha). Click: select it")
            .arg(of.feature >= 0 ? nameOf(m_probe, of.feature) : tr("What is in no feature"), of.text);
    };
    return showsTip(*event, *this, textAt) || QWidget::event(event);
}

} // namespace pellucid::gui
