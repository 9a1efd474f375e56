// How the volume is swept to measure visibility: along which of its axes and with which rays. No GL.
#pragma once

#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "render/view.h"
#include "render/visibility.h"

namespace pellucid::gl {

/// One sweep: the voxel planes across an axis of the volume, front to back, and straight rays through all of them.
/// Planes follow the volume's axes, not the view: rays can then stand exactly on the voxel columns of the farthest
/// plane, so that a view along an axis is computed without any interpolation, and no voxel is ever seen at a flat
/// angle. Angles are those of the grid of voxels, so that a ray crosses about one voxel per plane however unequal the
/// spacing is and however the grid lies in the world: of that only the lengths of paths speak.
///
/// Coordinates q = (a, b, c) are voxel coordinates with the sweep's axis last and c growing away from the eye.
struct Sweep {
    int axis = 2; ///< of the volume
    int sign = 1; ///< +1: c grows along the axis; −1: against it
    /// Only the voxels whose direction from the eye lies nearest this axis and sign belong to the sweep; else all.
    bool pyramid = false;

    Int3 dims{0, 0, 0};                 ///< of a, b, c
    Int3 first{0, 0, 0}, last{0, 0, 0}; ///< what is not cut away lies between these voxels, both included
    std::vector<VoxelPlane> planes;     ///< what is kept, in q; none where nothing is clipped
    std::vector<VoxelPlane> faint;      ///< beyond these, in q, optical depths are thinned …
    double faintDensity = 0;            ///< … to this part of their own
    Mat3 worldFromQ{1};                 ///< of differences, in units of d0: |worldFromQ·Δq| is the length of a path
    bool perspective = true;
    Vec3 eye{0, 0, 0};      ///< in q (perspective)
    glm::dvec2 shear{0, 0}; ///< change of (a, b) per unit of c (orthographic)

    double reference = 0;    ///< c of the plane whose points (a, b) name the rays: the farthest kept voxel centres
    glm::dvec2 grid{0, 0};   ///< (a, b) of the first ray
    double raysPerVoxel = 1; ///< along a and b, on the reference plane
    glm::ivec2 rays{0, 0};   ///< number along a, b

    double front = -0.5; ///< c where the box begins, or the eye's where it lies beside the box
    int firstPlane = 0;  ///< first c that has voxels of this sweep; the last one is last.z
    int pieces = 1;      ///< samples per unit of c, one of them on each voxel plane
    /// Planes in front of a voxel that are followed along its own line before rays tell the light there: at least, and
    /// at most, where T differs by more than `tolerance` between the rays.
    glm::ivec2 ownPlanes{1, 1};
    double tolerance = 0;

    /// Voxel coordinates (i, j, k) = matrix·q + offset.
    glm::dmat3 voxelFromQ() const;
    Vec3 voxelOffset() const;
    /// Index of voxel q in the volume = base + a·stride.x + b·stride.y + c·stride.z.
    struct Strides {
        std::ptrdiff_t base = 0, a = 0, b = 0, c = 0;
    };
    Strides strides() const;
};

/// One sweep for orthographic cameras and for eyes far enough away; else up to six, a pyramid of directions each, so
/// that an eye close to the box sees every voxel at a moderate angle; none where no voxel is kept. `quality` sets the
/// density of samples and rays.
std::vector<Sweep> makeSweeps(const View& view, const Geometry& geometry, Quality quality);

} // namespace pellucid::gl
