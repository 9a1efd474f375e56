// How the canvas of the transfer function looks.

#include <algorithm>
#include <cmath>
#include <iterator>

#include <QPainter>

#include "tf/tf_canvas.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kRadius = 5;            // of a point
constexpr double kHighest = 0.94;        // of the plot: a bar of height 1
constexpr double kLegendFrom = 430;      // width of a plot that has room for the legend
constexpr double kVisibleDecades = 1000; // of visibility that a logarithmic scale shows

QColor mixed(const QColor& a, const QColor& b, double share) { // of b
    const auto mix = [&](float x, float y) { return x + static_cast<float>(share) * (y - x); };
    return QColor::fromRgbF(mix(a.redF(), b.redF()), mix(a.greenF(), b.greenF()), mix(a.blueF(), b.blueF()));
}

QFont smaller(QFont font, double factor) {
    font.setPointSizeF(font.pointSizeF() * factor);
    return font;
}

/// Of what is visible: between that of the curve and that of what is active.
QColor visibleColor() { return mixed(theme::kCurve, theme::kAccent, 0.6); }

QColor readableOn(const QColor& ground) { return qGray(ground.rgb()) > 120 ? QColor(20, 20, 20) : QColor(Qt::white); }

// Colours of the transfer function along the part of the axis that is seen.
QLinearGradient colorsAlong(const TransferFunction& tf, const IntensityAxis& axis, const QRectF& r, double alpha) {
    QLinearGradient gradient(r.left(), 0, r.right(), 0);
    gradient.setColorAt(0, translucent(colorFromRgb(tf.color(axis.lo())), alpha));
    gradient.setColorAt(1, translucent(colorFromRgb(tf.color(axis.hi())), alpha));
    double last = 0;
    for (const ControlPoint& p : tf.points) {
        double at = (p.x - axis.lo()) / axis.width();
        if (at <= 0 || at >= 1) continue;
        at = std::max(at, last + 1e-6); // two points at one x are two colours
        if (at < 1) gradient.setColorAt(at, translucent(colorFromRgb(p.color), alpha));
        last = at;
    }
    return gradient;
}

} // namespace

QFont TfCanvas::smallFont() const { return smaller(font(), 0.85); }

void TfCanvas::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.fillRect(rect(), theme::kWindow);
    const QRectF r = plot();
    painter.fillRect(r, theme::kPanel);
    if (!m_store.hasVolume()) return;
    painter.setFont(smallFont());
    const auto clipped = [&](const auto& paint) {
        painter.save();
        painter.setClipRect(r.adjusted(-1, -1, 1, 1));
        paint();
        painter.restore();
    };
    clipped([&] {
        paintJointHistogram(painter);
        paintHistogram(painter);
        paintVisibility(painter);
    });
    paintTopLine(painter); // behind all that is taken hold of
    paintAxes(painter);
    paintFeatures(painter);
    clipped([&] {
        paintGhost(painter);
        paintCurve(painter);
    });
    paintHair(painter);
    paintPoints(painter);
    if (m_drag && m_drag->kind == Drag::Kind::Band && m_drag->moved) {
        painter.setPen(QPen(theme::kAccent, 1, Qt::DashLine));
        painter.setBrush(translucent(theme::kAccent, 0.12));
        painter.drawRect(QRectF(m_drag->pressed, m_drag->last).normalized().intersected(r));
    }
}

void TfCanvas::paintJointHistogram(QPainter& painter) {
    if (!m_showJoint) return;
    const QRectF r = plot();
    const JointHistogram* const joint = m_counts.joint(true);
    if (joint == nullptr) {
        m_jointImage = {};
        return;
    }
    if (m_jointImage.isNull()) {
        // Logarithmic up to a count that few cells exceed: air alone would be the end of the scale.
        std::vector<std::uint32_t> filled;
        std::copy_if(joint->counts.begin(), joint->counts.end(), std::back_inserter(filled),
                     [](std::uint32_t count) { return count > 0; });
        std::sort(filled.begin(), filled.end());
        const double most = filled.empty() ? 1 : std::log1p(filled[(filled.size() - 1) * 99 / 100]);
        const QColor sparse = mixed(theme::kPanel, theme::kFaint, 0.7);
        QImage image(joint->bins, joint->gradientBins, QImage::Format_ARGB32_Premultiplied);
        for (int g = 0; g < joint->gradientBins; ++g) {
            auto* line = reinterpret_cast<QRgb*>(image.scanLine(joint->gradientBins - 1 - g));
            for (int b = 0; b < joint->bins; ++b) {
                const double share = std::min(1.0, std::log1p(joint->at(b, g)) / most);
                line[b] = qPremultiply(translucent(mixed(sparse, theme::kAccent, share), share).rgba());
            }
        }
        m_jointImage = image;
    }
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    const double n = joint->bins;
    painter.drawImage(r, m_jointImage, QRectF(m_axis.lo() * n, 0, m_axis.width() * n, joint->gradientBins));
    paintGradientAxis(painter);
}

