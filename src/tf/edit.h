// What the hands do to a transfer function: pure functions, each from one valid transfer function to another.
#pragma once

#include "tf/transfer_function.h"

namespace pellucid {

/// Point `index` moved to (x, opacity), kept between its neighbours and in [0,1]. A feature's end that lies at the
/// point goes along, as far as the feature keeps a width and overlaps no other.
TransferFunction withPointMoved(const TransferFunction& tf, int index, double x, double opacity);

struct AddedPoint {
    TransferFunction tf;
    int index = 0;
};
/// A new point in the colour that the function has there.
AddedPoint withPointAdded(const TransferFunction& tf, double x, double opacity);
TransferFunction withPointRemoved(const TransferFunction& tf, int index);
/// The feature takes the colour along where the point is its highest.
TransferFunction withPointColor(const TransferFunction& tf, int index, const Rgb& color);
TransferFunction withPointFixed(const TransferFunction& tf, int index, bool fixed);

/// The feature, and all points that belong to it alone.
TransferFunction withFeatureColor(const TransferFunction& tf, int feature, const Rgb& color);
TransferFunction withFeatureName(const TransferFunction& tf, int feature, const std::string& name);
/// Everything `factor` > 0 times as dense: α of each point becomes 1 − (1 − α)^factor, which multiplies its extinction.
TransferFunction withDensity(const TransferFunction& tf, double factor);
inline constexpr double kMostDensity = 16; ///< what one asks for at a time

/// The peak of one feature; see withFeatureOpacities().
TransferFunction withFeatureOpacity(const TransferFunction& tf, int feature, double opacity);

} // namespace pellucid
