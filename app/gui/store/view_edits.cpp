#include "store/view_edits.h"

#include <glm/common.hpp>

#include "render/camera_motion.h"
#include "session/home_view.h"
#include "store/edits.h"

namespace pellucid::gui {

namespace {

/// Sets the camera that `change` makes of the present one and the volume's geometry.
template <class Change>
void changeCamera(SessionStore& store, const Change& change, int gesture = 0) {
    if (store.hasVolume()) store.setCamera(change(store.scene().camera, store.scene().volume->geometry()), gesture);
}

} // namespace

void fitView(SessionStore& store) {
    if (store.hasVolume()) store.setCamera(fittedView(store.scene(), store.scene().camera));
}

void resetView(SessionStore& store) {
    if (store.hasVolume()) store.setCamera(homeView(store.scene(), store.scene().camera.projection));
}

void setStandardView(SessionStore& store, StandardView view) {
    changeCamera(store, [&](const Camera& now, const Geometry& g) {
        const ViewAngles angles = anglesOf(view, g.worldAxes);
        return fittedView(store.scene(), standardCamera(g, angles.azimuth, angles.elevation, now.projection));
    });
}

void setProjection(SessionStore& store, Projection projection) {
    changeCamera(store, [&](const Camera& now, const Geometry& g) { return withProjection(now, g, projection); });
}

void zoomView(SessionStore& store, double factor, int gesture) {
    changeCamera(
        store, [&](const Camera& now, const Geometry& g) { return zoomed(now, g, factor); }, gesture);
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
    editPart(store, &Session::slices, QObject::tr("Layout"), {}, [layout](SliceViews& s) { s.layout = layout; });
}

void resetGreyWindow(SessionStore& store) {
    editPart(store, &Session::slices, QObject::tr("Reset the window of grey"), {},
             [](SliceViews& s) { s.window.reset(); });
}

} // namespace pellucid::gui
