// The volume in the middle of the window, and the hands that turn it.
#pragma once

#include <memory>
#include <optional>

#include <QPointF>
#include <QWidget>

#include "engines/renderer_probe.h"
#include "jobs/job.h"
#include "store/session_store.h"
#include "view/camera_hand.h"
#include "view/view_overlay.h"
#include "view/view_surface.h"
#include "widgets/spoken_value.h"

namespace pellucid::gui {

class FieldController;

enum class ViewRenderer { Auto, Gl, Cpu };

/// Shows the store's scene, moves its camera: left-drag rotates, middle or Shift+left pans, wheel and right-drag
/// zoom, double-click fits, arrow keys rotate; layers of the overlay take the left button first.
class VolumeView : public QWidget, public Spoken {
    Q_OBJECT
public:
    /// Auto draws with whichever is faster here. As long as that has not been measured, which happens beside the first
    /// pictures, it is OpenGL on a GPU and the CPU else. Gl throws Error where there is none.
    /// `fields`, which outlives this, says what is drawn in the place of the data; null: never anything.
    explicit VolumeView(SessionStore& store, ViewRenderer renderer = ViewRenderer::Auto, QWidget* parent = nullptr,
                        FieldController* fields = nullptr);
    ~VolumeView() override;

    const PictureInfo& picture() const { return m_surface->picture(); }
    bool isComplete() const { return m_surface->picture().complete; }
    ViewOverlay& overlay() { return *m_overlay; }
    /// Shows the scene from another camera for a while; empty: from its own again. The store hears nothing of it.
    void lookFrom(const std::optional<Camera>& camera);
    bool drawsByGl() const; ///< else by the CPU
    QString rendererName() const { return m_surface->rendererName(); }
    QString rendererReason() const; ///< why it draws, a sentence

    QSize sizeHint() const override { return {860, 520}; }
    QSize minimumSizeHint() const override { return {160, 100}; }
    QString spokenValue() const override;

Q_SIGNALS:
    void pictureShown();
    /// The left button went down and up in one place, logical pixels, which nothing over the picture has taken.
    void clicked(const QPointF& point);
    /// OpenGL gave up (a volume too large for the device, say) and the CPU draws from now on; or nobody can draw.
    void rendererFailed(const pellucid::Error& error);

protected:
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    void setSurface(std::unique_ptr<ViewSurface> surface);
    void surfaceFailed(const Error& error);
    void chooseRenderer(ViewRenderer wanted);
    void startProbe();
    void showTimes(const RendererTimes& times);
    void updateScene();

    SessionStore& m_store;
    FieldController* const m_fields;
    std::optional<Camera> m_glimpse;
    std::unique_ptr<ViewSurface> m_surface;
    ViewOverlay* m_overlay; // a child
    CameraHand m_hand;
    QString m_reason;
    QString m_machine; ///< renderer, processors and version, for which times are kept
    bool m_expectGl = false, m_probeWaits = false;
    bool m_glSetAside = false;       ///< the CPU draws as long as there is an overlay, which OpenGL does not draw
    Job<int, RendererTimes> m_probe; // last: it ends before the rest goes
};

} // namespace pellucid::gui
