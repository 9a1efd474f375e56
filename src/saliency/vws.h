// Feature sums → feature visibility and visibility-weighted saliency (docs/method.md, "Visibility"
// and "Visibility-weighted saliency"; eq. 4.12–4.13).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "saliency/saliency_field.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// What one transfer function shows: per feature the sum over its voxels of visibility v, and of v times each weight
/// field (0 brightness, 1 saturation); and the same over all voxels. No unit.
struct FeatureSums {
    std::vector<double> visibility;              ///< Σ_{i∈F} v_i
    std::array<std::vector<double>, 2> weighted; ///< Σ_{i∈F} v_i L_i
    double allVisibility = 0;                    ///< Σ_{i∈V}
    std::array<double, 2> allWeighted{0, 0};
};

/// Zeros for so many features.
FeatureSums emptySums(std::size_t features);
/// One voxel of visibility v and weights L_b, L_s; `feature` −1: it is in none, and counts in the sums over all alone.
void addVoxel(FeatureSums& sums, int feature, double v, double brightness, double saturation);
/// Both have the same features.
void add(FeatureSums& total, const FeatureSums& part);

/// How `sums` change with the features' peak opacities x_j, everything else held: what an exact optimizer step needs.
/// Saliency does not depend on opacity (docs/method.md, "Saliency"), so that the weights are constants here.
struct SumsJacobian {
    FeatureSums sums;
    std::vector<FeatureSums> byOpacity; ///< [j]: every sum's derivative with respect to x_j
};

struct VwsOptions {
    double u1 = 0.5, u2 = 0.5; ///< weights of brightness and saturation, in [0,1], sum 1
    bool operator==(const VwsOptions&) const = default;
};
template <>
std::span<const Setting> settingsOf<VwsOptions>();

/// The weights that count (docs/method.md, "Visibility-weighted saliency"): an attribute whose sum over all voxels is 0
/// is nowhere salient and has no say, the other one then carries weight 1; both are 0 where both sums are.
std::array<double, 2> attributeWeights(const std::array<double, 2>& allWeighted, const VwsOptions& options);

/// One feature's figures, each in [0,1].
struct FeatureMeasures {
    double visibility = 0; ///< FV_F
    double vws = 0;        ///< W_F
    double vwsBrightness = 0, vwsSaturation = 0;
};

std::vector<FeatureMeasures> featureMeasures(const FeatureSums& sums, const VwsOptions& options = {});
std::vector<double> vwsOf(const FeatureSums& sums, const VwsOptions& options = {});

/// ∂W_i/∂x_j as [i][j], by the quotient rule (docs/method.md, "Derivatives").
std::vector<std::vector<double>> vwsJacobian(const SumsJacobian& jacobian, const VwsOptions& options = {});

} // namespace pellucid
