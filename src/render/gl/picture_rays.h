// The rays of a picture's pixels in voxel coordinates, as shaders/include/picture_ray.glsl takes them. No GL.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "render/camera.h"

namespace pellucid::gl {

/// The ray of picture point (x, y), [−1,1]² over the whole image, y up: voxel(t) = origin·(x,y,1) +
/// t·direction·(x,y,1), t the depth along the view in world units, 0 in the plane through the middle of the box: so
/// that single precision does wherever the eye is.
struct PictureRays {
    glm::dmat3 origin, direction;
    glm::dvec2 tangents; ///< perspective: of the half angles; orthographic: 0
    double nearest;      ///< t of the eye; orthographic: far in front of the box

    /// `aspect`: width / height of the picture.
    PictureRays(const Camera& camera, const Geometry& geometry, double aspect);
};

} // namespace pellucid::gl
