#include "render/view_direction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace pellucid {

namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

} // namespace

Camera lookingFrom(const Camera& camera, const Geometry& geometry, const Vec3& towardEye) {
    Camera c = camera;
    c.eye = c.center + glm::length(camera.eye - camera.center) * towardEye;
    const double level = std::hypot(towardEye.x, towardEye.y);
    // Along z, where every side is up, as seen from azimuth 0.
    const Vec3 outward = level > 1e-9 ? Vec3(towardEye.x, towardEye.y, 0) / level : Vec3(0, -1, 0);
    c.up = {-towardEye.z * outward.x, -towardEye.z * outward.y, level};
    return rotated(c, geometry, 0, 0); // which keeps the eye outside the box
}

ViewAngles anglesOf(const Vec3& towardEye) {
    return {std::atan2(towardEye.x, -towardEye.y) / kRadians, std::asin(std::clamp(towardEye.z, -1.0, 1.0)) / kRadians,
            1};
}

Vec3 towardEye(const ViewAngles& angles) {
    const double az = angles.azimuth * kRadians, el = angles.elevation * kRadians;
    return {std::sin(az) * std::cos(el), -std::cos(az) * std::cos(el), std::sin(el)};
}

} // namespace pellucid
