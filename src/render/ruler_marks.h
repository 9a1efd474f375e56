// Measures (volume/ruler.h) as they are drawn over a picture or a slice, and the points by which a hand takes hold of
// them. Pure functions, so that the window and saved pictures show the same.
#pragma once

#include <vector>

#include "render/annotation.h"
#include "render/clip_handles.h"
#include "render/slice.h"

namespace pellucid {

/// How lines and texts look.
struct RulerLook {
    double density = 1;    ///< pixels in which lengths of the screen are one
    double capHeight = 11; ///< of the labels' capitals, pixels
};

/// Lines with a ring at each end and the label beside; what lies behind the eye is left out.
std::vector<Mark> rulerMarks(const std::vector<ShownRuler>& rulers, const PictureView& view, const RulerLook& look);
/// Of those that the slice cuts. A line is strong where it lies in the slice, within half a voxel, and faint where it
/// runs before or behind it; of spheres and boxes, what is drawn is the cut.
std::vector<Mark> rulerMarks(const std::vector<ShownRuler>& rulers, const Geometry& geometry, const SlicePlane& plane,
                             const RulerLook& look);

/// A point that can be dragged.
struct RulerHandle {
    int number = 0; ///< of the ruler
    /// Of distances and angles, which point; else 0 for the centre, 1 for the rim of a sphere, and 1 + 2a, 2 + 2a for
    /// the lower and the upper face of a box along the world's axis a.
    int part = 0;
    Vec3 world{0};
    PixelPoint at;
};
std::vector<RulerHandle> rulerHandles(const std::vector<Ruler>& rulers, const PictureView& view);
/// Of what lies in the slice.
std::vector<RulerHandle> rulerHandles(const std::vector<Ruler>& rulers, const Geometry& geometry,
                                      const SlicePlane& plane);

/// The ruler after its handle was brought to a place of the world. A box keeps its lower face below its upper one, and
/// what would be no measure any more (a radius of 0, a leg without length) stays as it is.
Ruler withHandleAt(const Ruler& ruler, const RulerHandle& handle, const Vec3& world);

/// Where a pixel lies in the plane through `world` that faces the viewer.
Vec3 besideInView(const PictureView& view, const Vec3& world, const PixelPoint& pixel);

} // namespace pellucid
