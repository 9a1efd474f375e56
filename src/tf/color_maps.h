// Colours by intensity: maps that a transfer function can take its colours from (docs/method.md, "Colour maps").
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tf/transfer_function.h"

namespace pellucid {

struct ColorMap {
    enum class Kind { Hue, Sequential, Diverging, Categorical };
    std::string name;  ///< as one types it: "spiral"
    std::string title; ///< in a few words, for people
    Kind kind = Kind::Sequential;
    bool visionSafe = false; ///< told apart by eyes without red or green cones too

    Rgb (*colorAt)(double t) = nullptr; ///< t in [0,1], clamped
};

/// All there are, in the order in which they are offered.
std::span<const ColorMap> colorMaps();
/// Throws UsageError that lists them all.
const ColorMap& colorMapNamed(const std::string& name);

struct ColorMapOptions {
    bool reversed = false; ///< from its end to its start
    bool inverted = false; ///< lightness L* becomes 100 − L*; hue and, as far as sRGB reaches, chroma stay
    /// One colour per feature, evenly by their order; else every point has the colour of its intensity. Categorical
    /// maps are always over features.
    bool overFeatures = false;
};

/// The colour at t in [0,1] under the options.
Rgb colorOf(const ColorMap& map, double t, const ColorMapOptions& options = {});
/// How much two colours differ: ΔE*ab, the distance in CIELAB.
double colorDifference(const Rgb& a, const Rgb& b);

/// Largest ΔE*ab between a map and the transfer function that took it, where it is not transparent.
inline constexpr double kColorTolerance = 1.0;

/// `tf` in the colours of `map`. α stays; where the line between two points that are not both transparent would miss
/// the map by more than kColorTolerance, points are added on the curve, movable where an end is. Features take the
/// colour of their highest point. Points of no feature keep their colours under `overFeatures`.
TransferFunction withColorMap(const TransferFunction& tf, const ColorMap& map, const ColorMapOptions& options = {});
/// The colours of all points (and features) end to end: the colour at x becomes that of 1 − x, linearly between points.
TransferFunction withColorsReversed(const TransferFunction& tf);
/// L* of all points and features becomes 100 − L*, see ColorMapOptions::inverted.
TransferFunction withColorsInverted(const TransferFunction& tf);

/// The colour of the categorical map that is farthest from all of `present`.
Rgb colorApartFrom(const std::vector<Rgb>& present);

} // namespace pellucid
