#include "render/gl/picture_rays.h"

#include <glm/geometric.hpp>

namespace pellucid::gl {

PictureRays::PictureRays(const Camera& camera, const Geometry& geometry, double aspect) {
    const bool perspective = camera.projection == Projection::Perspective;
    const glm::dvec2 extent(camera.halfHeight() * aspect, camera.halfHeight());
    const double ahead = glm::dot(geometry.boxCenter() - camera.eye, camera.forward());
    const Mat3 indexFromWorld = geometry.indexFromWorld();
    const Vec3 right = indexFromWorld * camera.right() * extent.x, up = indexFromWorld * camera.trueUp() * extent.y;
    const Vec3 axis = geometry.voxelFromWorld(camera.eye + ahead * camera.forward());
    const Vec3 forward = indexFromWorld * camera.forward();
    if (perspective) {
        origin = {right * ahead, up * ahead, axis};
        direction = {right, up, forward};
        tangents = extent;
        nearest = -ahead;
    } else {
        origin = {right, up, axis};
        direction = {Vec3(0), Vec3(0), forward};
        tangents = {0, 0};
        nearest = -1e30;
    }
}

} // namespace pellucid::gl
