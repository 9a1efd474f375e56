#include "render/view_direction.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "base/error.h"

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

std::vector<Vec3> spreadDirections(int count) {
    if (count < 1 || count > kMostSphereViews)
        throw UsageError("the number of views is not from 1 to " + std::to_string(kMostSphereViews), "views",
                         "correct it");
    const auto n = static_cast<std::size_t>(count);
    std::vector<Vec3> lattice(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(n);
        const double turn = 2 * std::numbers::pi * std::fmod(static_cast<double>(i) / std::numbers::phi, 1.0);
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        lattice[i] = {r * std::cos(turn), r * std::sin(turn), z};
    }
    // Each next one is the one farthest from all before it.
    std::vector<Vec3> ordered;
    std::vector<double> nearest(n, -2); // cosine of the angle to the nearest one taken
    std::size_t next = 0;
    for (std::size_t taken = 0; taken < n; ++taken) {
        ordered.push_back(lattice[next]);
        nearest[next] = 2;
        std::size_t farthest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            nearest[i] = std::max(nearest[i], glm::dot(lattice[i], ordered.back()));
            if (nearest[i] < nearest[farthest]) farthest = i;
        }
        next = farthest;
    }
    return ordered;
}

} // namespace pellucid
