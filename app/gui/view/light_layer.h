// The light that a hand turns, over the picture.
#pragma once

#include "view/view_overlay.h"

namespace pellucid::gui {

class Services;

/// Ctrl + left drag turns the light like a ball, which is shown meanwhile. It goes on where it was off.
class LightLayer : public OverlayLayer {
public:
    LightLayer(Services& services, QWidget& overlay) : m_services(services), m_overlay(overlay) {}

    void paint(QPainter& painter, const LayerView& view) override;
    bool press(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) override;
    void drag(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) override;
    void end(bool kept) override;

private:
    Services& m_services;
    QWidget& m_overlay;
    bool m_held = false;
    QPointF m_from;
    Vec3 m_start{0, 0, 1}; ///< where the light came from then
};

} // namespace pellucid::gui
