// Targets that are set with one word.
#pragma once

#include <vector>

#include "base/enum_names.h"
#include "session/session.h"

namespace pellucid {

enum class TargetPreset {
    Equal,    ///< the same share for each feature
    Diagonal, ///< shares in proportion to the intensity at the feature's peak
    InsideOut ///< the present shares in reverse order; where all are equal, those of Diagonal in reverse order
};
template <>
inline constexpr auto kNamesOf<TargetPreset> = enumNames("set of targets", "equal", "diagonal", "inside-out");

/// Intensity at which a feature is most opaque, [0,1]; of a plateau its middle, of a feature without a point its own.
double peakIntensity(const TransferFunction& tf, std::size_t feature);

/// Shares of `tf`'s features, in their order, sum 1. Locked targets stay, hidden features have 0; the others divide
/// what is left in proportion to `weights` (one per feature, ≥ 0), evenly where those are 0. As they are where none is
/// free.
std::vector<double> targetsByWeights(const TransferFunction& tf, const FeatureGoals& goals,
                                     const std::vector<double>& weights);
std::vector<double> presetTargets(TargetPreset preset, const TransferFunction& tf, const FeatureGoals& goals);
/// Everything for one feature, as far as locked targets leave it.
std::vector<double> targetsForOne(const TransferFunction& tf, const FeatureGoals& goals, std::size_t feature);

} // namespace pellucid
