// Parts of a transfer function: its colours, its opacities and its range, each taken by itself.
#pragma once

#include "tf/transfer_function.h"

namespace pellucid {

struct TfParts {
    bool colors = true, opacities = true, range = true;
    bool any() const { return colors || opacities || range; }
    bool all() const { return colors && opacities && range; }
};

/// `now` with these parts of `other`. Both keep their data values: what is not in the resulting range is cut off. One
/// without a range of its own is taken for that of the other. Points lie wherever either has one; features are those of
/// whose opacities are taken. now.range or other.range is there.
TransferFunction withParts(const TransferFunction& now, const TransferFunction& other, const TfParts& parts);

} // namespace pellucid
