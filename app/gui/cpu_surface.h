// The picture drawn by the CPU renderer on threads: for machines without OpenGL 4.3.
#pragma once

#include <memory>

#include <QImage>
#include <QTimer>
#include <QWidget>

#include "background_task.h"
#include "view_surface.h"

namespace pellucid::gui {

class CpuSurface : public QWidget, public ViewSurface {
    Q_OBJECT
public:
    explicit CpuSurface(QWidget* parent = nullptr);
    ~CpuSurface() override;

    QWidget* widget() override { return this; }
    void setScene(const ViewScene& scene) override;
    const FrameInfo& frame() const override { return m_frame; }
    QString rendererName() const override { return tr("CPU"); }

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    struct Renderer; // shared with threads that have been cancelled but have not noticed yet
    void restart();
    void draw(bool full);

    ViewScene m_scene;
    std::shared_ptr<Renderer> m_renderer;
    QImage m_picture;
    FrameInfo m_frame;
    double m_quickScale = 0.2; ///< adapted to the time that pictures take
    bool m_again = false;      ///< the scene changed while a coarse picture was being drawn
    bool m_drawingQuick = false;
    QTimer m_idle;
    BackgroundTask m_task; // last: its threads end before the rest goes
};

} // namespace pellucid::gui
