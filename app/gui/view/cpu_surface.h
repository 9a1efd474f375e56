// The picture drawn by the CPU renderer on threads: for machines without a GPU.
#pragma once

#include <memory>

#include <QImage>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "view/view_surface.h"

namespace pellucid {
class TileRenderer;
}

namespace pellucid::gui {

/// While the scene changes, pictures are quick ones (TileRenderer::preview()), as fine as there is time for, judged by
/// how long the last one took. At rest the full picture grows from where the mouse points, and then over it the one
/// that would be saved. Nothing is computed while nothing changes.
class CpuSurface : public QWidget, public ViewSurface {
    Q_OBJECT
public:
    explicit CpuSurface(QWidget* parent = nullptr);
    ~CpuSurface() override;

    QWidget* widget() override { return this; }
    void setScene(const PictureInput& scene) override;
    const PictureInfo& picture() const override { return m_info; }
    QString rendererName() const override { return tr("CPU"); }

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    struct Drawing; ///< what m_lane has to itself
    struct Growing;
    enum class Stage { Quick, Full, Finished };
    /// Samples that a quick picture can afford, of those of a full one; follows the time that pictures take.
    struct Affordable {
        double inSlices = 0.5; ///< drawn in storage order
        double alongRays = 0.25;
    };
    struct Task {
        PictureInput input;
        QSize pixels; ///< of the widget
        Stage stage;
        PicturePlan plan; ///< a quick picture makes its own, by what is affordable
        Affordable affordable;
        QPoint focus;                     ///< pixel from which a picture grows
        std::shared_ptr<Growing> growing; ///< where it does; null: a quick picture
    };
    struct Picture {
        QImage image; ///< null: what has grown is it
        PicturePlan plan;
        bool inSlices = false; ///< a quick picture, drawn in storage order
        double seconds = 0;
    };
    static Picture drawn(Drawing& drawing, const Task& task, const JobControl& job);
    static Picture quick(TileRenderer& renderer, const Task& task, const JobControl& job);
    static PicturePlan planFor(const Affordable& affordable, bool inSlices);
    void restart();
    void draw(Stage stage);
    void show(const Task& task, const Picture& picture);
    void takeGrown();

    PictureInput m_scene;
    std::unique_ptr<Drawing> m_drawing;
    std::shared_ptr<Growing> m_growing; ///< the picture under way that grows, null: none
    QImage m_picture;                   ///< shown over m_target, device pixels
    QSizeF m_target;
    PictureInfo m_info;
    Affordable m_affordable;
    bool m_again = false;                            ///< the scene changed while a coarse picture was being drawn
    Stage m_next = Stage::Full;                      ///< when the scene rests
    RestTimer m_idle{120, [this] { draw(m_next); }}; ///< milliseconds without a change before the full picture is begun
    QTimer m_grow;
    Lane m_lane;              // one thread for all pictures: they wait for the renderer anyway
    Job<Task, Picture> m_job; // last: its work ends before the rest goes
};

} // namespace pellucid::gui
