// What a refinement did, in words.
#pragma once

#include <string>
#include <vector>

#include "tf/transfer_function.h"

namespace pellucid {

/// Mean opacities of a feature's interval, [0,1].
struct OpacityChange {
    std::string feature;
    double before = 0, after = 0;
    bool operator==(const OpacityChange&) const = default;
};

/// An intensity as people know it: in data units where `tf` has a range. "−500".
std::string valueName(const TransferFunction& tf, double x);

/// One per feature, in their order. A transfer function that has one feature at most, such as a ramp, says nothing by
/// its mean: then one per movable control point, named by its place ("at 0.25"; in data units where `before` has a
/// range). Both have
/// the same features; the same points, too, where there is one feature at most.
std::vector<OpacityChange> opacityChanges(const TransferFunction& before, const TransferFunction& after);

/// "air −40 %, enamel × 3": the largest four, the largest first; "nothing changed" where none is as much as 1 %.
std::string changeText(const std::vector<OpacityChange>& changes);

} // namespace pellucid
