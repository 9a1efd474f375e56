// How much of the device each OpenGL engine may take: for tests. gl_engines.h is the way in for everybody else.
#pragma once

#include <limits>
#include <memory>

#include "render/visibility.h"

namespace pellucid::gl {

/// What makeGlEngine() may take of the device, whatever the volume's size. Results do not depend on it. Beyond the room
/// for the volume it is swept in bricks: as many planes as fit are uploaded at a time, and axes longer than a texture
/// may be are folded.
struct VisibilityBudget {
    double volumeBytes = std::numeric_limits<double>::infinity(); ///< intensities and weights
    double bufferBytes = 512.0 * 1024 * 1024;          ///< each of: light per ray and plane; visibility per voxel; sums
    int textureSize = std::numeric_limits<int>::max(); ///< voxels along an axis of a 3D texture; the device's if less
    double voxelsPerStep = 2e6;                        ///< swept between two looks at JobControl
};
std::unique_ptr<VisibilityEngine> makeGlEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                               const VisibilityBudget& budget);

/// What makeSlicesEngine() may take of the device besides the volume, which it needs whole. Results do not depend on
/// it.
struct SlicesBudget {
    double layerBytes = 512.0 * 1024 * 1024;  ///< of the slices' layers
    double bufferBytes = 512.0 * 1024 * 1024; ///< visibility per voxel, or sums of work groups
    int slabsPerStep = 32;                    ///< drawn between two looks at JobControl
};
std::unique_ptr<VisibilityEngine> makeSlicesEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                                   const SlicesBudget& budget);

} // namespace pellucid::gl
