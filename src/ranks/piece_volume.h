// A volume of which the ranks of another program hold pieces.
#pragma once

#include <memory>

#include "ranks/communicator.h"
#include "ranks/rank_volume.h"

namespace pellucid {

/// What a rank holds: samples of the voxels in `region`, x fastest. Pieces may overlap, and be empty.
struct VolumePiece {
    Geometry whole; ///< of all pieces
    SampleType type = SampleType::U8;
    VoxelRegion region;
    std::span<const std::byte> samples; ///< in the order of bytes of this machine
};

/// The volume as loadOnRanks() gives it: in blocks with `reach` voxels around them, or below `layout.smallest` voxels
/// as a whole on every rank. Where the volume lies in the world says the first rank that has voxels. Collective:
/// throws Error where pieces leave voxels out, differ in type or extents, or there are none.
std::shared_ptr<const Volume> volumeOfPieces(Communicator& ranks, const VolumePiece& piece, int reach,
                                             const RankLayout& layout = {});

/// The values of a field of this volume, in the shape of what is here of it, of the voxels of each rank's piece.
/// Collective.
std::vector<float> valuesOnPiece(Communicator& ranks, const Volume& volume, const Grid<float>& field,
                                 const VoxelRegion& piece);

} // namespace pellucid
