// The cpu engine with its choice of instructions in sight; render/visibility.h is the way in for everybody else.
#pragma once

#include "render/cpu/sweep.h"
#include "render/cpu/sweep_run.h"
#include "render/visibility.h"

namespace pellucid {

std::unique_ptr<VisibilityEngine> makeCpuEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                                SweepKernel kernel, PieceShare share = {});

/// To compare hundreds of views: samples every volume as sparsely as large ones are sampled, which makes small ones
/// several times faster and their figures less exact (docs/method.md, "The best view").
std::unique_ptr<VisibilityEngine> makeDraftEngine(std::shared_ptr<const Volume> volume);

/// The sums of one lane of totals [features + 1][3][lanes], the last feature being "in none"; the three are Σv and
/// Σ v times the two `weights` in units of their 16 bits (null: no weights). What engines on the device have, too.
FeatureSums featureSumsOf(std::span<const double> totals, std::size_t features, std::size_t lane, std::size_t lanes,
                          const WeightFields* weights);

} // namespace pellucid
