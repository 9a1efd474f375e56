#include "view/annotation_layer.h"

#include <array>

#include <QPainter>

#include "controllers/field_controller.h"
#include "render/annotation.h"
#include "render/slice.h"
#include "store/view_edits.h"
#include "view/slice_pane.h"

namespace pellucid::gui {

void AnnotationLayer::paint(QPainter& painter, const LayerView& view) {
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
    input.axes = view.scene.session.coordinates->axes; // measures have a layer of their own
    if (!input.show.any()) return;
    m_marks.draw(painter, annotationMarks(input));
}

void SliceLayer::paint(QPainter& painter, const LayerView& view) {
    if (view.scene.session.slices->layout == SliceViews::Layout::Volume) return;
    const Geometry& geometry = view.scene.volume->geometry();
    const PictureView picture = view.picture();
    const Vec3 crosshair = crosshairOf(view.scene), lo = geometry.voxelBoxMin(), hi = geometry.voxelBoxMax();
    const auto draw = [&](const Vec3& from, const Vec3& to, const QColor& color, double width) {
        const auto a = pixelOf(picture, geometry.worldFromVoxel(from)),
                   b = pixelOf(picture, geometry.worldFromVoxel(to));
        if (!a || !b) return;
        painter.setPen(QPen(color, width));
        painter.drawLine(QPointF(a->x, a->y), QPointF(b->x, b->y));
    };
    for (int axis = 0; axis < 3; ++axis) {
        QColor color = slicePlaneColor(sliceWorldAxis(geometry, axis));
        color.setAlpha(150);
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<Vec3, 4> corners;
        corners.fill(crosshair);
        for (std::size_t n = 0; n < 4; ++n) {
            corners[n][u] = n == 0 || n == 3 ? lo[u] : hi[u];
            corners[n][v] = n < 2 ? lo[v] : hi[v];
        }
        for (std::size_t n = 0; n < 4; ++n) draw(corners[n], corners[(n + 1) % 4], color, 1);
    }
    // A cross along the axes where they meet, of one length on the screen.
    const auto middle = pixelOf(picture, geometry.worldFromVoxel(crosshair));
    if (!middle) return;
    constexpr double kArm = 13; // pixels
    const double length = kArm * worldPerPixel(picture, geometry.worldFromVoxel(crosshair));
    for (const bool halo : {true, false})
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 arm(0);
            arm[axis] = length / geometry.spacing[axis];
            draw(crosshair - arm, crosshair + arm,
                 halo ? QColor(0, 0, 0, 150) : slicePlaneColor(sliceWorldAxis(geometry, axis)), halo ? 4 : 2);
        }
}

} // namespace pellucid::gui
