#include "view/clip_layer.h"

#include <algorithm>
#include <cmath>

#include <QPainter>
#include <QPolygonF>

#include <glm/geometric.hpp>

#include "services/services.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kReach = 10;     // pixels from a handle's middle at which it is taken
constexpr double kOnLine = 5;     // from a plane's outline
constexpr double kRadius = 5.5;   // of a handle
constexpr double kTipLength = 64; // from a plane's handle to the one that turns it
const QColor kPlane{0xff, 0xb0, 0x3a};

std::optional<QPointF> pointOf(const PictureView& picture, const Vec3& world) {
    const auto pixel = pixelOf(picture, world);
    if (!pixel) return {};
    return QPointF(pixel->x, pixel->y);
}

Vec3 tipOf(const PictureView& picture, const ClipPlane& plane, const Vec3& anchor) {
    return anchor + glm::normalize(plane.normal) * (kTipLength * worldPerPixel(picture, anchor));
}

double depthOf(const Camera& camera, const Vec3& world) { return glm::dot(world - camera.eye, camera.forward()); }

/// Whether the outside of a face is seen.
bool facesViewer(const Camera& camera, const Geometry& geometry, const Clipping& part, int axis, bool upper) {
    const Mat3 indexFromWorld = geometry.indexFromWorld();
    const Vec3 outward = Vec3(indexFromWorld[0][axis], indexFromWorld[1][axis], indexFromWorld[2][axis]);
    const double toward = glm::dot(outward, camera.towardEye(faceCenter(part, geometry, axis, upper)));
    return upper ? toward > 0 : toward < 0;
}

/// A line that is seen on any background.
void drawLine(QPainter& painter, const QLineF& line, const QColor& color, bool hidden) {
    painter.setPen(QPen(QColor(0, 0, 0, hidden ? 60 : 140), 3));
    painter.drawLine(line);
    painter.setPen(QPen(hidden ? QColor(color.red(), color.green(), color.blue(), 110) : color, 1.3,
                        hidden ? Qt::DashLine : Qt::SolidLine));
    painter.drawLine(line);
}

void drawHandle(QPainter& painter, const QPointF& at, const QColor& color, bool behind, bool active) {
    const QColor fill = active ? color.lighter(140) : behind ? QColor(20, 20, 22, 150) : color;
    painter.setPen(QPen(QColor(0, 0, 0, 170), 2.5));
    painter.setBrush(fill);
    const double radius = active ? kRadius + 1.5 : behind ? kRadius - 1 : kRadius;
    painter.drawEllipse(at, radius, radius);
    painter.setPen(QPen(behind && !active ? color : QColor(Qt::white), 1.2));
    painter.setBrush(Qt::NoBrush);
    painter.drawEllipse(at, radius, radius);
}

double distanceToSegment(const QPointF& p, const QPointF& a, const QPointF& b) {
    const QPointF way = b - a;
    const double length2 = QPointF::dotProduct(way, way);
    const double t = length2 > 0 ? std::clamp(QPointF::dotProduct(p - a, way) / length2, 0.0, 1.0) : 0.0;
    const QPointF off = p - (a + t * way);
    return std::hypot(off.x(), off.y());
}

QPolygonF outlineOf(const PictureView& picture, const std::vector<Vec3>& corners) {
    QPolygonF outline;
    for (const Vec3& corner : corners) {
        const auto point = pointOf(picture, corner);
        if (!point) return {};
        outline << *point;
    }
    return outline;
}

} // namespace

void ClipLayer::setShown(bool shown) {
    m_shown = shown;
    m_overlay.update();
}