void TfCanvas::paintGradientAxis(QPainter& painter) const {
    const JointHistogram* const joint = m_counts.joint(false);
    if (!m_showJoint || joint == nullptr) return;
    const QRectF r = plot();
    const ValueRange range = m_store.scene().volume->range();
    const double most = joint->mostGradient * (range.hi - range.lo);
    const QFontMetricsF metrics(smallFont());
    painter.save();
    painter.setClipping(false);
    painter.setPen(theme::kFaint);
    const int wanted = std::max(1, static_cast<int>(r.height() / (2.2 * metrics.height())));
    for (const double value : axisTicks(0, most, wanted)) {
        const double y = r.bottom() - value / most * r.height();
        painter.drawLine(QPointF(r.right() + 1, y), QPointF(r.right() + 4, y));
        painter.drawText(QRectF(r.right() + 7, y - metrics.height() / 2, layout::kGradientAxis - 8, metrics.height()),
                         Qt::AlignLeft | Qt::AlignVCenter, numberText(value, most));
    }
    painter.drawText(QRectF(r.right() - 20, r.top() - layout::kBar - 4, layout::kGradientAxis + 18, layout::kBar),
                     Qt::AlignRight | Qt::AlignVCenter, m_unit.isEmpty() ? tr("∇ /d0") : tr("∇ %1/d0").arg(m_unit));
    painter.restore();
}

void TfCanvas::paintHistogram(QPainter& painter) const {
    const SeenBins bins = seenHistogram();
    if (bins.counts.empty()) return;
    const QRectF r = plot();
    const std::vector<double> heights = barHeights(bins.counts, m_scale);
    QPainterPath path(QPointF(m_axis.toPixel(bins.lo, r), r.bottom()));
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const double y = r.bottom() - kHighest * heights[i] * r.height();
        path.lineTo(m_axis.toPixel(bins.lo + static_cast<double>(i) * bins.width, r), y);
        path.lineTo(m_axis.toPixel(bins.lo + static_cast<double>(i + 1) * bins.width, r), y);
    }
    path.lineTo(path.currentPosition().x(), r.bottom());
    if (m_showJoint && m_counts.joint(false) != nullptr) { // over it, so that both are seen
        painter.strokePath(path, QPen(mixed(theme::kPanel, theme::kText, 0.45), 1));
    } else {
        path.closeSubpath();
        painter.fillPath(path, theme::kHistogram);
    }
}

void TfCanvas::paintVisibility(QPainter& painter) const {
    const Measures* const measures = m_results.measures();
    if (measures == nullptr || measures->visibilityHistogram.empty()) return;
    std::vector<double> shares = measures->visibilityHistogram;
    const double most = *std::max_element(shares.begin(), shares.end());
    if (!(most > 0)) return;
    if (m_scale == HistogramScale::Log) // shares are no counts: three decades below the largest
        for (double& share : shares) share *= kVisibleDecades / most;
    const std::vector<double> heights = barHeights(shares, m_scale);
    const QRectF r = plot();
    QPolygonF line;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(heights.size());
        line << QPointF(m_axis.toPixel(x, r), r.bottom() - kHighest * heights[i] * r.height());
    }
    const bool current = m_results.measuresAreCurrent();
    QPolygonF area = line;
    area << QPointF(line.back().x(), r.bottom()) << QPointF(line.front().x(), r.bottom());
    painter.setPen(Qt::NoPen);
    painter.setBrush(translucent(visibleColor(), current ? 0.12 : 0.05));
    painter.drawPolygon(area);
    painter.setPen(QPen(translucent(visibleColor(), current ? 0.9 : 0.35), 1.2));
    painter.drawPolyline(line);
}

