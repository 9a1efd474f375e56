#include "widgets/plot_view.h"

#include <algorithm>
#include <cmath>

#include <QBuffer>
#include <QFileInfo>
#include <QFontMetricsF>
#include <QMouseEvent>
#include <QPainter>

#include "base/atomic_file.h"
#include "base/error.h"
#include "report/svg_plot.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kReach = 8; ///< of the mouse, pixels

QString valueText(double value) { return QString::number(value, 'g', value < 0.1 ? 3 : 4); }

QFont fontOf(const PlotText& text) {
    QFont font;
    font.setPixelSize(std::max(1, static_cast<int>(std::lround(text.size))));
    font.setBold(text.bold);
    return font;
}

/// A page in the font that plots are painted in.
PlotPage pageOf(const QSizeF& size, double fontSize) {
    PlotPage page{.width = size.width(), .height = size.height(), .fontSize = fontSize};
    const QFontMetricsF metrics(fontOf({.at = {}, .text = {}, .size = fontSize}));
    page.textWidth = [metrics](const std::string& text) {
        return metrics.horizontalAdvance(QString::fromStdString(text));
    };
    return page;
}

QColor colorOf(PlotInk ink, const Rgb& own, const PlotColors& colors) {
    static constexpr QColor PlotColors::*kInks[] = {&PlotColors::text,  &PlotColors::faint, &PlotColors::grid,
                                                    &PlotColors::shade, &PlotColors::rim,   &PlotColors::ground};
    if (ink != PlotInk::Own) return colors.*kInks[static_cast<std::size_t>(ink)];
    return seenOn(colors.ground, colorFromRgb(own));
}

QPointF pointOf(const Vec2& at) { return {at.x, at.y}; }

void paintText(QPainter& painter, const PlotText& t, const PlotColors& colors) {
    painter.setFont(fontOf(t));
    painter.setPen(colorOf(t.ink, {}, colors));
    const QString text = QString::fromStdString(t.text);
    const double width = painter.fontMetrics().horizontalAdvance(text);
    painter.save();
    painter.translate(pointOf(t.at));
    if (t.upward) painter.rotate(-90);
    painter.drawText(QPointF(-width * static_cast<int>(t.anchor) / 2, 0), text);
    painter.restore();
}

} // namespace

PlotColors themePlotColors() {
    return {theme::kText,
            theme::kFaint,
            theme::kHistogram,
            translucent(theme::kHistogram, 0.35),
            translucent(theme::kFaint, 0.7),
            theme::kPanel};
}

PlotColors paperPlotColors() {
    return {QColor(0x1b, 0x1d, 0x20), QColor(0x58, 0x5c, 0x62), QColor(0xdf, 0xe1, 0xe5),
            QColor(0xee, 0xf0, 0xf3), QColor(0x8a, 0x8d, 0x92), Qt::white};
}

void paintPlot(QPainter& painter, const Plot& plot, const PlotPage& page, const PlotColors& colors) {
    const PlotDrawing drawing = drawingOf(plot, page);
    painter.setRenderHint(QPainter::Antialiasing);
    for (const PlotArea& a : drawing.areas)
        painter.fillRect(QRectF(pointOf(a.lo), pointOf(a.hi)), colorOf(a.ink, a.color, colors));
    painter.setBrush(Qt::NoBrush);
    for (const PlotStroke& s : drawing.strokes) {
        QPen pen(colorOf(s.ink, s.color, colors), s.width);
        pen.setJoinStyle(Qt::RoundJoin);
        if (s.dashed) pen.setDashPattern({5 / s.width, 4 / s.width}); // in widths
        painter.setPen(pen);
        QPolygonF line;
        for (const Vec2& p : s.points) line << pointOf(p);
        painter.drawPolyline(line);
    }
    for (const PlotDot& d : drawing.dots) {
        const QColor color = colorOf(d.ink, d.color, colors);
        painter.setPen(d.hollow ? QPen(color, 1.5) : QPen(Qt::NoPen));
        painter.setBrush(d.hollow ? colors.ground : color);
        painter.drawEllipse(pointOf(d.at), d.radius, d.radius);
    }
    for (const PlotText& t : drawing.texts) paintText(painter, t, colors);
}

QImage imageOf(std::span<const Plot> plots, const QSize& size, double density) {
    const int count = static_cast<int>(plots.size());
    QImage image(QSize(size.width(), size.height() * count) * density, QImage::Format_RGB32);
    image.setDevicePixelRatio(density);
    const PlotColors colors = paperPlotColors();
    image.fill(colors.ground);
    QPainter painter(&image);
    for (int i = 0; i < count; ++i) {
        painter.resetTransform();
        painter.translate(0, i * size.height());
        paintPlot(painter, plots[static_cast<std::size_t>(i)], pageOf(size, 12), colors);
    }
    return image;
}

