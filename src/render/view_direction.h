// Views by the direction in which the eye lies.
#pragma once

#include <vector>

#include "render/camera_motion.h"

namespace pellucid {

/// Center, distance and magnification stay; the eye lies in the direction `towardEye` (a unit vector) of the center,
/// and the world's z is up, as cameraFromView() has it.
Camera lookingFrom(const Camera& camera, const Geometry& geometry, const Vec3& towardEye);

/// Azimuth and elevation of such a direction, at zoom 1; and the other way round.
ViewAngles anglesOf(const Vec3& towardEye);
Vec3 towardEye(const ViewAngles& angles);

/// `count` unit vectors, 1 to kMostSphereViews, evenly spread over the sphere: a Fibonacci lattice. They come in an
/// order from coarse to fine: the first n of them are spread over all of the sphere, for any n. Always the same.
std::vector<Vec3> spreadDirections(int count);
inline constexpr int kMostSphereViews = 4096;

} // namespace pellucid
