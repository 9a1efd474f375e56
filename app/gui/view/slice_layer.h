// Where the slices lie in the volume, over its picture.
#pragma once

#include "view/view_overlay.h"

namespace pellucid::gui {

/// The outlines of the slices and the crosshair, while slices are shown; takes no clicks.
class SliceLayer : public OverlayLayer {
public:
    void paint(QPainter& painter, const OverlayView& view) override;
};

} // namespace pellucid::gui
