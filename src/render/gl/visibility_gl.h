// The OpenGL visibility engine with its memory bounds in sight; engines.h is the way in for everybody else.
#pragma once

#include <limits>
#include <memory>

#include "render/visibility.h"

namespace pellucid::gl {

/// What the engine may take of the device, whatever the volume's size. Results do not depend on it. Beyond the room for
/// the volume it is swept in bricks: as many planes as fit are uploaded at a time, and axes longer than a texture may
/// be are folded.
struct VisibilityBudget {
    double volumeBytes = std::numeric_limits<double>::infinity(); ///< intensities and weights
    double bufferBytes = 512.0 * 1024 * 1024;          ///< each of: light per ray and plane; visibility per voxel; sums
    int textureSize = std::numeric_limits<int>::max(); ///< voxels along an axis of a 3D texture; the device's if less
    double voxelsPerStep = 2e6;                        ///< swept between two looks at JobControl
};

std::unique_ptr<VisibilityEngine> makeGlEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                               const VisibilityBudget& budget);

} // namespace pellucid::gl
