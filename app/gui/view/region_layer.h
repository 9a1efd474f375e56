// The part of the picture whose colours refinement brings out: drawn, moved, removed over the picture.
#pragma once

#include <optional>

#include "render/image_region.h"
#include "view/view_overlay.h"

namespace pellucid::gui {

class RefineController;
class Services;

/// While RefineController::selecting() says so a drag draws a rectangle or a lasso. What was drawn stays where it is in
/// the picture: a rectangle has handles on corners and edges, and the inside of either moves it.
class RegionLayer : public OverlayLayer {
public:
    RegionLayer(Services& services, RefineController& refining, QWidget& overlay);

    void paint(QPainter& painter, const LayerView& view) override;
    Qt::CursorShape cursorAt(const QPointF& point, const LayerView& view) override;
    bool press(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) override;
    void drag(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) override;
    void end(bool kept) override;
    bool key(int key, const LayerView& view) override;

private:
    enum class Grip { None, Draw, Move, Resize };
    struct Hold {
        Grip grip = Grip::None;
        int right = 0, down = 0; ///< sides that Resize moves: −1 left or upper, 1 right or lower, 0 neither
    };
    Hold holdAt(const QPointF& point, const LayerView& view) const;

    Services& m_services;
    RefineController& m_refining;
    QWidget& m_overlay;
    Hold m_hold;
    QPointF m_from;
    QSizeF m_size;                       ///< of the view when the mouse was pressed
    ImageRegion m_start;                 ///< what was taken hold of
    std::optional<ImageRegion> m_region; ///< under way
};

} // namespace pellucid::gui
