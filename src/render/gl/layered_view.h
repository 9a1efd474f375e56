// How the slices engine looks at a volume: which pictures of it are sliced, and how finely. No GL.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "render/view.h"
#include "render/visibility.h"

namespace pellucid::gl {

/// One picture, whose slices stand at right angles to its axis. Coordinates: `local` = (right, up, away from the eye)
/// in units of d0, 0 on the picture's axis as far off as the farthest kept corner. There a pixel is one d0 wide (high:
/// half of it), so that nowhere fewer than one pixel comes upon a voxel. Layer n, the optical depth in front of slice
/// n, lies at local z = front + n·step.
struct LayeredView {
    Mat3 localFromVoxel{1}, voxelFromLocal{1}; ///< of differences
    Vec3 origin{0, 0, 0};                      ///< of local coordinates, voxel coordinates
    double inverseDistance = 0;                ///< 1/(distance of the eye from the origin); 0: parallel rays

    glm::ivec2 size{0, 0};        ///< pixels
    glm::dvec2 firstPixel{0, 0};  ///< local (x, y) of the first pixel's centre at local z = 0
    glm::dvec2 pixelsPerD0{1, 1}; ///< at local z = 0
    double crossed = 0; ///< voxels sideways per voxel plane across the axis that a ray runs along, at most: [0, 2]
    double front = 0, step = 1; ///< local z of layer 0; distance of the layers
    int slabs = 0;              ///< between the layers 0 … slabs
    /// The pixels that may see something of a slab, first and one past the last.
    struct Rectangle {
        glm::ivec2 first{0, 0}, end{0, 0};
    };
    std::vector<Rectangle> rectangles; ///< one per slab

    /// Sides of the box and clip planes, voxel coordinates; distances in d0.
    std::vector<VoxelPlane> sides;
    std::vector<VoxelPlane> faint; ///< beyond these optical depths are thinned to `faintDensity` of their own
    double faintDensity = 0;
    /// For eyes close to the box: voxels are this picture's whose largest component of faceFromVoxel·voxel + faceOffset
    /// is `faceAxis`, of sign `faceSign`; −1: all are.
    int faceAxis = -1, faceSign = 1;
    Mat3 faceFromVoxel{1};
    Vec3 faceOffset{0, 0, 0};
};

/// One picture for orthographic cameras and for eyes from which the volume does not look wider than about 113°; else up
/// to six, the sides of a cube around the eye. None where nothing is kept. The direction of a perspective camera is of
/// no account: visibility is that of every voxel, in the picture or not. `mostPixels`: along an axis; where they do not
/// suffice, pixels are larger.
std::vector<LayeredView> makeLayeredViews(const View& view, const Geometry& geometry, Quality quality, int mostPixels);

} // namespace pellucid::gl
