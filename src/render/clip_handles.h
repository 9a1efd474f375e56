// Handles in a picture: where things of the world appear, and what a hand that drags them means. Pure functions, so
// that they are tested without a window.
#pragma once

#include <optional>
#include <vector>

#include "render/clipping.h"

namespace pellucid {

/// A point of a picture, pixels from the top left corner.
struct PixelPoint {
    double x = 0, y = 0;
};

/// A camera with the picture that it is drawn in.
struct PictureView {
    Camera camera;
    int width = 1, height = 1; ///< pixels
};

/// Where a point of the world appears; empty beside and behind a perspective eye.
std::optional<PixelPoint> pixelOf(const PictureView& view, const Vec3& world);
/// World units that a pixel covers at the depth of `world`.
double worldPerPixel(const PictureView& view, const Vec3& world);

/// How far the point `at`, in units of `along`, has gone along that line when a hand took hold of it at `from` and now
/// is at `to`: as far as it takes to stay under the hand. A line that is seen nearly end-on moves with the hand up and
/// down, so that no small motion sends it far.
double draggedAlong(const PictureView& view, const Vec3& at, const Vec3& along, const PixelPoint& from,
                    const PixelPoint& to);

/// A unit direction in camera coordinates (right, up, toward the viewer), turned as if a ball of `radius` pixels had
/// been dragged at its front by (dx, dy) pixels, y down.
Vec3 turnedBall(const Vec3& direction, double dx, double dy, double radius);
Vec3 cameraFromWorld(const Camera& camera, const Vec3& direction); ///< right, up, toward the viewer
Vec3 worldFromCamera(const Camera& camera, const Vec3& direction); ///< the inverse

/// Corner n (bits 0, 1, 2: far along i, j, k) of the part of the box that is left, world.
Vec3 cornerOfPart(const Clipping& clipping, const Geometry& geometry, int n);
/// Centre of a face of that part, world.
Vec3 faceCenter(const Clipping& clipping, const Geometry& geometry, int axis, bool upper);
/// Where a face goes when its fraction rises by 1, world: all along the box.
Vec3 faceWay(const Geometry& geometry, int axis);

/// Where a plane cuts the whole box: a convex polygon in order, world; empty where it misses it.
std::vector<Vec3> planeInBox(const ClipPlane& plane, const Geometry& geometry);
/// The middle of that polygon; where the plane misses the box, the plane's point nearest to the box's centre.
Vec3 planeAnchor(const ClipPlane& plane, const Geometry& geometry);

/// The half-space through the centre of the box that cuts away what is nearer to the viewer.
ClipPlane planeFacing(const Camera& camera, const Geometry& geometry);
/// The plane as far along its normal as `offset` says, but so that it stays within the box.
ClipPlane planeAt(const ClipPlane& plane, double offset, const Geometry& geometry);
/// The plane through the same point `anchor` with another normal.
inline ClipPlane planeThrough(const Vec3& anchor, const Vec3& normal) {
    return {normal, normal.x * anchor.x + normal.y * anchor.y + normal.z * anchor.z};
}

inline constexpr double kThinnestPart = 1e-3; ///< of the box along an axis that clipping by hand leaves at least

/// The clipping after a face of its part has gone `by` along its axis, in fractions; `both`: and the opposite one with
/// it, so that the part keeps its thickness.
Clipping withFaceMoved(Clipping clipping, int axis, bool upper, double by, bool both);

} // namespace pellucid
