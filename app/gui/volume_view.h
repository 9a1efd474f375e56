// The volume in the middle of the window, and the hands that turn it.
#pragma once

#include <memory>

#include <QPointF>
#include <QWidget>

#include "models/document.h"
#include "view_surface.h"

namespace pellucid::gui {

enum class ViewRenderer { Auto, Gl, Cpu };
enum class StandardView { Front, Back, Left, Right, Top, Bottom };

/// Shows the document's scene, moves its camera: left-drag rotates, middle or Shift+left pans, wheel and right-drag
/// zoom, double-click fits, arrow keys rotate.
class VolumeView : public QWidget {
    Q_OBJECT
public:
    /// Gl throws Error where there is none; Auto then draws on the CPU.
    explicit VolumeView(Document& document, ViewRenderer renderer = ViewRenderer::Auto, QWidget* parent = nullptr);
    ~VolumeView() override;

    const FrameInfo& frame() const { return m_surface->frame(); }
    bool isComplete() const { return m_surface->frame().complete; }
    QString rendererName() const { return m_surface->rendererName(); }

    void fit();       ///< the same direction, the whole box
    void resetView(); ///< as the volume opened
    void setStandardView(StandardView view);
    void setProjection(Projection projection);
    void zoomBy(double factor);

    QSize sizeHint() const override { return {860, 520}; }
    QSize minimumSizeHint() const override { return {240, 180}; }

Q_SIGNALS:
    void frameShown();
    /// OpenGL gave up (a volume too large for the device, say) and the CPU draws from now on; or nobody can draw.
    void rendererFailed(const QString& what, const QString& where, const QString& whatToDo);

protected:
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    enum class Motion { None, Rotate, Pan, Zoom };
    void setSurface(std::unique_ptr<ViewSurface> surface);
    void surfaceFailed(const Error& error);
    void updateScene();

    Document& m_document;
    std::unique_ptr<ViewSurface> m_surface;
    Motion m_motion = Motion::None;
    Qt::MouseButton m_button = Qt::NoButton;
    QPointF m_last;
};

} // namespace pellucid::gui
