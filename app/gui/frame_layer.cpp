#include "frame_layer.h"

#include <QPainter>
#include <QPainterPath>

#include "controllers/field_controller.h"
#include "render/annotation.h"
#include "theme.h"

namespace pellucid::gui {
namespace {

QPointF pointOf(const Vec2& p) { return {p.x, p.y}; }

QPolygonF polygonOf(const std::vector<Vec2>& points) {
    QPolygonF polygon;
    for (const Vec2& p : points) polygon << pointOf(p);
    return polygon;
}

QPen pen(const Rgb& rgb, double alpha, double width) {
    QColor color = colorFromRgb(rgb);
    color.setAlphaF(static_cast<float>(alpha));
    return {color, width, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin};
}

void draw(QPainter& painter, const Mark& mark) {
    if (mark.kind == Mark::Kind::Area) {
        QColor color = colorFromRgb(mark.color);
        color.setAlphaF(static_cast<float>(mark.alpha));
        painter.setPen(Qt::NoPen);
        painter.setBrush(color);
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

} // namespace

void FrameLayer::paint(QPainter& painter, const OverlayView& view) {
    const FrameOfReference& show = *view.scene.session.reference;
    const QSize size = view.size.toSize();
    if (size.isEmpty()) return;
    AnnotationInput input;
    if (m_fields) {
        PictureInput picture = m_fields->picture(size.width(), size.height());
        picture.camera = view.scene.camera; // a glimpse from elsewhere
        input = m_fields->annotation(picture, show);
    } else {
        input = annotationInput(pictureInput(view.scene, size.width(), size.height()), show);
    }
    if (!input.show.any()) return;
    for (const Mark& mark : annotationMarks(input)) draw(painter, mark);
}

} // namespace pellucid::gui