std::vector<ClipLayer::Placed> ClipLayer::handles(const LayerView& view) const {
    const PictureView picture = view.picture();
    const Geometry& geometry = view.scene.volume->geometry();
    const Clipping& clipping = *view.scene.session.clipping;
    std::vector<Placed> placed;
    const auto add = [&](const Handle& handle, const Vec3& world) {
        if (const auto at = pointOf(picture, world)) placed.push_back({handle, *at, depthOf(view.scene.camera, world)});
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true})
            add({Kind::Face, axis, upper}, faceCenter(clipping, geometry, axis, upper));
    for (std::size_t i = 0; i < clipping.planes.size(); ++i) {
        const Vec3 anchor = planeAnchor(clipping.planes[i], geometry);
        add({Kind::Plane, static_cast<int>(i)}, anchor);
        add({Kind::Tip, static_cast<int>(i)}, tipOf(picture, clipping.planes[i], anchor));
    }
    std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.depth > b.depth; });
    return placed;
}

ClipLayer::Handle ClipLayer::handleAt(const QPointF& point, const LayerView& view) const {
    if (!m_shown || m_services.isReadOnly()) return {};
    const std::vector<Placed> placed = handles(view);
    for (auto h = placed.rbegin(); h != placed.rend(); ++h)
        if (std::hypot(h->at.x() - point.x(), h->at.y() - point.y()) <= kReach) return h->handle;
    // A plane that is looked at from its front has its handles behind each other: its outline moves it too.
    const PictureView picture = view.picture();
    const std::vector<ClipPlane>& planes = view.scene.session.clipping->planes;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const QPolygonF outline = outlineOf(picture, planeInBox(planes[i], view.scene.volume->geometry()));
        for (int k = 0; k < outline.size(); ++k)
            if (distanceToSegment(point, outline[k], outline[(k + 1) % outline.size()]) <= kOnLine)
                return {Kind::Plane, static_cast<int>(i)};
    }
    return {};
}

void ClipLayer::paint(QPainter& painter, const LayerView& view) {
    if (!m_shown) return;
    paintBox(painter, view);
    paintPlanes(painter, view);
    const Geometry& geometry = view.scene.volume->geometry();
    const Clipping& clipping = *view.scene.session.clipping;
    const Handle active = m_held.kind != Kind::None ? m_held : m_hovered;
    for (const Placed& h : handles(view)) {
        const bool face = h.handle.kind == Kind::Face;
        const bool behind = face && !facesViewer(view.scene.camera, geometry, clipping, h.handle.index, h.handle.upper);
        drawHandle(painter, h.at, face ? theme::kMarkAccent : kPlane, behind, h.handle == active);
    }
    if (active.kind != Kind::Face) return;
    // Which of the six it is.
    const int across = (active.index + 1) % 3, along = (active.index + 2) % 3;
    const int first = active.upper ? 1 << active.index : 0;
    std::vector<Vec3> corners;
    for (const int n : {first, first | 1 << across, first | 1 << across | 1 << along, first | 1 << along})
        corners.push_back(cornerOfPart(clipping, geometry, n));
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(theme::kMarkAccent.red(), theme::kMarkAccent.green(), theme::kMarkAccent.blue(), 50));
    painter.drawPolygon(outlineOf(view.picture(), corners));
}

void ClipLayer::paintBox(QPainter& painter, const LayerView& view) const {
    const PictureView picture = view.picture();
    const Geometry& geometry = view.scene.volume->geometry();
    const Clipping& part = *view.scene.session.clipping;
    bool seen[3][2];
    for (int axis = 0; axis < 3; ++axis)
        for (const int upper : {0, 1})
            seen[axis][upper] = facesViewer(view.scene.camera, geometry, part, axis, upper == 1);
    // Hidden edges first, so that the others lie over them.
    for (const bool hidden : {true, false})
        for (int axis = 0; axis < 3; ++axis)
            for (int n = 0; n < 8; ++n) {
                if ((n >> axis & 1) != 0) continue;
                bool onSeenFace = false;
                for (int other = 0; other < 3; ++other) onSeenFace |= other != axis && seen[other][n >> other & 1];
                if (onSeenFace == hidden) continue;
                const auto a = pointOf(picture, cornerOfPart(part, geometry, n));
                const auto b = pointOf(picture, cornerOfPart(part, geometry, n | 1 << axis));
                if (a && b) drawLine(painter, {*a, *b}, theme::kMark, hidden);
            }
}

