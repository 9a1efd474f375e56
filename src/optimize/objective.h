// Distance of the features' VWS from their targets (docs/method.md, "Optimization", eq. 5.1), many candidates at once.
#pragma once

#include <span>
#include <vector>

#include "render/visibility.h"
#include "saliency/vws.h"

namespace pellucid {

/// Targets ≥ 0 scaled to sum 1. Throws UsageError: negative, not finite, all 0, or another number than `features`.
std::vector<double> normalizedTargets(std::vector<double> targets, std::size_t features);

/// F = sqrt(Σ (W − t)² / n).
double objectiveOf(std::span<const double> vws, std::span<const double> targets);

/// VWS as a function of the features' peak opacities, of one view. Keeps references: engine and weights outlive it.
class VwsFunction {
public:
    /// `base` gives the shapes that the opacities scale.
    VwsFunction(VisibilityEngine& engine, const View& view, const TransferFunction& base,
                const WeightFields& weights, const VwsOptions& options = {});

    std::size_t featureCount() const { return m_base.features.size(); }
    const TransferFunction& base() const { return m_base; }
    /// W of each candidate (each of featureCount() opacities in [0,1]), all in one engine call.
    std::vector<std::vector<double>> evaluate(std::span<const std::vector<double>> candidates,
                                              const JobControl& job = {}) const;

private:
    VisibilityEngine& m_engine;
    View m_view;
    TransferFunction m_base;
    const WeightFields& m_weights;
    VwsOptions m_options;
};

} // namespace pellucid
