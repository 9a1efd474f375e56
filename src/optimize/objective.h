// Distance of the features' VWS from their targets (docs/method.md, "Optimization", eq. 5.1), many candidates at once.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "render/visibility.h"
#include "saliency/vws.h"

namespace pellucid {

/// Targets ≥ 0 scaled to sum 1. Throws UsageError: negative, not finite, all 0, or another number than `features`.
std::vector<double> normalizedTargets(std::vector<double> targets, std::size_t features);
/// Some target is above 0: there is something to aim at.
bool isAimed(std::span<const double> targets);

/// F = sqrt(Σ (W − t)² / n).
double objectiveOf(std::span<const double> vws, std::span<const double> targets);

/// VWS as a function of the features' peak opacities, of one view.
class VwsFunction {
public:
    virtual ~VwsFunction() = default;

    std::size_t featureCount() const { return base().features.size(); }
    /// Gives the shapes that the opacities scale.
    virtual const TransferFunction& base() const = 0;
    /// W of each candidate (each of featureCount() opacities in [0,1]), all in one engine call. Throws as engines do.
    virtual std::vector<std::vector<double>> evaluate(std::span<const std::vector<double>> candidates,
                                                      const JobControl& job = {}) const = 0;
    struct Linear {
        std::vector<double> vws;                     ///< W_i
        std::vector<std::vector<double>> derivative; ///< [i][j]: ∂W_i/∂x_j
    };
    /// W at x and its exact derivatives, in one sweep.
    virtual Linear jacobian(const std::vector<double>& x, const JobControl& job = {}) const = 0;
};

/// Ever rougher estimates of one function that cost less, the finest first.
using VwsEstimates = std::vector<std::shared_ptr<const VwsFunction>>;

/// As an engine tells it. Keeps references: engine and weights outlive it.
class EngineVws final : public VwsFunction {
public:
    EngineVws(VisibilityEngine& engine, const View& view, const TransferFunction& base, const WeightFields& weights,
              const VwsOptions& options = {});

    const TransferFunction& base() const override { return m_base; }
    std::vector<std::vector<double>> evaluate(std::span<const std::vector<double>> candidates,
                                              const JobControl& job = {}) const override;
    Linear jacobian(const std::vector<double>& x, const JobControl& job = {}) const override;

private:
    VisibilityEngine& m_engine;
    View m_view;
    TransferFunction m_base;
    const WeightFields& m_weights;
    VwsOptions m_options;
};

} // namespace pellucid
