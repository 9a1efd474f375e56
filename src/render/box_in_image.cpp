#include "render/box_in_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace pellucid {

BoxInImage boxInImage(const Camera& camera, const Geometry& geometry, int width, int height) {
    const Vec3 forward = camera.forward(), right = camera.right(), up = camera.trueUp();
    const double halfTangent = std::tan(camera.fovY * std::numbers::pi / 360.0);
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    double left = kInfinite, top = kInfinite, far = -kInfinite, rightmost = -kInfinite, bottom = -kInfinite;
    double near = kInfinite;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 fromEye = geometry.corner(corner) - camera.eye;
        const double depth = glm::dot(fromEye, forward);
        near = std::min(near, depth);
        far = std::max(far, depth);
        double unit = 0.5 * camera.height; // world units of half the image's height, at this depth
        if (camera.projection == Projection::Perspective) {
            // Corners beside or behind the eye have no place in the image: the box may cover all of it.
            if (depth <= 1e-9 * glm::length(fromEye)) {
                left = top = -kInfinite;
                rightmost = bottom = kInfinite;
                continue;
            }
            unit = depth * halfTangent;
        }
        const double x = 0.5 * width + 0.5 * height * glm::dot(fromEye, right) / unit;
        const double y = 0.5 * height - 0.5 * height * glm::dot(fromEye, up) / unit;
        left = std::min(left, x);
        rightmost = std::max(rightmost, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
    }
    // One pixel of margin, since pixels are hit at their centres.
    const auto pixel = [](double v, int limit) { return static_cast<int>(std::clamp<double>(v, 0, limit)); };
    BoxInImage box;
    box.x = pixel(std::floor(left) - 1, width);
    box.y = pixel(std::floor(top) - 1, height);
    box.width = pixel(std::ceil(rightmost) + 1, width) - box.x;
    box.height = pixel(std::ceil(bottom) + 1, height) - box.y;
    if (box.width <= 0 || box.height <= 0) box.width = box.height = 0;
    box.depthInD0 = (far - std::max(near, 0.0)) / geometry.d0();
    return box;
}

} // namespace pellucid
