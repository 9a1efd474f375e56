// Volumes whose blocks lie on the ranks of a group.
#pragma once

#include <memory>
#include <optional>

#include "ranks/block_volume.h"
#include "ranks/communicator.h"
#include "volume/loader.h"

namespace pellucid {

/// From what size on there are blocks, and how they are cut.
struct RankLayout {
    /// Volumes of fewer voxels are on every rank as a whole: blocks of them would be mostly what lies around them, and
    /// they are measured more carefully, along lines that cross all of them.
    std::size_t smallest = 128 * 128 * 128;
    /// Of volumes with these extents, see cutByWork(); others, and all while it is empty, in equal blocks.
    std::optional<Decomposition> cut = {};
    /// Bytes that a frame may take which each rank has as a whole (divideFrames()), with what is done with it and three
    /// more that are there meanwhile; the same on all ranks.
    std::uint64_t roomForFrame = 0;

    Decomposition blocksOf(const Int3& dims, int ranks) const;
    /// Whether each rank has all of a volume.
    bool isWhole(const Int3& dims, SampleType type, const MemoryUse& then, int ranks) const;
};

/// The block that a rank has of a volume.
class RankVoxels final : public VoxelsElsewhere {
public:
    /// `layout`: by which the blocks of later volumes are cut, which outlives this; null: none is made later.
    RankVoxels(Communicator& ranks, BlockVolume block, RankLayout* layout)
        : m_ranks(ranks), m_block(std::move(block)), m_layout(layout) {}
    VoxelRegion own() const override { return m_block.block(); }
    VoxelRegion stored() const override { return m_block.region; }
    std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) const override {
        return m_ranks.gather(bytes);
    }
    void sum(std::span<double> values) const override { m_ranks.sum(values); }

    Communicator& ranks() const { return m_ranks; }
    const Decomposition& blocks() const { return m_block.blocks; }
    RankLayout* layout() const { return m_layout; }
    /// With the voxels of `volume`, which this belongs to, in its window.
    BlockVolume blockOf(const Volume& volume) const;

private:
    Communicator& m_ranks;
    BlockVolume m_block; ///< without voxels
    RankLayout* m_layout;
};

/// The volume of a block on each rank, as loadVolume() gives it. Collective.
Volume volumeOfBlocks(Communicator& ranks, BlockVolume block, const Volume& like, RankLayout* layout = nullptr);

/// Each rank reads its block and the voxels around it that rays (kRayGhosts) and what is done next (MemoryUse::reach)
/// look at, and nothing else of the file; files that are packed, and built-in samples, are gone through by all.
/// Collective: throws on all ranks where it throws on one. `layout` outlives the volume.
Volume loadOnRanks(Communicator& ranks, const VolumeSource& source, RankLayout& layout, const JobControl& job = {});

} // namespace pellucid
