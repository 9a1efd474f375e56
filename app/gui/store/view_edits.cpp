#include "store/view_edits.h"

#include <glm/common.hpp>

#include "render/camera_motion.h"

namespace pellucid::gui {

void fitView(SessionStore& store) {
    if (store.hasVolume()) store.setCamera(fitted(store.scene().camera, store.scene().volume->geometry()));
}

void resetView(SessionStore& store) {
    if (store.hasVolume())
        store.setCamera(homeCamera(store.scene().volume->geometry(), store.scene().camera.projection));
}

void setStandardView(SessionStore& store, StandardView view) {
    if (!store.hasVolume()) return;
    const Geometry& geometry = store.scene().volume->geometry();
    const ViewAngles angles = anglesOf(view, geometry.frame);
    store.setCamera(standardCamera(geometry, angles.azimuth, angles.elevation, store.scene().camera.projection));
}

void setProjection(SessionStore& store, Projection projection) {
    if (!store.hasVolume()) return;
    store.setCamera(withProjection(store.scene().camera, store.scene().volume->geometry(), projection));
}

void zoomView(SessionStore& store, double factor, int gesture) {
    if (store.hasVolume())
        store.setCamera(zoomed(store.scene().camera, store.scene().volume->geometry(), factor), gesture);
}

Vec3 crosshairOf(const Scene& scene) {
    const Int3 dims = scene.volume->dims();
    return glm::clamp(scene.session.slices->crosshair.value_or(Vec3(dims / 2)), Vec3(0), Vec3(dims) - 1.0);
}

ValueRange greyWindowOf(const Scene& scene) { return scene.session.slices->window.value_or(scene.volume->range()); }

void moveCrosshair(SessionStore& store, const Vec3& voxel) {
    if (!store.hasVolume()) return;
    store.setCrosshair(glm::clamp(glm::floor(voxel + 0.5), Vec3(0), Vec3(store.scene().volume->dims()) - 1.0));
}

void moveCrosshairToWorld(SessionStore& store, const Vec3& world) {
    if (store.hasVolume()) moveCrosshair(store, store.scene().volume->geometry().voxelFromWorld(world));
}

void setLayout(SessionStore& store, SliceViews::Layout layout) {
    store.edit(QObject::tr("Layout"), {},
               [layout](Session& session) { session.slices.edit([layout](SliceViews& s) { s.layout = layout; }); });
}

void resetGreyWindow(SessionStore& store) {
    store.edit(QObject::tr("Reset the window of grey"), {},
               [](Session& session) { session.slices.edit([](SliceViews& s) { s.window.reset(); }); });
}

} // namespace pellucid::gui
