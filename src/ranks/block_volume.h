// What a rank has of a volume: one block, and the voxels around it that rays and saliency look at.
#pragma once

#include <memory>

#include "ranks/decomposition.h"
#include "render/cpu/sweep.h"
#include "volume/volume.h"

namespace pellucid {

struct BlockVolume {
    Geometry whole; ///< of the volume; its reference length is that of all blocks
    Decomposition blocks{{1, 1, 1}, 1};
    int own = 0;        ///< the block of this rank
    VoxelRegion region; ///< of the voxels that are stored: the block and its ghost layers; empty where it is
    std::shared_ptr<const Volume> stored; ///< these, in the window of the whole; null where there are none

    const VoxelRegion& block() const { return blocks.blocks()[static_cast<std::size_t>(own)]; }
    bool isEmpty() const { return stored == nullptr; }
};

/// Voxels around a block that rays look at, along each axis.
inline constexpr int kRayGhosts = static_cast<int>(kRayMargin);
static_assert(kRayGhosts == kRayMargin);

/// The block of a volume that is all there: what tests compare with. `ghosts` ≥ kRayGhosts.
BlockVolume blockOf(const std::shared_ptr<const Volume>& whole, const Decomposition& blocks, int own,
                    const Int3& ghosts);

} // namespace pellucid
