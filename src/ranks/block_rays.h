// Which rays of a sweep go through a block, and from which of its neighbours they come.
#pragma once

#include <cstdint>
#include <vector>

#include "ranks/decomposition.h"
#include "render/cpu/sweep.h"
#include "render/cpu/sweep_volume.h"

namespace pellucid {

/// The rays that both have.
SweepRect common(const SweepRect& a, const SweepRect& b);

/// Where rays on their way through a block enter the surroundings of another one.
struct BlockEntry {
    int block = 0;     ///< the other one
    SweepReach around; ///< of its voxels, see kRayMargin
    SweepRect rays;    ///< that may do so
};

/// Groups of eight rays of a rectangle, row by row, and what they are asked for.
class RayGroups {
public:
    static constexpr std::uint8_t kBehind = 1; ///< what they have met on the whole way through a block
    static constexpr std::uint8_t kBeside = 2; ///< … where they enter the surroundings of another block

    RayGroups() = default; ///< of no rays
    explicit RayGroups(const SweepRect& rect);

    const SweepRect& rect() const { return m_rect; }
    /// As SweepInput::carried has them.
    const std::uint8_t* data() const { return m_askedFor.data(); }
    /// `rays` and `part` lie in the rectangle.
    void add(int row, const RaySpan& rays, std::uint8_t askedFor);
    bool any(const SweepRect& part, std::uint8_t askedFor) const;

private:
    /// Those of a row that rays are in, [first, end) of m_askedFor.
    struct Groups {
        std::size_t first = 0, end = 0;
    };
    Groups groups(int row, const RaySpan& rays) const;

    SweepRect m_rect;
    std::size_t m_perRow = 0;
    std::vector<std::uint8_t> m_askedFor;
};

/// The blocks from the eye on, for a camera of sweeps (sweepCamera()).
std::vector<int> sweepOrder(const Camera& camera, const Geometry& whole, const Decomposition& blocks);

/// A block and the rays of a layer of a sweep, in the coordinates of the pass.
struct BlockRays {
    SweepBox box; ///< the block
    SweepReach
        reach; ///< the stretches of rays that are the block's: each is one's, and the outermost have what is beyond
    SweepReach around;
    SweepRect all;                   ///< those of the whole volume
    SweepRect wanted;                ///< around the voxels of the block
    RayGroups carried;               ///< those that pass through `reach` and are asked for behind it or beside it
    std::vector<BlockEntry> entries; ///< into the surroundings of others; none where the block is empty
    std::vector<SweepRect> entering; ///< those that may come into its own from others
};
/// `pass`: with the rays of the sweep set (setSweepRays()); `order`: sweepOrder().
BlockRays blockRays(const SweepInput& pass, const SweepLayer& layer, const SweepPass& axes, const Int3& dims,
                    const Decomposition& blocks, const std::vector<int>& order, int own);

} // namespace pellucid