void writePlots(const std::string& file, std::span<const Plot> plots) {
    constexpr int kWidth = 640, kHeight = 400;
    const QString suffix = QFileInfo(QString::fromStdString(file)).suffix().toLower();
    if (suffix == "svg") {
        writeTextAtomically(file, svgOf(plots, {.width = kWidth, .height = kHeight}));
    } else if (suffix == "png") {
        QByteArray bytes;
        QBuffer buffer(&bytes);
        buffer.open(QIODevice::WriteOnly);
        imageOf(plots, {kWidth, kHeight}, 2).save(&buffer, "PNG");
        writeTextAtomically(file, {bytes.constData(), static_cast<std::size_t>(bytes.size())});
    } else {
        throw UsageError("curves are written as .csv, .png or .svg", file, "give one of these suffixes");
    }
}

PlotView::PlotView(QWidget* parent) : QWidget(parent), Spoken(*this, QAccessible::Chart) { setMouseTracking(true); }

PlotPage PlotView::page() const { return pageOf(size(), std::max(9, fontInfo().pixelSize() - 1)); }

PlotBox PlotView::box() const { return boxOf(m_plot, page()); }

void PlotView::setPlot(Plot plot) {
    if (plot == m_plot) return;
    m_plot = std::move(plot);
    setAccessibleName(QString::fromStdString(m_plot.title));
    update();
}

void PlotView::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const PlotColors colors = themePlotColors();
    painter.fillRect(rect(), colors.ground);
    paintPlot(painter, m_plot, page(), colors);
    if (!m_hovered) return;
    const PlotBox f = box();
    painter.setPen(QPen(theme::kAccent, 1));
    painter.drawLine(QPointF(f.xOf(*m_hovered), f.top), QPointF(f.xOf(*m_hovered), f.bottom));
}

QString PlotView::spokenValue() const {
    QStringList parts;
    for (const PlotSeries& s : m_plot.series) {
        if (s.points.empty()) continue;
        const auto [least, most] = std::ranges::minmax_element(s.points, {}, &PlotPoint::y);
        const QString values =
            tr("%1 to %2, the last %3").arg(valueText(least->y), valueText(most->y), valueText(s.points.back().y));
        parts << (s.name.empty() ? values : tr("%1: %2").arg(QString::fromStdString(s.name), values));
    }
    return parts.isEmpty() ? tr("There are no values yet") : parts.join("; ");
}

void PlotView::readAt(double pixel) {
    const PlotBox f = box();
    double x = f.valueAtX(pixel);
    if (m_plot.x.whole) x = std::round(x);
    m_hovered = x;
    QStringList values;
    for (const PlotSeries& s : m_plot.series) {
        const PlotPoint* nearest = nullptr;
        for (const PlotPoint& p : s.points)
            if (std::abs(p.x - x) <= 0.5 && (nearest == nullptr || std::abs(p.x - x) < std::abs(nearest->x - x)))
                nearest = &p;
        if (nearest == nullptr || s.name.empty()) continue;
        values << QStringLiteral("%1 %2").arg(QString::fromStdString(s.name), valueText(nearest->y));
    }
    Q_EMIT readOut(values.isEmpty()
                       ? QString()
                       : tr("%1 %2: %3")
                             .arg(QString::fromStdString(m_plot.x.label),
                                  numberText(x, m_plot.x.whole ? 0 : m_plot.x.hi - m_plot.x.lo), values.join(", ")));
    update();
}

void PlotView::mouseMoveEvent(QMouseEvent* event) {
    event->accept();
    const QPointF at = event->position();
    readAt(at.x());
    setCursor(hitAt(m_plot, box(), {at.x(), at.y()}, kReach) ? Qt::PointingHandCursor : Qt::ArrowCursor);
}

void PlotView::mousePressEvent(QMouseEvent* event) {
    event->accept();
    if (event->button() != Qt::LeftButton) return;
    const QPointF at = event->position();
    if (const auto hit = hitAt(m_plot, box(), {at.x(), at.y()}, kReach))
        Q_EMIT dotClicked(static_cast<int>(hit->series), static_cast<int>(hit->point));
}

void PlotView::mouseDoubleClickEvent(QMouseEvent* event) {
    event->accept();
    const QPointF at = event->position();
    if (event->button() == Qt::LeftButton && !hitAt(m_plot, box(), {at.x(), at.y()}, kReach)) Q_EMIT exportWanted();
}

void PlotView::leaveEvent(QEvent*) {
    m_hovered.reset();
    Q_EMIT readOut({});
    update();
}

} // namespace pellucid::gui
