// What is only looked at over the picture: annotations, and where slices lie.
#pragma once

#include "view/view_overlay.h"
#include "widgets/mark_painter.h"

namespace pellucid::gui {

class FieldController;

/// Draws what the session's AnnotationChoice switches on, and title and legend of a field; takes no clicks.
class AnnotationLayer : public OverlayLayer {
public:
    /// `fields` outlives this; null: the view shows the data.
    explicit AnnotationLayer(const FieldController* fields = nullptr) : m_fields(fields) {}
    void paint(QPainter& painter, const LayerView& view) override;

private:
    const FieldController* m_fields;
    MarkPainter m_marks;
};

/// The outlines of the slices and the crosshair, while slices are shown; takes no clicks.
class SliceLayer : public OverlayLayer {
public:
    void paint(QPainter& painter, const LayerView& view) override;
};

} // namespace pellucid::gui
