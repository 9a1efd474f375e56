// Volumes that are a part of their data, or coarser than they are.
//
// Voxel (i,j,k) of a volume downsampled by N is the mean of the valid voxels N·(i,j,k) … N·(i,j,k) + N − 1 of the data,
// invalid where there are none; means of integers are rounded, halves up. Spacing is N times as large, and the first
// centre lies (N−1)/2 voxels further in, so that the data stay where they are. Where N does not divide the size, the
// box grows by up to N − 1 voxels, and the last voxel is the mean of fewer. An axis shorter than N becomes one voxel.
#pragma once

#include <glm/vec2.hpp>

#include "base/job.h"
#include "volume/memory_use.h"
#include "volume/volume.h"
#include "volume/voxel_colors.h"

namespace pellucid {

struct VolumeSource;

/// What is taken of data of `full` voxels.
struct ExcerptPlan {
    VoxelRegion region;
    Int3 factors{1, 1, 1}; ///< voxels of the data to one, along each axis
    Int3 dims{1, 1, 1};    ///< of the volume
    Excerpt excerpt;
    double referenceLength = 0; ///< as Geometry has it; 0: that of the data, or the new smallest spacing

    bool isWhole() const { return dims == excerpt.fullDims; }
    /// Of the volume, where the data have this one.
    Geometry geometryOf(const Geometry& full) const;
    /// What the user should know; empty where nothing is left out.
    std::vector<std::string> notices() const;

    std::uint64_t neededAtFull = 0, available = 0; ///< bytes; of a factor that was chosen for memory
};

/// A region of data of `full` voxels, downsampled by `factor`, or by less along axes that are shorter.
ExcerptPlan planOf(const VoxelRegion& region, const Int3& full, int factor);

/// Region and factor that `source` asks for. `inFile`: where all voxels are taken, samples stay in their file. Throws
/// UsageError for a region that does not lie in the data, FileError where memory has no room.
ExcerptPlan planExcerpt(const VolumeSource& source, const Int3& full, SampleType type, bool inFile);

/// The means of one layer of a downsampled volume.
template <class T>
class LayerMeans {
public:
    /// `size` voxels along x and y go into it. `missing` as Volume has it.
    LayerMeans(const glm::ivec2& size, const Int3& factors, std::optional<double> missing);
    /// A row of voxels at y = j.
    void add(const T* row, int j);
    /// Writes the means of all rows since the last call, and begins anew.
    void takeTo(T* layer);
    /// Smallest and largest valid value so far; lo > hi before there is one.
    const ValueRange& range() const noexcept { return m_range; }

    /// Of `count` valid values; missing where there is none.
    T meanOf(double sum, std::uint32_t count) const;

private:
    glm::ivec2 m_size, m_layer;
    Int3 m_factors;
    std::optional<T> m_missing;
    std::vector<double> m_sums;
    std::vector<std::uint32_t> m_counts;
    ValueRange m_range;
};

/// Voxel v of a volume lies at `first` + v·`factors` among the voxels of its data.
struct PlaceInData {
    Vec3 first{0.0}, factors{1.0};
};
PlaceInData placeInData(const Volume& volume);

/// The same part of a volume in memory, with its missing value, title and format; the window stays that of `whole`.
/// Throws Cancelled.
Volume excerptOf(const Volume& whole, const ExcerptPlan& plan, const JobControl& job = {});

/// The whole volume, wherever its voxels are, in this process, downsampled by `factor` ≥ 1, with the reference length
/// of `whole`, so that opacities, saliency and figures mean the same in both.
Volume coarserCopy(const Volume& whole, int factor);
/// Colours by voxel on the grid of coarserCopy(): each the mean over `factor` (≥ 1) voxels along each axis, fewer at
/// the far ends.
VoxelColors coarserColors(const VoxelColors& colors, int factor);

/// The voxels of the data that lie, wholly or in part, between the fractions `lo` and `hi` of the volume's box along
/// each axis; 0 ≤ lo < hi ≤ 1.
VoxelRegion regionBetween(const Volume& volume, const Vec3& lo, const Vec3& hi);

/// The volume with the window of the data that it was made of, so that intensities mean what they did there.
Volume throughWindowOf(Volume volume, const ValueRange& dataRange);

} // namespace pellucid
