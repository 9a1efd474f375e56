#include "render/drawn_cells.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "volume/noise.h"

namespace pellucid {

CellGrid::CellGrid(const Int3& from, const Int3& to, std::size_t most) : lo(from), hi(to), cells(to - from) {
    const double factor = std::cbrt(static_cast<double>(voxelCount(cells)) / static_cast<double>(most));
    if (factor <= 1) return;
    for (int a = 0; a < 3; ++a) cells[a] = std::clamp(static_cast<int>(cells[a] / factor), 1, cells[a]);
}

int CellGrid::begin(int axis, int cell) const {
    return lo[axis] + static_cast<int>(static_cast<std::int64_t>(cell) * (hi[axis] - lo[axis]) / cells[axis]);
}

VoxelRegion CellGrid::cellsIn(const VoxelRegion& region) const {
    VoxelRegion in{Int3(0), cells};
    for (int a = 0; a < 3; ++a) {
        while (in.lo[a] < cells[a] && begin(a, in.lo[a] + 1) <= region.lo[a]) ++in.lo[a];
        while (in.hi[a] > in.lo[a] && begin(a, in.hi[a] - 1) >= region.hi[a]) --in.hi[a];
    }
    return in;
}

Int3 CellGrid::voxelIn(const Int3& cell) const {
    const std::uint64_t random = hashOf(cell.x, cell.y, cell.z, 5);
    Int3 voxel;
    for (int a = 0; a < 3; ++a) {
        const int first = begin(a, cell[a]), count = begin(a, cell[a] + 1) - first;
        voxel[a] = first + static_cast<int>((random >> (20 * a)) % static_cast<std::uint64_t>(count));
    }
    return voxel;
}

namespace {

/// Opacity by which a path of `part` of the box has the alpha `alpha`.
double opacityOf(const Geometry& geometry, double alpha, double part) {
    const double side = 2 * geometry.radius() / std::sqrt(3.0) / geometry.d0();
    return 1 - std::pow(1 - alpha, 1 / std::max(1.0, part * side));
}

double leastOpacity(const Geometry& geometry) { return opacityOf(geometry, 0.05, 0.5); }

} // namespace

TransferFunction withEvenPeaks(const TransferFunction& tf, const Geometry& geometry, double alpha, double part) {
    std::vector<double> peaks = featureOpacities(tf);
    for (double& peak : peaks) peak = peak >= leastOpacity(geometry) ? opacityOf(geometry, alpha, part) : 0;
    return withFeatureOpacities(tf, peaks);
}

Grid<std::uint8_t> drawnCells(const Volume& volume, const TransferFunction& tf, std::span<const VoxelPlane> planes,
                              const CellGrid& grid, const JobControl& job) {
    const double least = leastOpacity(volume.geometry());
    // Ten times as deep: peaks of which `least` is a tenth.
    const TfSampler sampler(withEvenPeaks(tf, volume.geometry(), 1 - std::pow(1 - 0.05, 10), 0.5));
    return ofCells(volume, grid, job, [&](const Int3& voxel, double s) -> std::uint8_t {
        return !std::isnan(s) && sampler.opacity(s) >= least && keeps(planes, Vec3(voxel));
    });
}

} // namespace pellucid
