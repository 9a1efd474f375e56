#include "view/difference_layer.h"

#include <algorithm>
#include <vector>

#include <QPainter>

#include "controllers/comparison_controller.h"
#include "tf/color_maps.h"
#include "view/compared_view.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kLeast = 0.35; // of the strength, where a difference is just noticed

/// Nothing where the difference is not noticed; from there on ever stronger.
QColor colorOfDifference(double part, double noticedPart, double strength) {
    QColor color = colorFromRgb(colorMapNamed("ember").colorAt(0.3 + 0.7 * part));
    const double alpha = part <= noticedPart ? 0 : kLeast + (1 - kLeast) * (part - noticedPart) / (1 - noticedPart);
    color.setAlphaF(static_cast<float>(strength * alpha));
    return color;
}

QImage imageOf(const Plane& map, double top, double strength) {
    std::vector<QRgb> table(1024);
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = qPremultiply(colorOfDifference(static_cast<double>(i) / static_cast<double>(table.size() - 1),
                                                  kNoticedDeltaE / top, strength)
                                    .rgba());
    QImage image(map.width, map.height, QImage::Format_ARGB32_Premultiplied);
    const auto scale = static_cast<float>(static_cast<double>(table.size() - 1) / top);
    for (int y = 0; y < map.height; ++y) {
        auto* line = reinterpret_cast<QRgb*>(image.scanLine(y));
        for (int x = 0; x < map.width; ++x)
            line[x] = table[std::min(table.size() - 1, static_cast<std::size_t>(scale * map.row(y)[x]))];
    }
    return image;
}

} // namespace

double topOfDifferences(double largest) {
    for (const double top : {5.0, 10.0, 20.0, 50.0, 100.0})
        if (largest <= top) return top;
    return 200;
}

DifferenceLayer::DifferenceLayer(ComparisonController& comparing, ViewOverlay& overlay) : m_comparing(comparing) {
    for (const auto signal : {&ComparisonController::changed, &ComparisonController::sceneChanged})
        QObject::connect(&comparing, signal, &overlay, [&overlay] { overlay.update(); });
}

void DifferenceLayer::paint(QPainter& painter, const LayerView& view) {
    if (!m_comparing.isShown()) return;
    const ComparisonView& shown = m_comparing.view();
    QRectF area(QPointF(), view.size);
    if (shown.mode == CompareMode::Wipe) area.setWidth(shown.divider * view.size.width());
    const QString name = QString::fromStdString(shown.b->name);
    if (shown.mode != CompareMode::Difference) return paintSideName(painter, area, QObject::tr("A: now"));
    paintMap(painter, view);
    paintSideName(painter, area, QObject::tr("Difference to %1").arg(name));
}

void DifferenceLayer::paintMap(QPainter& painter, const LayerView& view) {
    const Comparison* const comparison = m_comparing.comparison();
    if (comparison == nullptr) return;
    const double strength = m_comparing.view().strength;
    if (m_version != m_comparing.version() || m_strength != strength) {
        m_version = m_comparing.version();
        m_strength = strength;
        m_top = topOfDifferences(comparison->difference.largest);
        m_image = imageOf(comparison->difference.map, m_top, strength);
    }
    const bool current = m_comparing.state() == ComparisonController::State::Current &&
                         view.scene.camera == m_comparing.cameraOfA(); // not a glimpse from elsewhere
    if (current) {
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        painter.drawImage(QRectF(QPointF(), view.size), m_image);
    }
    paintLegend(painter, view.size, current);
}

/// An upright bar at the right edge, with ΔE beside it and the threshold marked.
void DifferenceLayer::paintLegend(QPainter& painter, const QSizeF& size, bool current) const {
    constexpr double kBar = 12, kMargin = 12, kMost = 220;
    const QFontMetricsF metrics(painter.font());
    const QString unit = QObject::tr("ΔE"), noticed = QObject::tr("2.3 just noticed");
    const double height = std::min(kMost, size.height() - 4 * metrics.height() - 4 * kMargin);
    const double width = metrics.horizontalAdvance(noticed) + kBar + 3 * kMargin;
    if (height < 4 * metrics.height() || width > size.width()) return; // no room
    const QRectF box(size.width() - width - kMargin, (size.height() - height) / 2 - metrics.height() - kMargin, width,
                     height + metrics.height() + 3 * kMargin);
    painter.setOpacity(current ? 1 : 0.45);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(0, 0, 0, 150));
    painter.drawRoundedRect(box, 5, 5);
    painter.setPen(theme::kMark);
    painter.drawText(QPointF(box.left() + kMargin, box.top() + kMargin / 2 + metrics.ascent()), unit);
    const QRectF bar(box.left() + kMargin, box.bottom() - kMargin - height, kBar, height);
    const auto levelOf = [&](double deltaE) { return bar.bottom() - deltaE / m_top * bar.height(); };
    for (int y = 0; y < static_cast<int>(bar.height()); ++y) {
        const double part = 1 - (y + 0.5) / bar.height();
        const QRectF line(bar.left(), bar.top() + y, bar.width(), 1);
        painter.fillRect(line, QColor(0x30, 0x30, 0x30));
        painter.fillRect(line, colorOfDifference(part, kNoticedDeltaE / m_top, 1));
    }
    const auto mark = [&](double deltaE, const QString& text) {
        const double y = levelOf(deltaE);
        painter.drawLine(QPointF(bar.right(), y), QPointF(bar.right() + 4, y));
        painter.drawText(QRectF(bar.right() + 7, y - metrics.height() / 2, width, metrics.height()),
                         Qt::AlignLeft | Qt::AlignVCenter, text);
    };
    mark(m_top, QString::number(m_top));
    if (kNoticedDeltaE / m_top * bar.height() < bar.height() / 2 - metrics.height())
        mark(m_top / 2, QString::number(m_top / 2));
    mark(kNoticedDeltaE, noticed);
    painter.drawLine(QPointF(bar.left(), levelOf(kNoticedDeltaE)), QPointF(bar.right(), levelOf(kNoticedDeltaE)));
    painter.setOpacity(1);
}

} // namespace pellucid::gui
