// The transfer function as picture and figures have it: without what the eye of a feature hides.
#pragma once

#include <vector>

#include "tf/transfer_function.h"

namespace pellucid {

/// `tf` with α = 0 over every hidden feature; points, features and their order stay, a step is added where a hidden
/// feature ends above 0. `tf` itself where nothing is hidden.
TransferFunction shownTf(const TransferFunction& tf);

/// `tf` with the opacities x of its features (see withFeatureOpacities()); hidden features keep theirs: what was found
/// for shownTf(tf), put into what people edit. shownTf() of the result has the opacities x.
TransferFunction withShownOpacities(const TransferFunction& tf, std::vector<double> x);

/// Opacities x for withShownOpacities() without a feature that has lost its shape, as one scaled to 0 has: those that
/// `was` above `least` stay there, smaller ones where they were at most. Both have a value per feature.
std::vector<double> withShapesKept(std::vector<double> x, const std::vector<double>& was, double least);

/// `shares` with those of hidden features at 0 and the others scaled to sum 1; equal shares where those are all 0.
std::vector<double> shownShares(const TransferFunction& tf, std::vector<double> shares);

} // namespace pellucid
