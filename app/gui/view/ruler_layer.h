// Measures over the picture and over slices, and the hands that set and change them.
#pragma once

#include <optional>

#include "render/ruler_marks.h"
#include "view/view_overlay.h"

namespace pellucid::gui {

class RulerController;

/// What picture and slices have in common: the handle that a hand has taken hold of, or is over.
class RulerHand {
public:
    explicit RulerHand(RulerController& rulers) : m_rulers(rulers) {}

    void paint(QPainter& painter, const std::vector<Mark>& marks, const std::vector<RulerHandle>& handles) const;
    /// True: the mouse is over another handle, or none, than before.
    bool hover(const std::vector<RulerHandle>& handles, const QPointF& point);
    void leave() { m_hovered.reset(); }
    bool isOver() const { return m_hovered.has_value(); }

    bool press(const std::vector<RulerHandle>& handles, const QPointF& point); ///< true: it holds one now
    bool isHolding() const { return m_held.has_value(); }
    const RulerHandle& held() const { return *m_held; }
    const Ruler& start() const { return m_start; } ///< the ruler when it was taken
    void drag(const Vec3& world);
    void end(bool kept, SessionStore& store);
    bool key(int key); ///< Qt::Key; true: it is taken

private:
    RulerController& m_rulers;
    std::optional<RulerHandle> m_hovered, m_held;
    Ruler m_start;
};

/// Over the picture. A click sets a point where something is seen; ends of distances and angles follow what is seen
/// under the mouse, all else stays at its depth.
class RulerLayer : public OverlayLayer {
public:
    RulerLayer(RulerController& rulers, SessionStore& store, QWidget& overlay);

    void paint(QPainter& painter, const LayerView& view) override;
    Qt::CursorShape cursorAt(const QPointF& point, const LayerView& view) override;
    bool press(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) override;
    void drag(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) override;
    void end(bool kept) override;
    bool key(int key, const LayerView& view) override;
    bool wantsClicks() const override;
    void click(const QPointF& point, const LayerView& view) override;

private:
    std::vector<RulerHandle> handles(const LayerView& view) const;
    /// Of the next point; empty where nothing is seen.
    std::optional<Vec3> placeAt(const QPointF& point, const LayerView& view) const;

    RulerController& m_rulers;
    SessionStore& m_store;
    QWidget& m_overlay;
    RulerHand m_hand;
};

} // namespace pellucid::gui
