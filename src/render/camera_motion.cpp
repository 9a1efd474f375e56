#include "render/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace pellucid {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kSmallestFovY = 0.5; // degrees: 60 times closer than normal
constexpr double kFarthest = 200.0;   // bounding radii
constexpr double kMostZoom = 100.0, kLeastZoom = 0.02;

double halfTangent(double fovY) { return std::tan(0.5 * fovY * kRadians); }
double fovFromHalfTangent(double t) { return 2.0 * std::atan(t) / kRadians; }
double distance(const Camera& c) { return glm::length(c.eye - c.center); }

// Full height of the image in the plane of the center, world units.
double heightAtCenter(const Camera& c) {
    return c.projection == Projection::Orthographic ? c.height : 2.0 * distance(c) * halfTangent(c.fovY);
}

// Brings the eye out of the sphere around the box, along its own line of sight. A perspective view narrows so that the
// size of things at the center stays; an orthographic picture does not change at all.
Camera keptOutside(Camera c, const Geometry& geometry) {
    const double radius = 1.02 * geometry.radius();
    const Vec3 fromBox = c.eye - geometry.boxCenter();
    if (glm::length(fromBox) >= radius) return c;
    const Vec3 back = -c.forward();
    const double along = glm::dot(fromBox, back);
    const double out = -along + std::sqrt(std::max(0.0, along * along - glm::dot(fromBox, fromBox) + radius * radius));
    const double before = distance(c);
    c.eye += out * back;
    if (c.projection == Projection::Perspective)
        c.fovY = std::max(kSmallestFovY, fovFromHalfTangent(halfTangent(c.fovY) * before / distance(c)));
    return c;
}

// How far the box's corners reach from the image's middle, in halves of its height: 1 touches its upper or lower edge.
double reachOfBox(const Camera& c, const Geometry& geometry) {
    double reach = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 fromEye = geometry.corner(corner) - c.eye;
        const double unit = c.projection == Projection::Orthographic
                                ? 0.5 * c.height
                                : std::max(1e-12, glm::dot(fromEye, c.forward())) * halfTangent(c.fovY);
        reach = std::max(
            {reach, std::abs(glm::dot(fromEye, c.right())) / unit, std::abs(glm::dot(fromEye, c.trueUp())) / unit});
    }
    return reach;
}

// From a view that fits the sphere around the box to one that fits the box itself, with a little room. The image is at
// least as wide as high, so that what fits a square fits it.
Camera closerToBox(const Camera& sphereFit, const Geometry& geometry) {
    constexpr double kReach = 0.94;
    const auto at = [&](double zoom) {
        Camera c = sphereFit;
        if (c.projection == Projection::Orthographic) {
            c.height /= zoom;
        } else {
            c.eye = c.center + (c.eye - c.center) / zoom;
        }
        return c;
    };
    double low = 0.5, high = 2.5;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        (reachOfBox(at(middle), geometry) > kReach ? high : low) = middle;
    }
    return keptOutside(at(low), geometry);
}

double fittingHeight(const Geometry& geometry) {
    const Camera fit = cameraFromView(geometry, 0, 0, 1, Projection::Perspective);
    return heightAtCenter(fit);
}

} // namespace

Camera homeCamera(const Geometry& geometry, Projection projection) {
    return standardCamera(geometry, 30, 20, projection);
}

Camera standardCamera(const Geometry& geometry, double azimuth, double elevation, Projection projection) {
    return closerToBox(cameraFromView(geometry, azimuth, elevation, 1, projection), geometry);
}

Camera rotated(const Camera& camera, const Geometry& geometry, double yaw, double pitch) {
    const glm::dquat turn =
        glm::angleAxis(yaw * kRadians, camera.trueUp()) * glm::angleAxis(-pitch * kRadians, camera.right());
    Camera c = camera;
    c.eye = camera.center + turn * (camera.eye - camera.center);
    c.up = glm::normalize(turn * camera.trueUp());
    return keptOutside(c, geometry);
}

Camera panned(const Camera& camera, const Geometry& geometry, double dx, double dy, int viewHeight) {
    const double perPixel = heightAtCenter(camera) / std::max(1, viewHeight);
    Vec3 shift = perPixel * (-dx * camera.right() + dy * camera.trueUp());
    // The volume must not get lost: the center stays within the sphere around the box.
    const double radius = geometry.radius();
    Vec3 offset = camera.center + shift - geometry.boxCenter();
    if (glm::length(offset) > radius) offset *= radius / glm::length(offset);
    shift = geometry.boxCenter() + offset - camera.center;
    Camera c = camera;
    c.eye += shift;
    c.center += shift;
    return keptOutside(c, geometry);
}

Camera zoomed(const Camera& camera, const Geometry& geometry, double factor) {
    const double zoom = fittingHeight(geometry) / heightAtCenter(camera);
    factor = std::clamp(zoom * factor, kLeastZoom, kMostZoom) / zoom;
    Camera c = camera;
    if (c.projection == Projection::Orthographic) {
        c.height /= factor;
        return c;
    }
    // Going back undoes the narrowing first, so that in and out end where they began.
    if (factor < 1 && c.fovY < kNormalFovY) {
        const double wanted = halfTangent(c.fovY) / factor;
        const double reached = std::min(wanted, halfTangent(kNormalFovY));
        c.fovY = fovFromHalfTangent(reached);
        factor = reached / wanted;
    }
    c.eye = c.center + (c.eye - c.center) / factor;
    const double farthest = kFarthest * geometry.radius();
    if (distance(c) > farthest) c.eye = c.center - farthest * c.forward();
    return keptOutside(c, geometry);
}

Camera fitted(const Camera& camera, const Geometry& geometry) {
    const Camera fit = cameraFromView(geometry, 0, 0, 1, camera.projection);
    Camera c = fit;
    c.center = geometry.boxCenter();
    c.eye = c.center - glm::length(fit.eye - fit.center) * camera.forward();
    c.up = camera.trueUp();
    return closerToBox(c, geometry);
}

Camera withProjection(const Camera& camera, const Geometry& geometry, Projection projection) {
    if (camera.projection == projection) return camera;
    Camera c = camera;
    c.projection = projection;
    if (projection == Projection::Orthographic) {
        c.height = heightAtCenter(camera);
        return c;
    }
    c.fovY = kNormalFovY;
    c.eye = c.center - 0.5 * camera.height / halfTangent(kNormalFovY) * camera.forward();
    return keptOutside(c, geometry);
}

ViewAngles viewAngles(const Camera& camera, const Geometry& geometry) {
    const Vec3 toEye = -camera.forward();
    ViewAngles angles;
    angles.elevation = std::asin(std::clamp(toEye.z, -1.0, 1.0)) / kRadians;
    // Looking along z the azimuth is that of the picture's up direction.
    const Vec3 level = std::abs(toEye.z) < 1.0 - 1e-9 ? toEye : (toEye.z > 0 ? -1.0 : 1.0) * camera.trueUp();
    angles.azimuth = std::atan2(level.x, -level.y) / kRadians;
    angles.zoom = fittingHeight(geometry) / heightAtCenter(camera);
    return angles;
}

} // namespace pellucid
