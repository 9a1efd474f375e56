// How mouse and keys move the camera: pure functions, so that they are tested without a window.
#pragma once

#include "render/camera.h"

namespace pellucid {

/// Full vertical angle of a perspective view that has not been narrowed to look closer, degrees.
inline constexpr double kNormalFovY = 30.0;

/// Where a volume is seen from when it opens.
Camera homeCamera(const Geometry& geometry, Projection projection);

/// The whole box from a direction given in degrees, see cameraFromView().
Camera standardCamera(const Geometry& geometry, double azimuth, double elevation, Projection projection);

/// Turns the eye around camera.center: by `yaw` about the camera's up, by `pitch` about its right axis, degrees.
/// Positive yaw moves the eye to the right, positive pitch upward.
Camera rotated(const Camera& camera, const Geometry& geometry, double yaw, double pitch);

/// Shifts eye and center in the image plane, so that what lies in the plane of the center follows the mouse.
/// dx, dy in pixels, y down; `viewHeight` in pixels.
Camera panned(const Camera& camera, const Geometry& geometry, double dx, double dy, int viewHeight);

/// Magnifies by `factor` > 0. A perspective eye comes closer until it reaches the sphere around the box, then the angle
/// narrows, since the eye must stay outside the box (docs/method.md, "Visibility").
Camera zoomed(const Camera& camera, const Geometry& geometry, double factor);

/// The same direction, with the whole box in the image.
Camera fitted(const Camera& camera, const Geometry& geometry);

/// The other projection with the same size of what lies in the plane of the center.
Camera withProjection(const Camera& camera, const Geometry& geometry, Projection projection);

/// Azimuth, elevation in degrees, and magnification as in cameraFromView(): 1 fits the sphere around the box.
struct ViewAngles {
    double azimuth = 0, elevation = 0, zoom = 1;
};
ViewAngles viewAngles(const Camera& camera, const Geometry& geometry);

} // namespace pellucid
