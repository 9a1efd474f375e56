// Saliency by plain sums over the balls.
#pragma once

#include "saliency/saliency_field.h"

namespace pellucid {

/// The same as updateSaliencyFields(), to within rounding: each voxel's balls are summed voxel by voxel, with the same
/// vectors, tiles and threads, but without sharing sums between neighbours or leaving out what is of one colour. What
/// `pellucid-cli bench` compares the fast way with.
void updateSaliencyFieldsDirect(WeightFields& fields, const Volume& volume, const TransferFunction& tf,
                                const SaliencyOptions& options = {}, const JobControl& job = {},
                                const VoxelColors* colors = nullptr);

} // namespace pellucid