void TfCanvas::paintAxes(QPainter& painter) const {
    const QRectF r = plot();
    const QFontMetricsF metrics(smallFont());
    const Volume& volume = *m_store.scene().volume;
    const double lo = volume.valueOfIntensity(m_axis.lo()), hi = volume.valueOfIntensity(m_axis.hi());
    painter.setPen(theme::kFaint);
    const double ticksTop = strip().bottom(), labelTop = ticksTop + 2;
    if (hi > lo) {
        for (const double value : axisTicks(lo, hi, std::max(2, static_cast<int>(r.width() / 80)))) {
            const double x = r.left() + (value - lo) / (hi - lo) * r.width();
            const QString text = numberText(value, hi - lo);
            const double w = metrics.horizontalAdvance(text);
            const double left = std::clamp(x - w / 2, layout::kLeft - 12, std::max(layout::kLeft, width() - w - 2));
            painter.drawText(QRectF(left, labelTop, w + 2, metrics.height()), Qt::AlignLeft, text);
            painter.drawLine(QPointF(x, ticksTop), QPointF(x, ticksTop + 3));
        }
    } else { // a constant volume has one value, which is intensity 0
        painter.drawText(QRectF(r.left(), labelTop, r.width(), metrics.height()), Qt::AlignLeft, numberText(lo, 0));
    }
    if (!m_unit.isEmpty())
        painter.drawText(QRectF(0, labelTop, layout::kLeft - 16, metrics.height()), Qt::AlignRight, m_unit);
    paintOverview(painter);

    std::vector<double> taken; // heights of labels
    for (const double opacity : m_opacityAxis.labels()) {
        const double y = positionOf(0, opacity).y();
        // The palette lies over what is below its upper edge.
        const double labelY = std::min(y, strip().top() - metrics.ascent() + metrics.height() / 2);
        const bool room = std::none_of(taken.begin(), taken.end(),
                                       [&](double other) { return std::abs(other - labelY) < 0.8 * metrics.height(); });
        if (!room) continue;
        taken.push_back(labelY);
        painter.setPen(QPen(translucent(theme::kLine, 0.6), 1));
        painter.drawLine(QPointF(r.left(), y), QPointF(r.right(), y));
        painter.setPen(theme::kFaint);
        painter.drawText(QRectF(0, labelY - metrics.height() / 2, layout::kLeft - 6, metrics.height()),
                         Qt::AlignRight | Qt::AlignVCenter, QString::number(opacity));
    }
    painter.drawText(QRectF(0, 1, layout::kLeft - 4, layout::kBar), Qt::AlignRight | Qt::AlignVCenter, tr("opacity"));
}

void TfCanvas::paintOverview(QPainter& painter) const {
    if (m_axis.isWhole()) return;
    const QRectF track = overviewTrack();
    painter.setPen(Qt::NoPen);
    painter.setBrush(theme::kLine);
    painter.drawRoundedRect(track, 2, 2);
    const double left = track.left() + m_axis.lo() * track.width();
    const double width = std::max(6.0, m_axis.width() * track.width());
    painter.setBrush(theme::kAccent);
    painter.drawRoundedRect(QRectF(std::min(left, track.right() - width), track.top(), width, track.height()), 2, 2);
}

void TfCanvas::paintFeatures(QPainter& painter) const {
    const QRectF r = plot();
    const QFont font = smaller(this->font(), 0.82);
    painter.setFont(font);
    const auto& features = tf().features;
    for (std::size_t i = 0; i < features.size(); ++i) {
        const Feature& f = features[i];
        const QRectF bar = barOf(f);
        if (bar.isEmpty()) continue;
        const QColor color = colorFromRgb(f.color);
        const bool selected = f.id != 0 && f.id == m_selection.feature();
        const bool hovered = m_hoveredBar && m_hoveredBar->feature == static_cast<int>(i);
        const double strength = f.hidden ? 0.02 : selected ? 0.15 : 0.07;
        painter.fillRect(QRectF(bar.left(), r.top(), bar.width(), r.height()), translucent(color, strength));
        painter.setPen(selected  ? QPen(theme::kText, 1.8)
                       : hovered ? QPen(theme::kText, 1)
                                 : (f.hidden ? QPen(color, 1, Qt::DashLine) : QPen(theme::kLine, 1)));
        painter.setBrush(f.hidden ? translucent(color, 0.12) : mixed(theme::kWindow, color, 0.88));
        painter.drawRoundedRect(bar.adjusted(0.5, 0.5, -0.5, -0.5), 3, 3);
        painter.setPen(f.hidden ? theme::kFaint : readableOn(color));
        const QString name =
            QFontMetricsF(font).elidedText(QString::fromStdString(f.name), Qt::ElideMiddle, bar.width() - 6);
        painter.drawText(bar, Qt::AlignCenter, name);
        if (hovered && m_hoveredBar->part != Part::Middle) { // the end that would be grabbed
            const double x = m_axis.toPixel(m_hoveredBar->part == Part::Lower ? f.a : f.b, r);
            painter.fillRect(QRectF(x - 1.5, bar.top() - 1, 3, bar.height() + 2), theme::kAccent);
        }
    }
    painter.setFont(smallFont());
}

void TfCanvas::paintGhost(QPainter& painter) const {
    const TransferFunction* const ghost = m_ghost ? m_ghost() : nullptr;
    if (ghost == nullptr) return;
    QPen pen(theme::kFaint, 1.2);
    pen.setDashPattern({4, 3});
    painter.strokePath(curveOf(*ghost), pen);
}

void TfCanvas::paintCurve(QPainter& painter) const {
    const QRectF r = plot();
    const QPainterPath line = curveOf(tf());
    QPainterPath area = line;
    area.lineTo(r.bottomRight());
    area.lineTo(r.bottomLeft());
    area.closeSubpath();
    painter.fillPath(area, colorsAlong(tf(), m_axis, r, m_showJoint ? 0.15 : 0.3));
    painter.strokePath(line, QPen(theme::kCurve, 1.6));
}

