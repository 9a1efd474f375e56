// The OpenGL visibility engine with its memory bounds in sight; engines.h is the way in for everybody else.
#pragma once

#include <memory>

#include "render/visibility.h"

namespace pellucid::gl {

/// What one chunk of voxel planes may take on the device, whatever the volume's size; a plane at a time is always
/// possible. Results do not depend on it.
struct VisibilityBudget {
    double depthTextureBytes = 256.0 * 1024 * 1024; ///< optical depth per ray and layer
    double visibilityBytes = 64.0 * 1024 * 1024;    ///< per voxel and transfer function
};

std::unique_ptr<VisibilityEngine> makeGlEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                               const VisibilityBudget& budget);

} // namespace pellucid::gl
