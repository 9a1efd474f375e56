// The saliency map over the picture.
#pragma once

#include <QImage>

#include "view/view_overlay.h"

namespace pellucid::gui {

class PictureSaliencyController;

/// Draws the map that the session asks for over the picture that it is of; takes no clicks.
class SaliencyLayer : public OverlayLayer {
public:
    /// Both outlive this.
    SaliencyLayer(PictureSaliencyController& saliency, ViewOverlay& overlay);
    void paint(QPainter& painter, const LayerView& view) override;

private:
    PictureSaliencyController& m_saliency;
    QImage m_image; ///< of the controller's version m_version
    quint64 m_version = 0;
};

} // namespace pellucid::gui