void TfCanvas::paintHair(QPainter& painter) const {
    const std::optional<double> x = m_selection.hoveredIntensity();
    if (!x || !m_axis.contains(*x)) return;
    const QRectF r = plot();
    const QPointF at = positionOf(*x, tf().opacity(*x));
    painter.setPen(QPen(translucent(theme::kText, 0.5), 1));
    painter.drawLine(QPointF(at.x(), r.top()), QPointF(at.x(), r.bottom()));
    painter.setPen(Qt::NoPen);
    painter.setBrush(theme::kText);
    painter.drawEllipse(at, 2.5, 2.5);
}

void TfCanvas::paintPoints(QPainter& painter) const {
    const auto paintOne = [&](int i) {
        const ControlPoint& p = point(i);
        if (!m_axis.contains(p.x)) return;
        const QPointF c = positionOf(i);
        const bool selected = m_points.contains(i), current = i == m_points.current(), hovered = i == m_hovered;
        const double radius = kRadius + (current || hovered ? 1.5 : 0.0);
        const auto shape = [&](double grown) { // squares stay put in refinement
            const double half = radius + grown - (p.fixed ? 1 : 0);
            const QRectF box(c.x() - half, c.y() - half, 2 * half, 2 * half);
            p.fixed ? painter.drawRect(box) : painter.drawEllipse(box);
        };
        if (selected || hovered) {
            painter.setPen(Qt::NoPen);
            painter.setBrush(translucent(theme::kAccent, selected ? (current ? 0.75 : 0.5) : 0.3));
            shape(5);
        }
        const QColor color = colorFromRgb(p.color);
        painter.setPen(Qt::NoPen); // a rim of the ground: seen on the curve and on whatever lies under it
        painter.setBrush(theme::kPanel);
        shape(2);
        painter.setPen(QPen(m_readOnly ? theme::kFaint : theme::kKnob, 1.6));
        painter.setBrush(color);
        shape(0);
        if (p.fixed) { // and are nailed down
            painter.setPen(Qt::NoPen);
            painter.setBrush(readableOn(color));
            painter.drawEllipse(c, 1.6, 1.6);
        }
    };
    // What is selected lies on top, the current one on all.
    const int count = static_cast<int>(tf().points.size());
    for (int i = 0; i < count; ++i)
        if (!m_points.contains(i)) paintOne(i);
    for (const int i : m_points.indices())
        if (i != m_points.current()) paintOne(i);
    if (m_points.current() >= 0) paintOne(m_points.current());
}

void TfCanvas::paintTopLine(QPainter& painter) const {
    const QRectF r = plot();
    const QFontMetricsF metrics(smallFont());
    const auto write = [&](double left, const QString& text, const QColor& color) {
        const QRectF box(left, r.top() + 1, metrics.horizontalAdvance(text) + 2, layout::kTopLine);
        painter.fillRect(box.adjusted(-3, 0, 3, 0), translucent(theme::kPanel, 0.75)); // the histogram may be behind
        painter.setPen(color);
        painter.drawText(box, Qt::AlignLeft | Qt::AlignVCenter, text);
    };
    double right = r.right() - 4;
    if (r.width() > kLegendFrom) {
        const auto entry = [&](const QString& text, const QBrush& brush, bool line) {
            right -= metrics.horizontalAdvance(text);
            write(right, text, theme::kFaint);
            right -= 18;
            painter.fillRect(QRectF(right, r.top() + (line ? 8 : 4), 14, line ? 2 : 9), brush);
            right -= 10;
        };
        if (m_showJoint) {
            QLinearGradient heat(0, 0, 1, 0);
            heat.setCoordinateMode(QGradient::ObjectMode);
            heat.setColorAt(0, theme::kPanel);
            heat.setColorAt(1, theme::kAccent);
            entry(m_counts.joint(false) == nullptr ? tr("counting gradients…") : tr("value × gradient"), heat, false);
        }
        if (m_results.measures() != nullptr)
            entry(tr("visible"), translucent(visibleColor(), m_results.measuresAreCurrent() ? 1 : 0.4), true);
        entry(tr("voxels"), theme::kHistogram, false);
    }
    const double left = r.left() + 14;
    const QString told = readout();
    const QString text =
        told.isEmpty() && m_points.isEmpty() ? tr("double-click: add a point  ·  drag: select  ·  wheel: zoom") : told;
    if (!text.isEmpty() && right > left)
        write(left, metrics.elidedText(text, Qt::ElideRight, right - left),
              told.isEmpty() ? theme::kFaint : theme::kText);
}

} // namespace pellucid::gui
