// Voxels from the pieces in which another program holds a volume to the blocks of ranks, and back.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ranks/communicator.h"
#include "volume/volume.h"

namespace pellucid {

/// Each rank has the values of the voxels in `from`, with x fastest, and gets those of the voxels in `to`. Regions may
/// be empty, and those of ranks may overlap; where they do, `from` has equal values. Collective. Throws Error on a rank
/// of whose voxels nobody has some.
///   values    `bytesEach` for each voxel of `from`
///   returned  likewise for `to`
std::vector<std::byte> exchangeVoxels(Communicator& ranks, const VoxelRegion& from, std::span<const std::byte> values,
                                      const VoxelRegion& to, std::size_t bytesEach);

} // namespace pellucid
