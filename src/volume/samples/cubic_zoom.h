// A coarse grid drawn out to a fine one.
#pragma once

#include "base/job.h"
#include "volume/grid.h"

namespace pellucid {

/// Catmull–Rom along each axis, so that the result is smooth. Voxel centres of both grids divide the same box evenly;
/// `periodic`: the box repeats, else values beyond are those at the edge.
Grid<float> cubicZoom(const Grid<float>& coarse, const Int3& dims, bool periodic, const JobControl& job);

} // namespace pellucid
