// From one transfer function to another that may be quite different.
#pragma once

#include "tf/transfer_function.h"

namespace pellucid {

/// The part t ∈ [0,1] of the way from `from` to `to`, for films: at 0 and 1 exactly these. Features of both are matched
/// by identity, else by name: their intervals move, and with them the curve within and between them. Opacities change
/// evenly, colours straight through CIELAB; what one of the two has alone appears or fades where it is. Where both have
/// the same features and as many points, each point goes straight to its counterpart. Features that an eye hides are
/// transparent. Between 0 and 1 the range is one that holds both; one without a range has that of the other.
TransferFunction tfMorph(const TransferFunction& from, const TransferFunction& to, double t);

} // namespace pellucid
