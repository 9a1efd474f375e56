#include "view/annotation_layer.h"

#include <QPainter>

#include "controllers/field_controller.h"
#include "render/annotation.h"
#include "widgets/mark_painter.h"

namespace pellucid::gui {

void AnnotationLayer::paint(QPainter& painter, const OverlayView& view) {
    const AnnotationChoice& show = *view.scene.session.reference;
    const QSize size = view.size.toSize();
    if (size.isEmpty()) return;
    AnnotationInput input;
    if (m_fields) {
        PictureInput picture = m_fields->picture(size.width(), size.height());
        picture.camera = view.scene.camera; // a glimpse from elsewhere
        input = m_fields->annotation(picture, show);
    } else {
        input = annotationInput(pictureInput(view.scene, size.width(), size.height()), show);
    }
    if (!input.show.any()) return;
    for (const Mark& mark : annotationMarks(input)) drawMark(painter, mark);
}

} // namespace pellucid::gui
