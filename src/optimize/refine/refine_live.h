// Live refinement: what refinement of an edited transfer function begins with.
#pragma once

#include <cstddef>
#include <vector>

#include "optimize/refine/refine.h"
#include "tf/transfer_function.h"
#include "volume/histogram.h"

namespace pellucid {

/// Whether refinement of the one may come out another way than that of the other, under the same settings.
/// `colorsCount`: something is prioritized by its colours.
bool refinesOtherwise(const TransferFunction& before, const TransferFunction& after, bool colorsCount);

/// Indices of the points whose opacity an edit has set, but for an edit that has set all of them: who holds a point
/// keeps it.
std::vector<std::size_t> heldPoints(const TransferFunction& before, const TransferFunction& after);

/// What live refinement of an edit starts from: held points are fixed, and the others have given way, or filled up, so
/// that the total opacity is as it was; equal steps up and down keep it. Where features move as wholes, the others keep
/// the mean opacity of all voxels. `options`: those of the refinement; only its profile counts.
TransferFunction liveStart(const Histogram& histogram, const TransferFunction& before, const TransferFunction& after,
                           const std::vector<std::size_t>& held, const RefineOptions& options = {});

} // namespace pellucid
