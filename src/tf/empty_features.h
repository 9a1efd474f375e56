// Features that no voxel belongs to: there is nothing of them to see, from wherever, at whatever opacity.
#pragma once

#include <string>
#include <vector>

#include "tf/transfer_function.h"
#include "volume/histogram.h"

namespace pellucid {

/// Whether some valid voxel of the histogram's volume has an intensity of `feature`, as the engines read intensities
/// (IntensityCoder).
bool hasVoxel(const Feature& feature, const Histogram& histogram);

/// Per feature of `tf`, whether it has no voxel.
std::vector<bool> emptyFeatures(const TransferFunction& tf, const Histogram& histogram);

/// Names of the features as tables list them: "low", "low (empty)".
std::vector<std::string> namesWithEmpty(const TransferFunction& tf, const Histogram& histogram);

/// `tf` with its empty features hidden: in what becomes of targets, both are the same. Not to be drawn: the opacities
/// of features beside them would change.
TransferFunction withEmptyHidden(TransferFunction tf, const Histogram& histogram);

/// "'low' has no voxel, so that its target counts as 0", of those that have no voxel and one of `targets` (one per
/// feature, or none) above 0; empty where there are none.
std::string emptyTargetText(const TransferFunction& tf, const Histogram& histogram, const std::vector<double>& targets);

} // namespace pellucid
