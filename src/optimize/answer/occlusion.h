// Which feature hides which (docs/method.md, "Why a target is out of reach").
#pragma once

#include <string>
#include <vector>

#include "render/visibility.h"

namespace pellucid {

/// [i][j]: the part of the visibility of feature i that feature j takes away, 1 − Σ_i v / Σ_i v where the opacity of j
/// is 0, in [0,1]; 0 for i = j, and where i is nowhere visible even then. Removal tells what a derivative does not: at
/// an opacity of 1, ∂v/∂x_j is 0 behind j, however much j hides.
using OcclusionMatrix = std::vector<std::vector<double>>;

/// Of sums as they are, and of those where feature 0, 1, … alone has opacity 0: n + 1 of n features.
OcclusionMatrix occlusionOf(const std::vector<FeatureSums>& sums);

/// In one call of the engine, n + 1 transfer functions of n features.
OcclusionMatrix occlusion(VisibilityEngine& engine, const View& view, const TransferFunction& tf,
                          const JobControl& job = {});

/// "skin hides 83 % of bone": the largest parts from 10 % on, the largest first, at most `most` of them.
std::vector<std::string> occlusionWords(const OcclusionMatrix& matrix, const std::vector<Feature>& features,
                                        std::size_t most = 3);

} // namespace pellucid
