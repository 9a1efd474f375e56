#include "session/slice_input.h"

#include "tf/shown_tf.h"

namespace pellucid {

SliceInput sliceInput(const Scene& scene) {
    const SliceViews& views = *scene.session.slices;
    SliceInput input{scene.volume, shownTf(scene.tf), {}};
    input.settings.window = views.window.value_or(scene.volume->range());
    input.settings.tfStrength = views.tfStrength;
    input.settings.clipping = *scene.session.clipping;
    input.settings.colors = scene.colors;
    input.settings.overlay = scene.overlay;
    return input;
}

SliceInput fieldSliceInput(const Scene& scene, const Field& field) {
    SliceInput input{field.volume, fieldSliceTf(fieldPictureInput(scene, field, 1, 1).tf), {}};
    input.settings.window = field.volume->range();
    input.settings.tfStrength = 1;
    input.settings.clipping = *scene.session.clipping;
    return input;
}

} // namespace pellucid
