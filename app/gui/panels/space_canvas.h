// The picture of a parameter space: turned, read and picked from with the mouse.
#pragma once

#include <memory>

#include <QImage>
#include <QWidget>

#include "jobs/job.h"
#include "report/space_picture.h"
#include "widgets/kept_renderer.h"
#include "widgets/spoken_value.h"

namespace pellucid::gui {

/// Drawn by the CPU off this thread; what the mouse does is of the picture that is seen.
class SpaceCanvas : public QWidget, public Spoken {
    Q_OBJECT
public:
    explicit SpaceCanvas(QWidget* parent = nullptr);

    /// What is drawn; null: nothing. Camera and sizes of `view` are the canvas's own.
    void setSpace(std::shared_ptr<const ParameterSpace> space, SpaceView view);
    /// Pale and with `remark` over it; nothing can be read or picked then. Empty: it is of the present state.
    void setOutdated(const QString& remark);
    void setPickable(bool pickable) { m_pickable = pickable; }

    const std::shared_ptr<const ParameterSpace>& space() const { return m_space; }
    /// Of the picture that is seen, in logical pixels.
    SpaceView shownView() const;
    bool isComplete() const { return m_space == m_drawnSpace && !m_job.isRunning(); }
    QSize sizeHint() const override { return {340, 320}; }
    QSize minimumSizeHint() const override { return {160, 160}; }
    QString spokenValue() const override;

Q_SIGNALS:
    /// Of the place below the mouse; empty: there is none.
    void read(const QString& text);
    /// Opacities of all features, from a place of a heat map or a state of a path.
    void picked(const std::vector<double>& opacities);

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    struct Task {
        std::shared_ptr<const ParameterSpace> space;
        SpaceView view;
        std::shared_ptr<const Volume> volume; ///< null of two features
    };
    void draw();
    void readAt(const QPointF& at);
    bool canRead() const { return m_space != nullptr && m_drawnSpace == m_space && m_outdated.isEmpty(); }

    std::shared_ptr<const ParameterSpace> m_space, m_drawnSpace; ///< as wanted; of m_picture
    SpaceView m_view, m_drawn;                                   ///< likewise; device pixels
    std::shared_ptr<const Volume> m_volume;                      ///< of m_space
    double m_azimuth = kSpaceAzimuth, m_elevation = kSpaceElevation, m_zoom = 1;
    QString m_outdated;
    bool m_pickable = true;
    QImage m_picture;
    QPointF m_pressedAt, m_lastAt;
    bool m_turning = false;
    std::shared_ptr<KeptRenderer> m_renderer;
    Job<Task, QImage> m_job; // last: it ends before the rest goes
};

} // namespace pellucid::gui
