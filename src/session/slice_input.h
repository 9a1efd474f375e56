// What a slice of a scene shows, wherever it lies: the data, or the field in the place of the data.
#pragma once

#include "render/slice.h"
#include "session/scene.h"

namespace pellucid {

/// Everything that a slice depends on but its plane (docs/method.md, "Slices").
struct SliceInput {
    std::shared_ptr<const Volume> volume;
    TransferFunction tf;
    SliceSettings settings; ///< window of grey, strength of the colours, clipping, colours of voxels
    bool operator==(const SliceInput&) const = default;
};

/// Of the data, as the session's SliceViews say; the scene has a volume.
SliceInput sliceInput(const Scene& scene);

/// Of a field, in the colours of fieldPictureInput(), which alone tell: opaque from the threshold on, black below it.
/// Window of grey and strength are not those of the session.
SliceInput fieldSliceInput(const Scene& scene, const Field& field);

} // namespace pellucid
