#include "render/box_in_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace pellucid {

BoxInImage boxInImage(const Camera& camera, const Geometry& geometry, int width, int height) {
    const Vec3 forward = camera.forward(), right = camera.right(), up = camera.trueUp();
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    double near = kInfinite, far = -kInfinite;
    glm::dvec2 first(kInfinite), last(-kInfinite); // pixels
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 fromEye = geometry.corner(corner) - camera.eye;
        const double depth = glm::dot(fromEye, forward);
        near = std::min(near, depth);
        far = std::max(far, depth);
        double unit = camera.halfHeight(); // world units of half the image's height, at this depth
        if (camera.projection == Projection::Perspective) {
            // Corners beside or behind the eye have no place in the image: the box may cover all of it.
            if (depth <= 1e-9 * glm::length(fromEye)) {
                first = glm::dvec2(-kInfinite);
                last = glm::dvec2(kInfinite);
                continue;
            }
            unit *= depth;
        }
        const glm::dvec2 pixel(0.5 * width + 0.5 * height * glm::dot(fromEye, right) / unit,
                               0.5 * height - 0.5 * height * glm::dot(fromEye, up) / unit);
        first = glm::min(first, pixel);
        last = glm::max(last, pixel);
    }
    // One pixel of margin, since pixels are hit at their centres.
    const auto pixel = [](double v, int limit) { return static_cast<int>(std::clamp<double>(v, 0, limit)); };
    BoxInImage box;
    box.x = pixel(std::floor(first.x) - 1, width);
    box.y = pixel(std::floor(first.y) - 1, height);
    box.width = pixel(std::ceil(last.x) + 1, width) - box.x;
    box.height = pixel(std::ceil(last.y) + 1, height) - box.y;
    if (box.width <= 0 || box.height <= 0) box.width = box.height = 0;
    box.depthInD0 = (far - std::max(near, 0.0)) / geometry.d0();
    return box;
}

} // namespace pellucid
