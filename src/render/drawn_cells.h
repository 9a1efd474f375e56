// A coarse grid over a volume, and which of its cells a transfer function draws.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/common.hpp>

#include "base/job.h"
#include "render/clipping.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"
#include "volume/volume_part.h"
#include "volume/voxel_loops.h"

namespace pellucid {

/// Voxels lo … hi − 1 along each axis, and the cells that they are divided into: `most` at most, as many as voxels
/// where these are fewer.
struct CellGrid {
    static constexpr std::size_t kMost = std::size_t{1} << 18;

    Int3 lo, hi, cells;

    CellGrid(const Int3& from, const Int3& to, std::size_t most = kMost);
    bool isFine() const { return cells == hi - lo; } ///< a cell is a voxel
    /// The first voxel of a cell; of the one after the last, hi.
    int begin(int axis, int cell) const;
    /// The cells that have voxels of a region, as lo and hi; none where any hi ≤ lo.
    VoxelRegion cellsIn(const VoxelRegion& region) const;
    /// A voxel of the cell, by a hash: regular places would follow regular data.
    Int3 voxelIn(const Int3& cell) const;
};

/// valueOf(voxel, intensity), a number, for the voxel that stands for each cell; the intensity is NaN where it is
/// invalid. Where the voxels are in several processes each makes the numbers of its own voxels, and gets all:
/// collective. Throws Cancelled.
template <class ValueOf>
auto ofCells(const Volume& volume, const CellGrid& grid, const JobControl& job, const ValueOf& valueOf) {
    using Value = decltype(valueOf(Int3(), 0.0));
    Grid<Value> result(grid.cells);
    const VolumePart part = partHere(volume);
    const VoxelRegion near = grid.cellsIn(part.own);
    if (part.volume != nullptr)
        forEachPlace(glm::max(near.hi - near.lo, Int3(0)), job, [&](const Int3& place, std::size_t) {
            const Int3 cell = near.lo + place, voxel = grid.voxelIn(cell);
            if (!part.owns(voxel)) return;
            const std::size_t i = part.indexOf(voxel);
            result.at(cell.x, cell.y, cell.z) =
                valueOf(voxel, part.volume->isValid(i) ? volume.intensityOfValue(part.volume->value(i))
                                                       : std::numeric_limits<double>::quiet_NaN());
        });
    if (volume.elsewhere() == nullptr) return result;
    std::vector<double> all(result.begin(), result.end()); // 0 for the voxels of others
    volume.elsewhere()->sum(all);
    std::ranges::transform(all, result.begin(), [](double value) { return static_cast<Value>(value); });
    return result;
}

/// `tf` with an equal peak for each feature that can be seen at all, a path of half the box through which is at least
/// 5 % opaque; 0 for the others. The peak: a path of `part` of the box has this `alpha`. So what is found with it does
/// not depend on how the opacities are balanced.
TransferFunction withEvenPeaks(const TransferFunction& tf, const Geometry& geometry, double alpha, double part);

/// 1 where the voxel that stands for a cell is drawn: where its opacity is a tenth of the peak of its feature or more,
/// if that can be seen, or it is in no feature and can be seen; and it lies within the planes. Throws Cancelled.
Grid<std::uint8_t> drawnCells(const Volume& volume, const TransferFunction& tf, std::span<const VoxelPlane> planes,
                              const CellGrid& grid, const JobControl& job = {});

} // namespace pellucid
