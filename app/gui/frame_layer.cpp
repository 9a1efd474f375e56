#include "frame_layer.h"

#include "mark_painter.h"
#include "render/annotation.h"

namespace pellucid::gui {

void FrameLayer::paint(QPainter& painter, const OverlayView& view) {
    const FrameOfReference& show = *view.scene.session.reference;
    const QSize size = view.size.toSize();
    if (!show.any() || size.isEmpty()) return;
    const PictureInput picture = pictureInput(view.scene, size.width(), size.height());
    for (const Mark& mark : annotationMarks(annotationInput(picture, show))) drawMark(painter, mark);
}

} // namespace pellucid::gui
