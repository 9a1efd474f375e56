#include "view/camera_hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <QApplication>
#include <QLineF>
#include <QMouseEvent>
#include <QWheelEvent>
#include <QWidget>

#include "render/camera_motion.h"
#include "session/home_view.h"
#include "store/session_store.h"

namespace pellucid::gui {
namespace {

constexpr double kDegreesPerView = 220; // of a drag across the height of the view
constexpr double kZoomPerView = 12;     // factor of a right-drag across the height of the view
constexpr double kZoomPerNotch = 1.15;  // factor of one notch of the wheel
constexpr double kDegreesPerKey = 5;
constexpr qint64 kWheelPause = 600; // milliseconds that part two zooms

/// Turned about the middle of the picture, which goes counterclockwise where `angle` > 0, degrees.
Camera rolled(const Camera& camera, double angle) {
    const double radians = angle * std::numbers::pi / 180;
    Camera c = camera; // it turns the other way
    c.up = std::cos(radians) * camera.trueUp() + std::sin(radians) * camera.right();
    return c;
}

} // namespace

void CameraHand::set(const std::function<Camera(const Camera&, const Geometry&)>& change, int gesture) {
    if (const Scene* const scene = m_get()) m_set(change(scene->camera, scene->volume->geometry()), gesture);
}

void CameraHand::zoom(double factor, int gesture) {
    set([=](const Camera& now, const Geometry& g) { return zoomed(now, g, factor); }, gesture);
}

void CameraHand::fit() {
    if (const Scene* const scene = m_get()) m_set(fittedView(*scene, scene->camera), 0);
}

bool CameraHand::press(const QMouseEvent& event) {
    m_motion = motionOf(mouseScheme(), event.button(), event.modifiers());
    if (!m_motion) return false;
    if (m_motion == Motion::Light) m_motion = Motion::Rotate; // of what has none, or may not be changed
    m_button = event.button();
    m_last = m_pressed = event.position();
    m_moved = false;
    m_gesture = SessionStore::newGesture();
    return true;
}

void CameraHand::move(const QMouseEvent& event) {
    if (!m_motion || m_get() == nullptr) return;
    if (!m_moved && (event.position() - m_pressed).manhattanLength() < QApplication::startDragDistance() / 3) return;
    m_moved = true;
    drag(std::exchange(m_last, event.position()), event.position());
}

void CameraHand::drag(const QPointF& from, const QPointF& to) {
    const QPointF way = to - from;
    const int height = m_view.height();
    const double perPixel = 1.0 / std::max(1, height);
    switch (*m_motion) {
    case Motion::Pan:
        return set([&](const Camera& now, const Geometry& g) { return panned(now, g, way.x(), way.y(), height); },
                   m_gesture);
    case Motion::Zoom: {
        const double closer = (zoomsInDownward(mouseScheme()) ? way.y() : -way.y()) * perPixel;
        return zoom(std::pow(kZoomPerView, closer), m_gesture);
    }
    case Motion::Roll:
        return set([&](const Camera& now, const Geometry&) { return rolled(now, turned(from, to)); }, m_gesture);
    default: // the volume follows the hand, so the eye goes the other way
        return set(
            [&](const Camera& now, const Geometry& g) {
                return rotated(now, g, -way.x() * perPixel * kDegreesPerView, way.y() * perPixel * kDegreesPerView);
            },
            m_gesture);
    }
}

double CameraHand::turned(const QPointF& from, const QPointF& to) const {
    const QPointF middle = QRectF(m_view.rect()).center();
    const double angle = QLineF(middle, from).angleTo(QLineF(middle, to)); // counterclockwise, from 0 to 360
    return angle > 180 ? angle - 360 : angle;
}

bool CameraHand::release(const QMouseEvent& event) {
    if (event.button() != m_button) return false;
    const bool click = m_button == Qt::LeftButton && m_motion == Motion::Rotate && !m_moved && m_get() != nullptr;
    m_motion.reset();
    return click;
}

void CameraHand::wheel(QWheelEvent& event) {
    if (event.angleDelta().y() == 0) return event.ignore();
    if (!m_sinceWheel.isValid() || m_sinceWheel.restart() > kWheelPause) m_wheelGesture = SessionStore::newGesture();
    m_sinceWheel.start();
    zoom(std::pow(kZoomPerNotch, event.angleDelta().y() / 120.0), m_wheelGesture);
    event.accept();
}

bool CameraHand::key(int key) {
    const auto turn = [this](double yaw, double pitch) {
        set([=](const Camera& now, const Geometry& g) {
            return rotated(now, g, yaw * kDegreesPerKey, pitch * kDegreesPerKey);
        });
        return true;
    };
    switch (key) {
    case Qt::Key_Left:
        return turn(-1, 0);
    case Qt::Key_Right:
        return turn(1, 0);
    case Qt::Key_Up:
        return turn(0, 1);
    case Qt::Key_Down:
        return turn(0, -1);
    case Qt::Key_Plus:
    case Qt::Key_Equal:
        zoom(kZoomPerNotch);
        return true;
    case Qt::Key_Minus:
        zoom(1.0 / kZoomPerNotch);
        return true;
    default:
        return false;
    }
}

QString anglesText(const ViewAngles& angles) {
    const auto degrees = [](double value) {
        return QString::number(value, 'f', 0).replace('-', QChar(0x2212)) + QChar(0x00b0);
    };
    return QObject::tr("azimuth %1, elevation %2").arg(degrees(angles.azimuth), degrees(angles.elevation));
}

QString viewText(const Camera& camera, const Geometry& geometry) {
    const ViewAngles angles = viewAngles(camera, geometry);
    return QObject::tr("seen from %1, magnified %2 times")
        .arg(anglesText(angles), QString::number(angles.zoom, 'g', 2));
}

} // namespace pellucid::gui
