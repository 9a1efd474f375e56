// Handles of what is cut away, over the picture.
#pragma once

#include "view/view_overlay.h"

class QAction;

namespace pellucid::gui {

class Services;

/// The box that is left with a handle on each face, and each oblique plane with one that moves and one that turns it.
/// Drags are previews, so that picture and figures follow them.
class ClipLayer : public OverlayLayer {
public:
    ClipLayer(Services& services, QWidget& overlay) : m_services(services), m_overlay(overlay) {}

    void setShown(bool shown);

    void paint(QPainter& painter, const LayerView& view) override;
    Qt::CursorShape cursorAt(const QPointF& point, const LayerView& view) override;
    bool press(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) override;
    void drag(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) override;
    void end(bool kept) override;

private:
    enum class Kind { None, Face, Plane, Tip };
    struct Handle {
        Kind kind = Kind::None;
        int index = 0;      ///< axis of a face, else of Clipping::planes
        bool upper = false; ///< of faces
        bool operator==(const Handle&) const = default;
    };
    struct Placed {
        Handle handle;
        QPointF at;
        double depth;
    };
    std::vector<Placed> handles(const LayerView& view) const; ///< the nearest to the viewer last
    Handle handleAt(const QPointF& point, const LayerView& view) const;
    void paintBox(QPainter& painter, const LayerView& view) const;
    void paintPlanes(QPainter& painter, const LayerView& view) const;
    Clipping dragged(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) const;

    Services& m_services;
    QWidget& m_overlay;
    bool m_shown = false;
    Handle m_hovered, m_held;
    QPointF m_from;
    Clipping m_start; ///< when the handle was taken
};

/// The layer over the view, while the action is checked.
void addClipHandles(Services& services, QAction& shown, ViewOverlay& overlay);

} // namespace pellucid::gui
