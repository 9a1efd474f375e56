// The picture drawn by the CPU renderer on threads: for machines without OpenGL 4.3.
#pragma once

#include <memory>

#include <QImage>
#include <QTimer>
#include <QWidget>

#include "jobs/job.h"
#include "view_surface.h"

namespace pellucid::gui {

class CpuSurface : public QWidget, public ViewSurface {
    Q_OBJECT
public:
    explicit CpuSurface(QWidget* parent = nullptr);
    ~CpuSurface() override;

    QWidget* widget() override { return this; }
    void setScene(const PictureInput& scene) override;
    const FrameInfo& frame() const override { return m_frame; }
    QString rendererName() const override { return tr("CPU"); }

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    struct Renderer; // shared with threads that have been cancelled but have not noticed yet
    struct Task {
        PictureInput input;
        QSize pixels; ///< of the widget
        double scale = 1;
        bool full = false;
    };
    struct Picture {
        QImage image;
        double seconds = 0;
    };
    void restart();
    void draw(bool full);
    void show(const Task& task, const Picture& picture);

    PictureInput m_scene;
    std::shared_ptr<Renderer> m_renderer;
    QImage m_picture;
    FrameInfo m_frame;
    double m_quickScale = 0.2; ///< adapted to the time that pictures take
    bool m_again = false;      ///< the scene changed while a coarse picture was being drawn
    bool m_drawingQuick = false;
    QTimer m_idle;
    Job<Task, Picture> m_job; // last: its threads end before the rest goes
};

} // namespace pellucid::gui
