#include "session/home_view.h"

#include "optimize/views/opening_view.h"
#include "render/camera_motion.h"
#include "render/drawn_part.h"
#include "tf/shown_tf.h"

namespace pellucid {

Camera fittedView(const Scene& scene, const Camera& camera, const JobControl& job) {
    const DrawnPart part = drawnPart(*scene.volume, shownTf(scene.tf), *scene.session.clipping, job);
    return fittedTo(part, camera, scene.volume->geometry());
}

Camera homeView(const Scene& scene, Projection projection, const JobControl& job) {
    const TransferFunction tf = shownTf(scene.tf);
    const View home = openingView(*scene.volume, tf, findHolder(*scene.volume, tf, job), job);
    return fittedView(scene, withProjection(home.camera, scene.volume->geometry(), projection), job);
}

} // namespace pellucid
