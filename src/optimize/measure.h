// All figures of one view of one transfer function: what `measure` prints and the window's bars show.
#pragma once

#include <vector>

#include "optimize/coverage.h"
#include "render/visibility.h"
#include "saliency/saliency_field.h"
#include "saliency/vws.h"

namespace pellucid {

struct Measures {
    std::vector<FeatureMeasures> features;   ///< in the order of tf.features
    std::vector<double> opacities;           ///< peak of each feature
    std::vector<double> visibilityHistogram; ///< of all visibility, that of each of 256 bins; sum 1 or all 0
    std::optional<Coverage> coverage;        ///< how strong the picture is: of those who ask for it (Workspace)
    double visibilitySeconds = 0;
};

/// In one sweep. `weights` from saliencyFields() of the same tf. Throws as VisibilityEngine::sums() does.
Measures measure(VisibilityEngine& engine, const View& view, const TransferFunction& tf, const WeightFields& weights,
                 const VwsOptions& options = {}, const JobControl& job = {});

} // namespace pellucid
