// How an overlay is drawn by a threshold, a top and a colour map (docs/method.md, "The overlay").
#pragma once

#include "base/job.h"
#include "tf/color_maps.h"

namespace pellucid {

/// Which values of an overlay are drawn, in data units.
struct OverlayLook {
    bool twoSided = false;
    double threshold = 0; ///< nothing is drawn up to it; two-sided: nearer to 0
    double top = 1;       ///< what the colours reach to
    bool operator==(const OverlayLook&) const = default;
};

/// What the values of a volume propose. Two-sided where more than a twentieth of those that are not 0 lie on either
/// side of it: from the distance from 0 that 5 % of them exceed, and at least a quarter of the top, to that which 0.1 %
/// exceed. Else as oneSidedLook() and twoSidedLook() of their range say. Rounded to two digits.
OverlayLook usualLook(const Volume& volume, const JobControl& job = {});
/// From a tenth of the largest value to it; of negative values alone, from the lowest tenth of their range on.
OverlayLook oneSidedLook(const ValueRange& values);
/// From a tenth of the largest magnitude to it.
OverlayLook twoSidedLook(const ValueRange& values);

/// The colour map of a look where nobody chooses one.
const ColorMap& usualColorMap(const OverlayLook& look);

/// The transfer function of a look, written for the window `range` (lo < hi), whatever values lie beyond `top`. A
/// two-sided look has the colours of a diverging map from −top to top, those of another by the distance from 0; else
/// they go from 0, or from the threshold where that is below, to top. The opacity is half of `opacity`, [0,1], at the
/// threshold, and rises evenly to it.
TransferFunction overlayTf(const OverlayLook& look, const ColorMap& colors, double opacity, const ValueRange& range);

} // namespace pellucid
