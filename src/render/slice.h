// A plane of the grid as a picture: the colours of the transfer function, or of voxels, over grey (docs/method.md,
// "Slices").
#pragma once

#include <memory>
#include <optional>

#include <glm/vec2.hpp>

#include "base/image.h"
#include "render/clipping.h"
#include "tf/transfer_function.h"
#include "volume/voxel_colors.h"

namespace pellucid {

struct Overlay;

using Vec2 = glm::dvec2;

/// Which index axes run to the right and down the picture of a slice, and whether against the picture's direction.
struct SliceView {
    int right = 0, down = 1;
    bool flipRight = false, flipDown = false;
    bool operator==(const SliceView&) const = default;
};

/// Of the slice perpendicular to the index axis `axis` (0, 1, 2). In the patient's axes as radiologists are used to:
/// axial as seen from the feet (left at the picture's right, anterior up), coronal from the front (left at the right,
/// superior up), sagittal from the left (anterior at the left, superior up). In the file's own axes x and y run to the
/// right, y (below z) and z upward. Axes count by the world axis that they are nearest to, each to another one.
SliceView sliceView(const Geometry& geometry, int axis);

/// The world axis (0, 1, 2) that an index axis counts by, above.
int sliceWorldAxis(const Geometry& geometry, int axis);

/// "axial", "coronal", "sagittal" in the patient's axes, else the world axis that it is perpendicular to: "x", "y",
/// "z".
const char* sliceName(const Geometry& geometry, int axis);

/// A part of a slice's plane: world lengths from the upper left corner of the box, to the right and down the picture.
/// The plane is drawn at right angles, each axis in its spacing; beyond the box there is nothing.
struct SliceRect {
    double left = 0, top = 0, width = 1, height = 1; ///< width, height > 0
    bool operator==(const SliceRect&) const = default;
};

/// The part of a plane that a picture shows.
struct SlicePlane {
    int axis = 2;        ///< index axis that it is perpendicular to
    double position = 0; ///< voxel coordinate along it; beyond the box nothing is drawn
    SliceRect shown;
    int width = 512, height = 512; ///< of the picture, pixels
    bool operator==(const SlicePlane&) const = default;
};

/// Width and height of the whole plane, world units.
Vec2 sliceSize(const Geometry& geometry, int axis);
/// The whole plane in the middle of a picture of this size, pixels square, as large as it fits.
SliceRect fittedSlice(const Geometry& geometry, int axis, int width, int height);

/// Pixels count from the picture's top left corner, centres at +0.5.
Vec3 voxelAtPixel(const Geometry& geometry, const SlicePlane& plane, const Vec2& pixel);
/// Of the voxel's projection on the plane.
Vec2 pixelOfVoxel(const Geometry& geometry, const SlicePlane& plane, const Vec3& voxel);

/// A fraction of the box along an index axis, as clipping takes it, as voxel coordinate: 0 and 1 are the box's sides.
inline double slicePosition(const Geometry& geometry, int axis, double fraction) {
    return fraction * geometry.dims[axis] - 0.5;
}

/// Data units, trilinear over the valid voxels around (`linear` false: of the nearest voxel). Empty beyond the box, and
/// where invalid voxels have more than half of the weight.
std::optional<double> valueAt(const Volume& volume, const Vec3& voxel, bool linear = true);

struct SliceSettings {
    ValueRange window;                         ///< of grey: black and white, data units, lo ≤ hi
    double tfStrength = 0.5;                   ///< 0: grey alone … 1: colours of the transfer function alone
    bool linear = true;                        ///< false: each pixel has the value of the nearest voxel
    Clipping clipping;                         ///< what is cut away is transparent
    std::shared_ptr<const VoxelColors> colors; ///< in place of those of the transfer function; null: none
    std::shared_ptr<const Overlay> overlay;    ///< a second volume, laid over both; null: none
    bool operator==(const SliceSettings&) const = default;
    void validate() const; ///< throws UsageError
};

/// The slice; transparent beyond the box and, but for the overlay, where voxels are invalid. Intensities refer to
/// volume.range(), whatever the window of grey.
Image renderSlice(const Volume& volume, const TransferFunction& tf, const SlicePlane& plane,
                  const SliceSettings& settings);

} // namespace pellucid
