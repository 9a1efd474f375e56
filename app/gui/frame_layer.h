// The frame of reference over the picture in the window.
#pragma once

#include "view_overlay.h"

namespace pellucid::gui {

/// Draws what the session's FrameOfReference switches on; takes no clicks.
class FrameLayer : public OverlayLayer {
public:
    void paint(QPainter& painter, const OverlayView& view) override;
};

} // namespace pellucid::gui
