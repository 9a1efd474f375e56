// Blocks in which a transfer function shows about as much (docs/method.md, "Blocks of a volume").
#pragma once

#include "base/job.h"
#include "render/clipping.h"
#include "tf/transfer_function.h"
#include "volume/memory_use.h"
#include "volume/volume.h"

namespace pellucid {

/// What a sweep has to do in the cells of a coarse grid over the volume, about 4096 of them for each of `ranks`, 2^18
/// at most: 1 where the voxel that stands for a cell is kept and its opacity is not 0, kEmptyWork elsewhere. Collective
/// where the voxels are in several processes; throws Cancelled.
Grid<double> sweepWork(const Volume& volume, const TransferFunction& tf, const Clipping& clipping, int ranks,
                       const JobControl& job = {});

/// Of what a voxel takes that is drawn; a sweep alone takes 0.03 to 0.09 of it.
inline constexpr double kEmptyWork = 0.15;

/// Cuts anew the volumes of these extents that loadOnRanks() gives from now on, so that blocks have equal parts of
/// sweepWork(). False, and nothing happens: where that gains less than a sixth of what the slowest rank has to do,
/// where some rank has no memory for `then` with its new block, and where the volume has no blocks. Collective.
bool cutByWork(const Volume& volume, const TransferFunction& tf, const Clipping& clipping, const MemoryUse& then,
               const JobControl& job = {});

} // namespace pellucid
