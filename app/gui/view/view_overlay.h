// What is drawn over the picture: handles that the mouse can take hold of, letters, scales.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QWidget>

#include "render/clip_handles.h"
#include "store/session_store.h"

namespace pellucid::gui {

/// What a layer draws over: the present scene, which has a volume, and the view's size in logical pixels, as are all
/// points here.
struct LayerView {
    const Scene& scene;
    QSizeF size;
    PictureView picture() const {
        return {scene.camera, std::max(1, static_cast<int>(size.width())),
                std::max(1, static_cast<int>(size.height()))};
    }
};

/// One sort of things over the picture. Layers keep no state of the scene: they are asked anew.
class OverlayLayer {
public:
    virtual ~OverlayLayer() = default;
    virtual void paint(QPainter& painter, const LayerView& view) = 0;
    /// The cursor over a point where a press would be taken; Qt::ArrowCursor elsewhere.
    virtual Qt::CursorShape cursorAt(const QPointF& /*point*/, const LayerView& /*view*/) { return Qt::ArrowCursor; }
    /// True: the press is taken, and drags and the release go here.
    virtual bool press(const QPointF& /*point*/, Qt::KeyboardModifiers /*keys*/, const LayerView& /*view*/) {
        return false;
    }
    virtual void drag(const QPointF& /*point*/, Qt::KeyboardModifiers /*keys*/, const LayerView& /*view*/) {}
    /// The end of what a press began: `kept` by the release, or given up, as if nothing had been pressed.
    virtual void end(bool /*kept*/) {}
    /// Clicks, a press and release in one place that no press() has taken, are for this layer.
    virtual bool wantsClicks() const { return false; }
    virtual void click(const QPointF& /*point*/, const LayerView& /*view*/) {}
    /// A key that the view has got (Qt::Key); true: it is taken.
    virtual bool key(int /*key*/, const LayerView& /*view*/) { return false; }
};

/// A transparent widget over the view that holds layers, the last one on top. The view hands it the mouse.
class ViewOverlay : public QWidget {
public:
    ViewOverlay(SessionStore& store, QWidget* view);

    void add(std::unique_ptr<OverlayLayer> layer);
    /// What is drawn lies where another camera sees it; empty: the scene's own.
    void lookFrom(const std::optional<Camera>& camera);

    bool press(const QPointF& point, Qt::KeyboardModifiers keys);
    bool isDragging() const { return m_holder != nullptr; }
    void drag(const QPointF& point, Qt::KeyboardModifiers keys);
    void release() { end(true); }
    void cancel() { end(false); }
    bool wantsClicks() const;
    void click(const QPointF& point); ///< wantsClicks() is true
    bool key(int key);
    Qt::CursorShape cursorAt(const QPointF& point);

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    void end(bool kept);
    LayerView overlayView() const { return {m_glimpse ? *m_glimpse : m_store.scene(), QSizeF(size())}; }

    SessionStore& m_store;
    std::vector<std::unique_ptr<OverlayLayer>> m_layers;
    std::optional<Scene> m_glimpse;   ///< the scene from elsewhere
    OverlayLayer* m_holder = nullptr; ///< has taken the press
};

} // namespace pellucid::gui
