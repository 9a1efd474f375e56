// The slices of a picture: slabs of the volume's box, parallel to the image plane, and their outlines. No GL.
#pragma once

#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "render/render_settings.h"
#include "volume/volume.h"

namespace pellucid::gl {

/// One view of one volume. Depth is the distance along the view, world units, from the plane through `middle`; picture
/// coordinates are [−1,1]² over the whole image, y up.
struct SliceView {
    glm::dvec2 halfExtent; ///< perspective: tangents of the half angles; orthographic: world units
    bool perspective = true;
    double eyeDepth = 0; ///< depth of the eye (perspective)
    Vec3 middle;         ///< world; the middle of the clipped box
    Camera camera;

    SliceView(const Camera& camera, const Geometry& geometry, const RenderSettings& settings);

    double depthOf(const Vec3& world) const;
    glm::dvec2 pictureFromWorld(const Vec3& world) const; ///< the point must lie in front of the eye

    /// The ray of picture point (x, y): t(depth) = origin·(x,y,1) + depth·direction·(x,y,1), t in [0,1] over the box.
    glm::dmat3 rayOrigin(const Geometry& geometry) const;
    glm::dmat3 rayDirection(const Geometry& geometry) const;
};

/// A corner of a slab's outline, as slice.vert reads it.
struct SlabVertex {
    float x, y; ///< picture coordinates
    float nearDepth, farDepth;
};

/// Triangles of all slabs, front to back, so that samples along no ray of the picture lie farther apart than
/// settings.stepInD0. Every triangle list of one slab is the convex outline of slab ∩ clipped box.
/// Only the outlines within a part of the box, [partLo, partHi] in t of [0,1] over the box, for volumes drawn in
/// bricks; the slabs are the same. Throws Error where that takes more than a million slabs.
std::vector<SlabVertex> slabTriangles(const SliceView& view, const Geometry& geometry, const RenderSettings& settings,
                                      const Vec3& partLo = Vec3(0), const Vec3& partHi = Vec3(1));

} // namespace pellucid::gl
