// What everything that scales a feature by its points shares.
#pragma once

#include <functional>

#include "tf/transfer_function.h"

namespace pellucid {

/// α of each control point inside a feature becomes `change(point)`, in [0,1]. Where α is not 0 at the feature's end, a
/// step is inserted there, so that nothing outside the feature moves.
void changeOpacities(TransferFunction& tf, const Feature& feature,
                     const std::function<double(const ControlPoint&)>& change);

} // namespace pellucid
