// Refinement of curves whose features share border points: features move as wholes (docs/method.md, "Features as
// wholes").
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "optimize/refine/refine.h"

namespace pellucid {

/// Whether refinement moves the features of `tf` as wholes, not its points: two of them meet where one is not
/// transparent, as no tents do; or Exact is to bring out one of several. Never by the published profile.
bool movesFeatures(const TransferFunction& tf, const RefineOptions& options = {});

/// Whether a control point of the feature is fixed above 0: then it does not move as a whole.
bool isHeld(const TransferFunction& tf, const Feature& feature);

/// What an edge of refinement spans.
struct RefineEdge {
    double a = 0, b = 1;      ///< intensities
    bool participates = true; ///< something of it can move
};
/// As many as refine() has of `tf`; as edgeWeights() has where there are no options.
std::vector<RefineEdge> refineEdges(const TransferFunction& tf, const RefineOptions& options = {});

/// The feature that a priority means: the one that holds the intensity, else the nearest by its interval; of a region
/// the one whose colours are nearest, on average over its voxels. Empty without a priority or where no feature can be
/// told.
std::optional<std::size_t> prioritizedFeature(const Histogram& histogram, const TransferFunction& tf,
                                              const RefinePriority& priority, Profile profile = Profile::Default);

/// One number per feature: its part of Σ α·p, the mean opacity of all voxels, [0,1].
std::vector<double> opacityParts(const Histogram& histogram, const TransferFunction& tf);

/// `tf` with the opacities of `refined`, which came of a refinement of its points or features.
TransferFunction withOpacitiesOf(const TransferFunction& tf, const TransferFunction& refined);

/// The features of a transfer function as numbers, one of each per feature.
struct FeatureLine {
    FeatureLine(const Histogram& histogram, const TransferFunction& tf, const RefinePriority& priority);

    std::vector<double> peak;        ///< opacity x_F
    std::vector<double> weight;      ///< e_F (3.3), (3.8), (3.13) at peak 1; of what is meant 0
    std::vector<double> information; ///< (3.3) at peak 1
    std::vector<double> amount;      ///< opacityParts() at peak 1
    std::vector<char> movable;       ///< seen, with voxels, no point of its own fixed above 0
    std::optional<std::size_t> meant;

    std::size_t features() const { return peak.size(); }
    std::vector<double> weights() const;        ///< of all features
    std::vector<double> movableWeights() const; ///< of those that are movable
    double movableAmount() const;               ///< Σ α·p over them: what both methods keep
    /// What others may come down to where something is meant: a part of what they have.
    double lowest(std::size_t feature) const;
};

/// refine() by whole features. RefineOptions::total, of Exact, is in units of FeatureLine::movableAmount(). Edges and
/// their weights in the result are features.
RefineResult refineFeatures(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options,
                            const JobControl& job);

} // namespace pellucid
