#include "widgets/mark_painter.h"

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

} // namespace pellucid::gui
