// VWS along a bundle of rays: nearly that of the volume, for a hundredth of the time.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "optimize/objective.h"
#include "render/view.h"

namespace pellucid {

/// What rays of one view through the whole volume meet, made once for a volume, a view, the shapes of a transfer
/// function and its weights. A point of a ray stands for the voxel that it lies in, with the light that reaches that
/// voxel's centre along the ray: a sample of the sums of eq. 4.13, which has no error but chance (about 1 % of a
/// share).
class RaySamples {
public:
    static constexpr int kRays = 90; ///< along each side of a square around the volume

    /// Throws Cancelled.
    RaySamples(const Volume& volume, const TransferFunction& tf, const View& view, const WeightFields& weights,
               const JobControl& job = {}, int rays = kRays);

    /// Nothing is met, or the eye is so close that no bundle holds the volume.
    bool empty() const { return m_voxels.empty(); }
    std::size_t rays() const { return m_binBegins.size() - 1; } ///< that meet something
    /// Of each of `tfs` (the same features, other opacities), in their order; of every so many rays. Sums of v·L alone.
    std::vector<FeatureSums> sums(const std::vector<TransferFunction>& tfs, int every, const JobControl& job) const;

private:
    /// A point where there is something to be seen.
    struct Met {
        std::uint32_t weights;  ///< WeightFields::units() of its voxel
        float measure;          ///< part of the volume that it stands for, times any constant
        std::uint16_t bin;      ///< of its voxel's intensity
        std::uint16_t behind;   ///< so many steps of the ray's m_bins ...
        std::uint16_t quarters; ///< ... and so many quarters of the next one
    };
    std::size_t m_features = 0;
    double m_stepInD0 = 1;
    std::array<double, 2> m_scale{};   ///< of the weights' units
    std::vector<std::uint16_t> m_bins; ///< of intensity, where something absorbs; front to back, ray after ray
    std::vector<std::uint32_t> m_binBegins{0};
    std::vector<Met> m_voxels;
    std::vector<std::uint32_t> m_voxelBegins{0};
    std::vector<int> m_slotOfBin; ///< its feature; m_features: none, but opaque
};

/// VWS as those rays tell it.
class RayVws final : public VwsFunction {
public:
    /// Of every so many rays.
    RayVws(std::shared_ptr<const RaySamples> samples, const TransferFunction& base, const VwsOptions& options,
           int every = 1);

    const TransferFunction& base() const override { return m_base; }
    std::vector<std::vector<double>> evaluate(std::span<const std::vector<double>> candidates,
                                              const JobControl& job = {}) const override;
    /// Derivatives are differences here.
    Linear jacobian(const std::vector<double>& x, const JobControl& job = {}) const override;

private:
    std::shared_ptr<const RaySamples> m_samples;
    TransferFunction m_base;
    VwsOptions m_options;
    int m_every;
};

/// Estimates for OptimizeProblem; none where rays cannot tell.
VwsEstimates rayEstimates(std::shared_ptr<const RaySamples> samples, const TransferFunction& base,
                          const VwsOptions& options = {});

} // namespace pellucid
