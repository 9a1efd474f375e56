// A height field as ground under the volume (thesis figs 6.1–6.5).
#pragma once

#include <string>
#include <vector>

#include "base/job.h"
#include "render/camera.h"
#include "volume/grid.h"
#include "volume/volume.h"

namespace pellucid {

/// Heights over a rectangle that lies in the plane of the volume's axes i and j; they rise along k. Immutable once
/// shared.
struct Ground {
    int nx = 0, ny = 0;         ///< ≥ 2 each
    std::vector<float> heights; ///< x fastest, data units; NaN: no ground there
    Vec3 origin{0, 0, 0};       ///< world, of sample (0,0) at height 0
    Vec3 stepX{1, 0, 0};        ///< world, from sample to sample
    Vec3 stepY{0, 1, 0};
    Vec3 up{0, 0, 1}; ///< world units per unit of height
    std::string colorMap = "terrain";
    double lo = 0, hi = 1; ///< heights of the colour map's ends
    double relief = 1;     ///< strength of the shading, [0, 1]
};

} // namespace pellucid
