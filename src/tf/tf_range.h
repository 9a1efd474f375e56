// Transfer functions in data units: the same function of the data, written for another intensity window.
#pragma once

#include "tf/transfer_function.h"

namespace pellucid {

/// `tf`, whose x refer to tf.range, written for `range` (lo < hi): its points and features keep their data values. What
/// lies beyond the new range is cut off there, with a point where the curve is cut; a feature that lies there wholly is
/// gone. Values beyond the old range keep the opacity and colour they had, those of its end. Where tf.range is absent
/// or the same, the points stay bit for bit. The result's range is `range`.
TransferFunction inRange(const TransferFunction& tf, const ValueRange& range);

} // namespace pellucid
