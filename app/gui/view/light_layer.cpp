#include "view/light_layer.h"

#include <QPainter>
#include <QRadialGradient>

#include <glm/geometric.hpp>

#include "services/services.h"
#include "store/edits.h"
#include "widgets/mouse_scheme.h"

namespace pellucid::gui {
namespace {

constexpr double kBallRadius = 36;     // of what is shown, pixels
constexpr double kRadiusOfView = 0.25; // of the ball that is turned, heights of the view

} // namespace

void LightLayer::paint(QPainter& painter, const LayerView& view) {
    if (!m_held) return;
    const Vec3 toward = glm::normalize(view.scene.session.display->light.direction);
    const QPointF bright = m_from + kBallRadius * QPointF(toward.x, -toward.y);
    // A ball of one colour, lit from there; from behind only its rim is.
    QRadialGradient shade(m_from + 0.75 * (bright - m_from), 1.7 * kBallRadius);
    const double front = toward.z >= 0 ? 1.0 : 0.45;
    shade.setColorAt(0, QColor::fromRgbF(1.0 * front, 0.96 * front, 0.85 * front, 0.95));
    shade.setColorAt(0.55, QColor::fromRgbF(0.45 * front, 0.43 * front, 0.4 * front, 0.9));
    shade.setColorAt(1, QColor::fromRgbF(0.08, 0.08, 0.09, 0.9));
    painter.setBrush(shade);
    painter.setPen(QPen(QColor(255, 255, 255, 160), 1));
    painter.drawEllipse(m_from, kBallRadius, kBallRadius);
    painter.setPen(QPen(QColor(0, 0, 0, 180), 1.5));
    painter.setBrush(toward.z >= 0 ? QColor(255, 240, 150) : QColor(0, 0, 0, 0));
    painter.drawEllipse(bright, 4.5, 4.5);
}

bool LightLayer::press(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) {
    if (motionOf(mouseScheme(), Qt::LeftButton, keys) != Motion::Light || m_services.isReadOnly()) return false;
    m_services.store().commit();
    m_held = true;
    m_from = point;
    m_start = view.scene.session.display->light.direction;
    m_overlay.update();
    return true;
}

void LightLayer::drag(const QPointF& point, Qt::KeyboardModifiers, const LayerView& view) {
    if (m_services.isReadOnly()) return;
    const QPointF way = point - m_from;
    const Vec3 direction = turnedBall(m_start, way.x(), way.y(), kRadiusOfView * view.size.height());
    m_services.store().preview(QObject::tr("Light"), changing(&Session::display, [&](DisplaySettings& d) {
                                   d.light.on = true;
                                   d.light.direction = direction;
                               }));
}

void LightLayer::end(bool kept) {
    m_held = false;
    kept ? m_services.store().commit() : m_services.store().cancel();
    m_overlay.update();
}

} // namespace pellucid::gui
