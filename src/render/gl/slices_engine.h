// The thesis's own method on OpenGL with its memory bounds in sight; engines.h is the way in for everybody else.
#pragma once

#include <memory>

#include "render/visibility.h"

namespace pellucid::gl {

/// What the engine may take of the device besides the volume, which it needs whole. Results do not depend on it.
struct SlicesBudget {
    double layerBytes = 512.0 * 1024 * 1024;  ///< of the slices' layers
    double bufferBytes = 512.0 * 1024 * 1024; ///< visibility per voxel, or sums of work groups
    int slabsPerStep = 32;                    ///< drawn between two looks at JobControl
};

std::unique_ptr<VisibilityEngine> makeSlicesEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                                   const SlicesBudget& budget);

} // namespace pellucid::gl
