// A small sphere in the colours of a figure over all views.
#pragma once

#include <functional>
#include <optional>

#include <QWidget>

#include "optimize/views/view_search.h"
#include "widgets/spoken_value.h"

namespace pellucid::gui {

/// The point that faces you is the view from where the camera is: the sphere turns with it. Bright is good. The mouse
/// over the sphere asks for a look from there, a click goes there, a drag turns the view as one in the picture does.
class ViewGlobe : public QWidget, public Spoken {
    Q_OBJECT
public:
    explicit ViewGlobe(QWidget* parent = nullptr);

    /// Pale where it is not `current`. `best`: the direction of the best view, where it is known.
    void setMap(const ViewMap& map, bool current, const std::optional<Vec3>& best);
    void setCamera(const Camera& camera, WorldAxes axes);
    /// What is said of a direction under the mouse.
    void setWords(std::function<QString(const Vec3&)> words) { m_words = std::move(words); }

    /// The direction of the eye that a point of the widget stands for; empty beside the sphere.
    std::optional<Vec3> directionAt(const QPointF& point) const;
    /// Where a direction is painted; empty on the far side.
    std::optional<QPointF> pointOf(const Vec3& direction) const;
    QColor colorOf(double value) const; ///< of the map's figure

    QSize sizeHint() const override { return {220, 246}; }
    QSize minimumSizeHint() const override { return {120, 146}; }
    QString spokenValue() const override;

Q_SIGNALS:
    void hovered(const pellucid::Vec3& towardEye);
    void left(); ///< the mouse is over the sphere no more
    void chosen(const pellucid::Vec3& towardEye);
    void dragBegan();
    void dragged(const QPointF& way); ///< in radii of the sphere, since the last one

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    QPointF middle() const;
    double radius() const;
    double valueAt(const Vec3& direction) const;
    void hover(const QPointF& point);
    void endHover();
    void paintSphere(QPainter& painter) const;
    void paintMarks(QPainter& painter) const;
    void paintLegend(QPainter& painter) const;

    ViewMap m_map;
    std::vector<float> m_table; ///< of the map, by elevation and azimuth
    double m_worst = 0, m_best = 1;
    bool m_current = false;
    std::optional<Vec3> m_bestDirection;
    Camera m_camera;
    WorldAxes m_worldAxes = WorldAxes::File;
    std::function<QString(const Vec3&)> m_words;
    bool m_hovering = false, m_pressed = false, m_dragging = false;
    QPointF m_from, m_last;
};

} // namespace pellucid::gui