void ClipLayer::paintPlanes(QPainter& painter, const LayerView& view) const {
    const PictureView picture = view.picture();
    const Geometry& geometry = view.scene.volume->geometry();
    for (const ClipPlane& plane : view.scene.session.clipping->planes) {
        const QPolygonF outline = outlineOf(picture, planeInBox(plane, geometry));
        painter.setPen(Qt::NoPen);
        painter.setBrush(QColor(kPlane.red(), kPlane.green(), kPlane.blue(), 24));
        painter.drawPolygon(outline);
        for (int i = 0; i < outline.size(); ++i)
            drawLine(painter, {outline[i], outline[(i + 1) % outline.size()]}, kPlane, false);
        const Vec3 anchor = planeAnchor(plane, geometry);
        const auto a = pointOf(picture, anchor), b = pointOf(picture, tipOf(picture, plane, anchor));
        if (a && b) drawLine(painter, {*a, *b}, kPlane, false);
    }
}

Qt::CursorShape ClipLayer::cursorAt(const QPointF& point, const LayerView& view) {
    const Handle handle = handleAt(point, view);
    if (!(handle == m_hovered)) {
        m_hovered = handle;
        m_overlay.update();
    }
    return handle.kind == Kind::None ? Qt::ArrowCursor : Qt::OpenHandCursor;
}

bool ClipLayer::press(const QPointF& point, Qt::KeyboardModifiers, const LayerView& view) {
    const Handle handle = handleAt(point, view);
    if (handle.kind == Kind::None) return false;
    m_services.store().commit();
    m_held = handle;
    m_from = point;
    m_start = *m_services.store().session().clipping;
    return true;
}

Clipping ClipLayer::dragged(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) const {
    const PictureView picture = view.picture();
    const Geometry& geometry = view.scene.volume->geometry();
    const PixelPoint from{m_from.x(), m_from.y()}, to{point.x(), point.y()};
    if (m_held.kind == Kind::Face) {
        const double by = draggedAlong(picture, faceCenter(m_start, geometry, m_held.index, m_held.upper),
                                       faceWay(geometry, m_held.index), from, to);
        return withFaceMoved(m_start, m_held.index, m_held.upper, by, keys.testFlag(Qt::ShiftModifier));
    }
    Clipping clipping = m_start;
    ClipPlane& plane = clipping.planes.at(static_cast<std::size_t>(m_held.index));
    const Vec3 anchor = planeAnchor(plane, geometry);
    if (m_held.kind == Kind::Plane) {
        const double by = draggedAlong(picture, anchor, plane.normal, from, to);
        plane = planeAt(plane, plane.offset + by * glm::dot(plane.normal, plane.normal), geometry);
    } else {
        const Camera& camera = view.scene.camera;
        const Vec3 normal = cameraFromWorld(camera, glm::normalize(plane.normal));
        const double side = normal.z >= 0 ? 1 : -1; // a tip behind the plane goes with the hand too
        plane = planeThrough(anchor, worldFromCamera(camera, turnedBall(normal, side * (to.x - from.x),
                                                                        side * (to.y - from.y), kTipLength)));
    }
    return clipping;
}

void ClipLayer::drag(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) {
    if (m_services.isReadOnly()) return;
    const QString text = m_held.kind == Kind::Face ? QObject::tr("Clip") : QObject::tr("Clip plane");
    m_services.store().preview(
        text, [clipping = dragged(point, keys, view)](Session& session) { session.clipping.set(clipping); });
}

void ClipLayer::end(bool kept) {
    m_held = {};
    kept ? m_services.store().commit() : m_services.store().cancel();
    m_overlay.update();
}

void addClipHandles(Services& services, QAction& shown, ViewOverlay& overlay) {
    auto owned = std::make_unique<ClipLayer>(services, overlay);
    QObject::connect(&shown, &QAction::toggled, &overlay, [layer = owned.get()](bool on) { layer->setShown(on); });
    overlay.add(std::move(owned));
}

} // namespace pellucid::gui
