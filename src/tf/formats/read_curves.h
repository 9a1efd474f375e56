// From the curves of another program to a transfer function, with what has to be said about it.
#pragma once

#include <optional>

#include "tf/formats/tf_curves.h"
#include "tf/formats/tf_format.h"

namespace pellucid {

/// Sorts the nodes, and makes control points and features of them; OpacityLength and the rest of ReadTf are the
/// caller's. `positions`: the x that are 0 and 1, where x is no data value; empty: x is in data units, and what the
/// nodes span is the range. Without opacities they rise from 0 to 1, without colours all is white; one node alone holds
/// everywhere. Values outside [0,1] are cut. Throws Error without any node and for more than kMostNodes.
ReadTf tfOfCurves(TfCurves curves, const std::optional<ValueRange>& positions, const std::string& path);

} // namespace pellucid
