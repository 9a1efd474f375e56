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

/// The copies of one volume, with an engine and weights each. None of small volumes.
class CoarserVolumes {
public:
    using MakeEngine = std::function<std::unique_ptr<VisibilityEngine>(std::shared_ptr<const Volume>)>;
    /// Halves until there are at most kSmallest voxels. Throws Cancelled, and what `make` does.
    CoarserVolumes(std::shared_ptr<const Volume> volume, const MakeEngine& make, const JobControl& job = {});

    static constexpr std::size_t kSmallest = 64 * 64 * 64;
    static constexpr std::size_t kMost = 3; ///< copies

    std::size_t size() const { return m_levels.size(); }
    const Volume& volume(std::size_t level) const { return *m_levels[level].volume; }
    /// Those of the volume, which sums are to be weighted by from now on. Throws Cancelled.
    void setWeights(const WeightFields& weights, const JobControl& job = {});
    /// W of each copy, the finest first; they refer to this.
    std::vector<std::unique_ptr<VwsFunction>> functions(const View& view, const TransferFunction& base,
                                                        const VwsOptions& options) const;

private:
    struct Level {
        std::shared_ptr<const Volume> volume;
        std::unique_ptr<VisibilityEngine> engine;
        WeightFields weights;
    };
    std::shared_ptr<const Volume> m_full;
    std::vector<Level> m_levels;
};

} // namespace pellucid
