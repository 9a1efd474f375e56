// The picture drawn by the raycaster in the window's own OpenGL context.
#pragma once

#include <memory>

#include <QElapsedTimer>
#include <QOpenGLWidget>

#include "jobs/rest_timer.h"
#include "view/view_surface.h"

class QOpenGLFramebufferObject;

namespace pellucid::gl {
class VisionFilter;
class VolumeRaycaster;
} // namespace pellucid::gl

namespace pellucid::gui {

/// Draws into a framebuffer of its own, at first coarsely within a time budget that it learns to keep, later strip by
/// strip between the window's events, so that even a software OpenGL never makes the window wait.
class GlSurface : public QOpenGLWidget, public ViewSurface {
    Q_OBJECT
public:
    explicit GlSurface(QWidget* parent = nullptr);
    ~GlSurface() override;

    /// Whether this machine gives a context that can draw (OpenGL 4.3 core or later), and by what; tries one.
    enum class Available { No, InSoftware, OnGpu };
    static Available available(QString* renderer = nullptr);

    QWidget* widget() override { return this; }
    void setScene(const PictureInput& scene) override;
    const PictureInfo& picture() const override { return m_info; }
    QString rendererName() const override { return m_rendererName; }

protected:
    void initializeGL() override;
    void resizeGL(int width, int height) override;
    void paintGL() override;

private:
    void releaseGl();
    double samples(const PicturePlan& plan) const; ///< estimated number of those of a whole picture
    PicturePlan quickPlan() const;
    PicturePlan fullPlan() const;
    PicturePlan finishedPlan() const; ///< as it would be saved
    void beginAnew();
    void prepareScene();
    void drawQuick();
    bool drawStrip(const PicturePlan& plan); ///< from m_nextRow on; true: it was the last
    void refine();
    void finishPicture(const PicturePlan& plan);
    void fail(const Error& error);
    void showPicture();

    PictureInput m_scene;
    std::unique_ptr<gl::VolumeRaycaster> m_raycaster;
    std::unique_ptr<gl::VisionFilter> m_filter; ///< null as long as nobody wants other eyes
    std::shared_ptr<const Volume> m_uploaded;
    std::unique_ptr<QOpenGLFramebufferObject> m_picture;
    bool m_software = true, m_failed = false;
    QString m_rendererName;

    bool m_dirty = true;               ///< the scene has changed since the picture was begun
    double m_nanosecondsPerSample = 0; ///< as measured; 0: not yet
    /// Milliseconds that the scene must stay the same before it is drawn well.
    RestTimer m_idle{200, [this] {
                         m_nextRow = 0;
                         refine();
                     }};
    RestTimer m_next{0, [this] { refine(); }}; ///< to the next strip
    bool m_finishing = false; ///< the full picture is there, what is refined now is the one to be saved
    int m_nextRow = 0;        ///< first row that has not been refined
    QElapsedTimer m_sinceShown;
    PictureInfo m_info;
};

} // namespace pellucid::gui
