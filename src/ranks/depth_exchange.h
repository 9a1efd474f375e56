// From what each block absorbs of the light of rays to what reaches each block (docs/method.md, "Blocks of a volume").
#pragma once

#include <vector>

#include "ranks/block_rays.h"
#include "ranks/communicator.h"
#include "render/cpu/sweep.h"

namespace pellucid {

/// Optical depths of rays, [row][col][lanes], in units of the sweep's tables.
struct RayDepths {
    SweepRect rect;
    int lanes = 1;
    std::vector<float> values;

    RayDepths() = default;
    RayDepths(const SweepRect& rays, int lanesOfEach, float fill)
        : rect(rays), lanes(lanesOfEach), values(rays.rays() * static_cast<std::size_t>(lanesOfEach), fill) {}
};

/// Depths of rays where they enter the reach of block `to`; below 0 in the first lane: of those that do not.
struct HandedDepths {
    int to = 0;
    RayDepths depths;
};
inline constexpr float kNotHanded = -1;

/// What a block has found of one layer of a sweep by itself, as if no light were lost before it.
struct CarriedDepths {
    RayDepths through; ///< of the whole way through the block; 0 in groups that nobody asks for
    RayGroups groups;  ///< of `through`
    std::vector<HandedDepths> handed;
};

/// Tiles of a rectangle of rays, in rows, each with a rank that adds up what is told of it.
class DepthTiles {
public:
    static constexpr int kTile = 64; ///< rays along each side
    DepthTiles(const SweepRect& all, int ranks)
        : m_all(all), m_cols((all.endCol - all.firstCol + kTile - 1) / kTile),
          m_rows((all.endRow - all.firstRow + kTile - 1) / kTile), m_ranks(ranks) {}
    int count() const { return m_cols * m_rows; }
    SweepRect at(int tile) const;
    int rankOf(int tile) const { return tile % m_ranks; }
    int perRound(int lanes) const; ///< tiles that are under way at a time

private:
    SweepRect m_all;
    int m_cols, m_rows, m_ranks;
};

/// What stands before the depths of a part of a tile in a message.
struct DepthPartHead {
    int tile = 0;
    int to = -1; ///< block whose reach is entered; −1: the whole way
    SweepRect rect;
};

/// What rays have met before they enter the reach of this rank's block: the sum over the blocks before it. Rays are cut
/// into tiles; each tile has a rank that adds up what all blocks tell of it, in their `order` from the eye on, and
/// tells each of them. Two rounds of messages for a part of the tiles at a time, whatever the number of ranks.
///   all     the rays of the layer
///   before  those of this block; set where a ray is handed over
void findDepthsBefore(Communicator& ranks, const std::vector<int>& order, const SweepRect& all, CarriedDepths carried,
                      RayDepths& before);

} // namespace pellucid
