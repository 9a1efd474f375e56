// More or less of a feature: what a click on a picture asks for, put into opacities.
#pragma once

#include <string>
#include <vector>

#include "tf/transfer_function.h"

namespace pellucid {

/// One step of emphasis: a feature's extinction τ times the first, that of what hides it by the second.
inline constexpr double kMoreOfIt = 1.5, kLessOfOthers = 1.25;

struct EmphasisChange {
    std::size_t feature = 0;
    double factor = 1; ///< of its extinction, > 0
};

struct Emphasis {
    TransferFunction tf;
    std::vector<EmphasisChange> changes; ///< the feature first; empty: nothing can change, `tf` is the old one
};

/// `tf` with more of a feature: its extinction × kMoreOfIt^steps, and that of each other feature with `inFront` > 0
/// (its optical depth in front of the feature, one entry per feature) ÷ kLessOfOthers^steps. `steps` < 0: less of it,
/// the other way round; but for points at α = 1, it is the inverse. Extinctions go point by point, α → 1 − (1 −
/// α)^factor. Fixed points, and features that are `held` (one entry each) or hidden, stay; where a feature ends above 0
/// it gets a step, so that nothing outside it moves. α = 1 counts as the largest opacity that the picture knows.
Emphasis withEmphasis(const TransferFunction& tf, std::size_t feature, double steps, const std::vector<double>& inFront,
                      const std::vector<bool>& held);

/// "bone × 1.5, skin ÷ 1.25"; "" where nothing changed.
std::string emphasisText(const Emphasis& emphasis);

} // namespace pellucid
