// Over the picture of A: how much B differs from it, and what A is called beside B.
#pragma once

#include <QImage>

#include "view/view_overlay.h"

namespace pellucid::gui {

class ComparisonController;

/// Draws the map of ΔE with a legend where the session asks for it and it is of the present pictures; takes no clicks.
class DifferenceLayer : public OverlayLayer {
public:
    /// Both outlive this.
    DifferenceLayer(ComparisonController& comparing, ViewOverlay& overlay);
    void paint(QPainter& painter, const LayerView& view) override;

private:
    void paintMap(QPainter& painter, const LayerView& view);
    void paintLegend(QPainter& painter, const QSizeF& size, bool current) const;

    ComparisonController& m_comparing;
    QImage m_image; ///< of the version and strength below
    quint64 m_version = 0;
    double m_strength = 0;
    double m_top = 0; ///< ΔE at the end of the colours
};

/// The end of a scale for differences up to `largest`: the same for many pictures, so that they compare.
double topOfDifferences(double largest);

} // namespace pellucid::gui
