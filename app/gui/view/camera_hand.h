// The hand that turns a view: mouse, wheel and keys, for every picture of a volume.
#pragma once

#include <functional>
#include <optional>

#include <QElapsedTimer>
#include <QPointF>
#include <QString>
#include <Qt>

#include "session/scene.h"
#include "widgets/mouse_scheme.h"

class QMouseEvent;
class QWheelEvent;
class QWidget;

namespace pellucid {
struct ViewAngles;
}

namespace pellucid::gui {

/// Drags do what the mouse scheme says (widgets/mouse_scheme.h); the wheel zooms, arrow keys rotate. It keeps no
/// camera.
class CameraHand {
public:
    using Get = std::function<const Scene*()>; ///< what is seen; null: there is nothing to turn
    /// One drag, or turns of the wheel that follow each other, are one gesture; 0: each call is one.
    using Set = std::function<void(const Camera& camera, int gesture)>;
    /// `view`: the picture, which outlives this.
    CameraHand(QWidget& view, Get get, Set set) : m_view(view), m_get(std::move(get)), m_set(std::move(set)) {}

    bool isHolding() const { return m_motion.has_value(); }
    bool press(const QMouseEvent& event); ///< false: this button does nothing
    void move(const QMouseEvent& event);
    bool release(const QMouseEvent& event); ///< true: the left button went down and up in one place
    void wheel(QWheelEvent& event);
    bool key(int key); ///< Qt::Key; false: it does nothing
    void fit();        ///< the same direction; what is drawn fills the picture

private:
    void set(const std::function<Camera(const Camera&, const Geometry&)>& change, int gesture = 0);
    void zoom(double factor, int gesture = 0);
    void drag(const QPointF& from, const QPointF& to);
    double turned(const QPointF& from, const QPointF& to) const; ///< about the middle, counterclockwise, degrees

    QWidget& m_view;
    Get m_get;
    Set m_set;
    std::optional<Motion> m_motion; ///< of the drag under way
    Qt::MouseButton m_button = Qt::NoButton;
    QPointF m_last, m_pressed;
    bool m_moved = false; ///< since the press, by more than a trembling hand
    int m_gesture = 0;
    QElapsedTimer m_sinceWheel;
    int m_wheelGesture = 0;
};

/// Of a direction: "azimuth 30°, elevation −10°".
QString anglesText(const ViewAngles& angles);
/// "seen from azimuth 30°, elevation −10°, magnified 1.2 times".
QString viewText(const Camera& camera, const Geometry& geometry);

} // namespace pellucid::gui
