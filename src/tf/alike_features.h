// Features whose colours are hard to tell apart, to some viewers or to all; and colours that are not (docs/method.md,
// "Colour vision").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tf/color_vision.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// CIEDE2000 that two features should be apart for every viewer: ten times what is just noticed side by side, since
/// light and what lies in front change both.
inline constexpr double kWantedDifference = 10;
/// The peak opacity from which a feature counts: over 200 reference lengths it takes a third of the light.
inline constexpr double kLeastSeenOpacity = 0.002;
/// More features than this are not given colours: there are not as many that all viewers can tell apart.
inline constexpr std::size_t kMostApart = 12;

/// The features that are drawn and opaque enough to be told apart, ascending.
std::vector<std::size_t> featuresToTell(const TransferFunction& tf);

/// The colour that each feature has as a whole: the mean of the curve's light over its interval, weighted by opacity;
/// the feature's own colour where it has none.
std::vector<Rgb> featureColors(const TransferFunction& tf);

struct AlikePair {
    std::size_t first = 0, second = 0;      ///< features, first < second
    VisionKind vision = VisionKind::Normal; ///< of the viewer to whom they are most alike; Normal: alike to all
    double difference = 0;                  ///< CIEDE2000, as that viewer sees it
};
/// The pairs of `among` that normal viewers or some with a deficiency (severity 1) see less apart than `wanted`; the
/// most alike one first.
std::vector<AlikePair> alikeFeatures(const TransferFunction& tf, const std::vector<std::size_t>& among,
                                     double wanted = kWantedDifference);

/// "bone and vessels look alike to a viewer with deuteranopia (ΔE00 3.2, of 10 wanted)".
std::string alikeText(const TransferFunction& tf, const AlikePair& pair, double wanted = kWantedDifference);

/// `tf` with other colours for as few as possible of `among`, near those they have, so that all viewers see all of them
/// `wanted` apart; which one is lighter stays as it is. Opacities stay. Empty where no such colours were found, or
/// there are more than kMostApart.
std::optional<TransferFunction> withColorsApart(const TransferFunction& tf, const std::vector<std::size_t>& among,
                                                double wanted = kWantedDifference);

} // namespace pellucid
