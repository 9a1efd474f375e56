// What is drawn over the picture: handles that the mouse can take hold of, letters, scales.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QWidget>

#include "store/session_store.h"

namespace pellucid::gui {

/// What a layer is about: the present scene, which has a volume, and the view's size in logical pixels, as all points
/// here are.
struct OverlayView {
    const Scene& scene;
    QSizeF size;
};

/// One sort of things over the picture. Layers keep no state of the scene: they are asked anew.
class OverlayLayer {
public:
    virtual ~OverlayLayer() = default;
    virtual void paint(QPainter& painter, const OverlayView& view) = 0;
    /// The cursor over a point where a press would be taken; Qt::ArrowCursor elsewhere.
    virtual Qt::CursorShape cursorAt(const QPointF& /*point*/, const OverlayView& /*view*/) { return Qt::ArrowCursor; }
    /// True: the press is taken, and drags and the release go here.
    virtual bool press(const QPointF& /*point*/, Qt::KeyboardModifiers /*keys*/, const OverlayView& /*view*/) {
        return false;
    }
    virtual void drag(const QPointF& /*point*/, Qt::KeyboardModifiers /*keys*/, const OverlayView& /*view*/) {}
    virtual void release() {}
    virtual void cancel() { release(); } ///< in place of the release: as if it had not been pressed
    /// A key that the view has got (Qt::Key); true: it is taken.
    virtual bool key(int /*key*/, const OverlayView& /*view*/) { return false; }
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
    void release();
    void cancel();
    bool key(int key);
    Qt::CursorShape cursorAt(const QPointF& point);

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    OverlayView overlayView() const { return {m_glimpse ? *m_glimpse : m_store.scene(), QSizeF(size())}; }

    SessionStore& m_store;
    std::vector<std::unique_ptr<OverlayLayer>> m_layers;
    std::optional<Scene> m_glimpse;   ///< the scene from elsewhere
    OverlayLayer* m_holder = nullptr; ///< has taken the press
};

} // namespace pellucid::gui
