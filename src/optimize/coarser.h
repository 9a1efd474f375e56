// Ever coarser copies of a volume, on which an optimization makes its first moves (docs/method.md, "Newton").
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "optimize/objective.h"

namespace pellucid {

/// Each voxel the mean of two along every axis whose spacing is below 1.5 times the smallest one; the reference length,
/// and with it opacity and σ, stays that of `volume`. Intensities mean what they did. Throws Cancelled.
std::shared_ptr<const Volume> halved(const Volume& volume, const JobControl& job = {});

/// The weights of halved(volume), of those of the volume: means over the same voxels. Throws Cancelled.
WeightFields halvedWeights(const WeightFields& weights, const Volume& volume, const JobControl& job = {});

/// The copies of one volume, with an engine and weights each.
class CoarserVolumes {
public:
    using MakeEngine = std::function<std::unique_ptr<VisibilityEngine>(std::shared_ptr<const Volume>)>;
    /// Halves while there are more than kSmallest voxels: far coarser ones mislead. The first copy of a volume that
    /// engines sample finely because it is small (below kSampledFinely) is the volume itself: what `make` gives is much
    /// faster there. Throws Cancelled, and what `make` does.
    CoarserVolumes(std::shared_ptr<const Volume> volume, const MakeEngine& make, const JobControl& job = {});

    static constexpr std::size_t kSampledFinely = 128 * 128 * 128;
    static constexpr std::size_t kSmallest = 1'500'000;
    static constexpr std::size_t kMost = 5; ///< copies
    /// Sweeps of so few voxels follow the hand without a copy.
    static constexpr std::size_t kQuick = 64 * 64 * 64;

    std::size_t size() const { return m_levels.size(); }
    const Volume& volume(std::size_t level) const { return *m_levels[level].volume; }
    /// Those of the volume, which sums are to be weighted by from now on; kept as a reference. Throws Cancelled.
    void setWeights(const WeightFields& weights, const JobControl& job = {});
    /// W of each copy, the finest first; they refer to this.
    std::vector<std::unique_ptr<VwsFunction>> functions(const View& view, const TransferFunction& base,
                                                        const VwsOptions& options) const;

private:
    struct Level {
        std::shared_ptr<const Volume> volume;
        std::unique_ptr<VisibilityEngine> engine;
        WeightFields weights; ///< empty: those of the volume
    };
    std::shared_ptr<const Volume> m_full;
    const WeightFields* m_weights = nullptr; ///< of the volume
    std::vector<Level> m_levels;
};

} // namespace pellucid
