#include "widgets/mark_painter.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <QPainter>
#include <QPainterPath>

#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

QPointF pointOf(const Vec2& p) { return {p.x, p.y}; }

QPolygonF polygonOf(const std::vector<Vec2>& points) {
    QPolygonF polygon;
    for (const Vec2& p : points) polygon << pointOf(p);
    return polygon;
}

QPen pen(const Rgb& rgb, double alpha, double width) {
    return {translucent(colorFromRgb(rgb), alpha), width, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin};
}

/// Of a mark, and where its corner lies; null where it is so large that stroking is cheaper.
std::pair<QImage, QPointF> imageOf(const Mark& mark, qreal ratio) {
    constexpr double kMostPixels = 1 << 16;
    const PixelBox extent = extentOf(mark).widened(1);
    // Whole pixels of the device, so that it is drawn just where it would be.
    const QPointF corner(std::floor(extent.left * ratio) / ratio, std::floor(extent.top * ratio) / ratio);
    const double width = std::ceil((extent.right - corner.x()) * ratio),
                 height = std::ceil((extent.bottom - corner.y()) * ratio);
    if (!(width * height <= kMostPixels)) return {};
    QImage image(static_cast<int>(width), static_cast<int>(height), QImage::Format_ARGB32_Premultiplied);
    if (image.isNull()) return {};
    image.setDevicePixelRatio(ratio);
    image.fill(Qt::transparent);
    QPainter painter(&image);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.translate(-corner);
    drawMark(painter, mark);
    return {image, corner};
}

} // namespace

void drawMark(QPainter& painter, const Mark& mark) {
    if (mark.kind == Mark::Kind::Area) {
        painter.setPen(Qt::NoPen);
        painter.setBrush(translucent(colorFromRgb(mark.color), mark.alpha));
        painter.drawConvexPolygon(polygonOf(mark.points));
        return;
    }
    QPainterPath path; // one: where strokes cross, a pale one is not darker
    for (const Polyline& stroke : strokesOf(mark)) path.addPolygon(polygonOf(stroke));
    painter.setBrush(Qt::NoBrush);
    if (mark.halo > 0)
        painter.strokePath(path, pen(mark.haloColor, kHaloAlpha * mark.alpha, mark.width + 2 * mark.halo));
    painter.strokePath(path, pen(mark.color, mark.alpha, mark.width));
}

void MarkPainter::draw(QPainter& painter, const std::vector<Mark>& marks) {
    const qreal ratio = painter.device()->devicePixelRatioF();
    if (ratio != m_ratio) m_last.clear();
    m_ratio = ratio;
    std::vector<Drawn> drawn;
    for (const Mark& mark : marks) {
        const auto before =
            std::find_if(m_last.begin(), m_last.end(), [&](const Drawn& last) { return last.mark == mark; });
        if (before == m_last.end()) {
            drawMark(painter, mark);
            drawn.push_back({mark});
            continue;
        }
        if (before->image.isNull()) std::tie(before->image, before->corner) = imageOf(mark, ratio);
        if (before->image.isNull())
            drawMark(painter, mark);
        else
            painter.drawImage(before->corner, before->image);
        drawn.push_back(*before);
    }
    m_last = std::move(drawn);
}

} // namespace pellucid::gui
