// A small, regular sample of a volume: enough to tell what its values are and where they lie, whatever its size.
#pragma once

#include <vector>

#include "base/job.h"
#include "volume/volume.h"

namespace pellucid {

/// One voxel out of each cell of a coarse grid, at a place within the cell that a hash of the cell decides (a regular
/// choice would follow regular data); in the outermost cells the outermost voxel, so that the survey's faces are the
/// volume's. A volume of at most kMostCells voxels is surveyed wholly. The same for any number of threads.
struct VoxelSurvey {
    static constexpr std::size_t kMostCells = std::size_t{1} << 18;

    Int3 dims{0, 0, 0};               ///< cells
    std::vector<double> values;       ///< data units, x fastest; NaN where invalid
    std::vector<double> gradients;    ///< |∇| by central differences, data units per d0; NaN where invalid
    std::vector<std::size_t> indices; ///< of the voxels picked
    Vec3 pathPerCell{1, 1, 1};        ///< length of a cell along each axis, in d0

    std::size_t size() const { return values.size(); }
    /// Whether cell i lies on a face of the volume. Axes of one cell have no faces.
    bool onFace(std::size_t i) const;
};

VoxelSurvey surveyVoxels(const Volume& volume, const JobControl& job = {});

/// What a boundary joins: the values where a path along the gradient ends on either side (Šereda et al. 2006, "LH
/// histograms").
struct BoundaryEnds {
    double low = 0, high = 0; ///< data units, low ≤ high
};

/// The ends of the boundaries through surveyed voxels whose gradient exceeds `least` (data units per d0), at most
/// kMostBoundaries of them, evenly out of all. A path ends where the value changes by less than `flat` from one d0 to
/// the next.
inline constexpr std::size_t kMostBoundaries = 40'000;
std::vector<BoundaryEnds> boundaryEnds(const Volume& volume, const VoxelSurvey& survey, double least, double flat,
                                       const JobControl& job = {});

} // namespace pellucid
