#include "render/clip_handles.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace pellucid {

namespace {

/// Sine of the angle between a line and the way that one looks at it, below which it is seen end-on.
constexpr double kEndOn = 0.15;

double halfHeightAt(const Camera& camera, double depth) {
    return camera.projection == Projection::Perspective ? depth * camera.halfHeight() : camera.halfHeight();
}

/// The parameter on the line at + s·along nearest to the ray through a pixel.
double nearestOnLine(const PictureView& view, const Vec3& at, const Vec3& along, const PixelPoint& pixel) {
    const Ray ray = pixelRay(view.camera, pixel.x, pixel.y, view.width, view.height);
    // At the nearest points the way from one line to the other is perpendicular to both.
    const Vec3 between = ray.origin - at;
    const double a = glm::dot(along, along), b = glm::dot(along, ray.direction);
    const double denominator = a - b * b;
    return (glm::dot(along, between) - b * glm::dot(ray.direction, between)) / denominator;
}

Vec3 middleOf(const std::vector<Vec3>& points) {
    Vec3 middle(0);
    for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
    return middle;
}

} // namespace

std::optional<PixelPoint> pixelOf(const PictureView& view, const Vec3& world) {
    const Camera& camera = view.camera;
    const Vec3 fromEye = world - camera.eye;
    const double depth = glm::dot(fromEye, camera.forward());
    if (camera.projection == Projection::Perspective && depth <= 1e-9 * glm::length(fromEye)) return {};
    const double scale = 0.5 * view.height / halfHeightAt(camera, depth);
    return PixelPoint{0.5 * view.width + scale * glm::dot(fromEye, camera.right()),
                      0.5 * view.height - scale * glm::dot(fromEye, camera.trueUp())};
}

double worldPerPixel(const PictureView& view, const Vec3& world) {
    const double depth = glm::dot(world - view.camera.eye, view.camera.forward());
    return 2 * std::abs(halfHeightAt(view.camera, depth)) / view.height;
}

double draggedAlong(const PictureView& view, const Vec3& at, const Vec3& along, const PixelPoint& from,
                    const PixelPoint& to) {
    const double length = glm::length(along);
    const Vec3 look = -view.camera.towardEye(at);
    const double sine = glm::length(glm::cross(along / length, look));
    if (sine >= kEndOn) return nearestOnLine(view, at, along, to) - nearestOnLine(view, at, along, from);
    // Up is away from the viewer.
    const double up = (from.y - to.y) * worldPerPixel(view, at) / length;
    return glm::dot(along, look) >= 0 ? up : -up;
}

Vec3 turnedBall(const Vec3& direction, double dx, double dy, double radius) {
    const double way = std::hypot(dx, dy);
    const Vec3 unit = glm::normalize(direction);
    if (way == 0 || !(radius > 0)) return unit;
    // The front of the ball, (0,0,1), goes toward (dx, −dy, 0): about the axis perpendicular to both (Rodrigues).
    const Vec3 axis{dy / way, dx / way, 0};
    const double angle = way / radius, cosine = std::cos(angle);
    return glm::normalize(unit * cosine + glm::cross(axis, unit) * std::sin(angle) +
                          axis * glm::dot(axis, unit) * (1 - cosine));
}

Vec3 cameraFromWorld(const Camera& camera, const Vec3& direction) {
    return {glm::dot(direction, camera.right()), glm::dot(direction, camera.trueUp()),
            -glm::dot(direction, camera.forward())};
}

Vec3 worldFromCamera(const Camera& camera, const Vec3& direction) {
    return direction.x * camera.right() + direction.y * camera.trueUp() - direction.z * camera.forward();
}

Vec3 cornerOfPart(const Clipping& clipping, const Geometry& geometry, int n) {
    Vec3 fraction;
    for (int a = 0; a < 3; ++a) fraction[a] = (n >> a & 1) != 0 ? clipping.hi[a] : clipping.lo[a];
    return geometry.worldFromVoxel(fraction * Vec3(geometry.dims) - 0.5);
}

Vec3 faceCenter(const Clipping& clipping, const Geometry& geometry, int axis, bool upper) {
    Vec3 fraction = 0.5 * (clipping.lo + clipping.hi);
    fraction[axis] = upper ? clipping.hi[axis] : clipping.lo[axis];
    return geometry.worldFromVoxel(fraction * Vec3(geometry.dims) - 0.5);
}

Vec3 faceWay(const Geometry& geometry, int axis) {
    return geometry.directions[axis] * (geometry.spacing[axis] * geometry.dims[axis]);
}

std::vector<Vec3> planeInBox(const ClipPlane& plane, const Geometry& geometry) {
    std::vector<Vec3> points;
    for (int axis = 0; axis < 3; ++axis)
        for (int n = 0; n < 8; ++n) {
            if ((n >> axis & 1) != 0) continue;
            const Vec3 a = geometry.corner(n), b = geometry.corner(n | 1 << axis);
            const double beyondA = glm::dot(plane.normal, a) - plane.offset;
            const double beyondB = glm::dot(plane.normal, b) - plane.offset;
            if ((beyondA > 0) == (beyondB > 0)) continue;
            points.push_back(a + (b - a) * (beyondA / (beyondA - beyondB)));
        }
    if (points.size() < 3) return {};
    const Vec3 middle = middleOf(points);
    // Two directions in the plane, by which angle the corners come.
    const Vec3 normal = glm::normalize(plane.normal);
    const Vec3 other = std::abs(normal.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 u = glm::normalize(glm::cross(normal, other)), v = glm::cross(normal, u);
    const auto angle = [&](const Vec3& p) { return std::atan2(glm::dot(p - middle, v), glm::dot(p - middle, u)); };
    std::ranges::sort(points, {}, angle);
    return points;
}

Vec3 planeAnchor(const ClipPlane& plane, const Geometry& geometry) {
    const std::vector<Vec3> polygon = planeInBox(plane, geometry);
    if (polygon.empty()) {
        const Vec3 center = geometry.boxCenter();
        const double beyond = glm::dot(plane.normal, center) - plane.offset;
        return center - plane.normal * (beyond / glm::dot(plane.normal, plane.normal));
    }
    return middleOf(polygon);
}

ClipPlane planeFacing(const Camera& camera, const Geometry& geometry) {
    return planeThrough(geometry.boxCenter(), -camera.forward());
}

ClipPlane planeAt(const ClipPlane& plane, double offset, const Geometry& geometry) {
    double lo = glm::dot(plane.normal, geometry.corner(0)), hi = lo;
    for (int n = 1; n < 8; ++n) {
        const double at = glm::dot(plane.normal, geometry.corner(n));
        lo = std::min(lo, at);
        hi = std::max(hi, at);
    }
    return {plane.normal, std::clamp(offset, lo + kThinnestPart * (hi - lo), hi)};
}

Clipping withFaceMoved(Clipping clipping, int axis, bool upper, double by, bool both) {
    double &lo = clipping.lo[axis], &hi = clipping.hi[axis];
    if (both) {
        by = std::clamp(by, -lo, 1 - hi);
        lo = std::clamp(lo + by, 0.0, 1.0);
        hi = std::clamp(hi + by, 0.0, 1.0);
    } else if (upper) {
        hi = std::clamp(hi + by, std::min(1.0, lo + kThinnestPart), 1.0);
    } else {
        lo = std::clamp(lo + by, 0.0, std::max(0.0, hi - kThinnestPart));
    }
    return clipping;
}

} // namespace pellucid
