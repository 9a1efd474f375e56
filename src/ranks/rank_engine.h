// Visibility of a volume whose blocks lie on many ranks (docs/method.md, "Blocks of a volume").
#pragma once

#include <memory>

#include "ranks/block_volume.h"
#include "ranks/communicator.h"
#include "render/visibility.h"

namespace pellucid {

/// The engine of a volume with blocks on ranks (RankVoxels), or of one that is on every rank of a group as a whole:
/// then each does a part of the work. Throws Error for blocks in quality high, which follows lines through all blocks.
std::unique_ptr<VisibilityEngine> makeEngineOnRanks(Communicator& ranks, std::shared_ptr<const Volume> volume,
                                                    Quality quality);

/// The engine of a rank. All its calls are collective, with equal arguments, and give the same sums on all ranks: the
/// same bits for the same blocks, whatever the number of threads. Weights and fields have the shape of what is stored;
/// of a field the block itself is right, the ghosts around it are 0. `ranks` outlives it.
std::unique_ptr<VisibilityEngine> makeRankEngine(Communicator& ranks, BlockVolume block);

} // namespace pellucid
