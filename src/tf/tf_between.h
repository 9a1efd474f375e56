// Between two transfer functions.
#pragma once

#include <optional>

#include "tf/transfer_function.h"

namespace pellucid {

/// The part t ∈ [0,1] of the way from `from` to `to`: places, opacities and colours of points and borders of features
/// change evenly. Empty where the two differ in more than that: in their ranges, or in the number of points or
/// features, or in who these are.
std::optional<TransferFunction> tfBetween(const TransferFunction& from, const TransferFunction& to, double t);

} // namespace pellucid
