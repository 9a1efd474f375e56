#include "ranks/block_balance.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "ranks/rank_volume.h"
#include "render/drawn_cells.h"

namespace pellucid {

namespace {

constexpr double kWorthIt = 5.0 / 6; ///< of the work of the slowest rank

/// Some 4096 samples for each rank, so that its share is known to about 2 %. More would cost a cache miss each.
CellGrid workGrid(const Int3& dims, int ranks) {
    constexpr std::size_t kOfRank = 4096;
    return {Int3(0), dims, std::min(kOfRank * static_cast<std::size_t>(ranks), CellGrid::kMost)};
}

/// The largest part of the work that a block has.
double largestShare(const Decomposition& blocks, const Grid<double>& work, const Int3& dims) {
    const CellGrid grid = workGrid(dims, static_cast<int>(blocks.blocks().size()));
    // Along an axis, the first cell that begins at a voxel or behind it.
    const auto from = [&](int axis, int voxel) {
        int cell = 0;
        while (cell < grid.cells[axis] && grid.begin(axis, cell) < voxel) ++cell;
        return cell;
    };
    double all = 0, most = 0;
    for (const VoxelRegion& block : blocks.blocks()) { // in one order: ranks have to agree
        Int3 lo, hi;
        for (int a = 0; a < 3; ++a) {
            lo[a] = from(a, block.lo[a]);
            hi[a] = from(a, block.hi[a]);
        }
        double here = 0;
        for (int k = lo.z; k < hi.z; ++k)
            for (int j = lo.y; j < hi.y; ++j)
                for (int i = lo.x; i < hi.x; ++i) here += work.at(i, j, k);
        all += here;
        most = std::max(most, here);
    }
    return most / all;
}

} // namespace

Grid<double> sweepWork(const Volume& volume, const TransferFunction& tf, const Clipping& clipping, int ranks,
                       const JobControl& job) {
    const std::vector<VoxelPlane> planes = planesInVoxels(clipping, volume.geometry());
    const TfSampler sampler(tf);
    return ofCells(volume, workGrid(volume.dims(), ranks), job, [&](const Int3& voxel, double s) {
        return !std::isnan(s) && sampler.opacity(s) > 0 && keeps(planes, Vec3(voxel)) ? 1 : kEmptyWork;
    });
}

bool cutByWork(const Volume& volume, const TransferFunction& tf, const Clipping& clipping, const MemoryUse& then,
               const JobControl& job) {
    const auto* const voxels = dynamic_cast<const RankVoxels*>(volume.elsewhere());
    if (voxels == nullptr || voxels->layout() == nullptr) return false;
    Communicator& ranks = voxels->ranks();
    const Grid<double> work = sweepWork(volume, tf, clipping, ranks.size(), job);
    const Decomposition next(volume.dims(), ranks.size(), &work);
    if (largestShare(next, work, volume.dims()) > kWorthIt * largestShare(voxels->blocks(), work, volume.dims()))
        return false;
    const Int3 dims = [&] {
        const VoxelRegion region = widened(next.blocks()[static_cast<std::size_t>(ranks.rank())],
                                           Int3(std::max(kRayGhosts, then.reach)), volume.dims());
        return isEmpty(region) ? Int3(0) : region.hi - region.lo;
    }();
    const std::uint64_t held =
                            volume.here() != nullptr && !volume.here()->isMapped() ? volume.here()->memoryBytes() : 0,
                        needed = voxelCount(dims) * bytesPerSample(volume.sampleType()) +
                                 bytesOf(then, dims, volume.sampleType());
    const bool hasRoom = needed <= availableMemoryBytes() + held;
    if (!std::ranges::all_of(gatherValues(ranks, hasRoom), [](bool has) { return has; })) return false;
    voxels->layout()->cut = next;
    return true;
}

} // namespace pellucid
