// Features as objects: tents, ramps, trapezoids, Gaussians and steps that are added, moved, widened, split, merged.
// Pure functions, each from one valid transfer function to another; `feature` is an index into tf.features.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/enum_names.h"
#include "tf/transfer_function.h"

namespace pellucid {

enum class ShapeKind { Tent, Trapezoid, Gaussian, Ramp, Step };
template <>
inline constexpr auto kNamesOf<ShapeKind> = enumNames("shape", "tent", "trapezoid", "Gaussian", "ramp", "step");

/// Opacity over [a, b), 0 at both ends but for a step and the upper end of a ramp.
struct Shape {
    ShapeKind kind = ShapeKind::Tent;
    double a = 0, b = 1;   ///< intensities, 0 ≤ a < b ≤ 1
    double peak = 0.5;     ///< its highest opacity, [0,1]
    Rgb color = {};        ///< of the feature and of all points
    std::string name = {}; ///< of the feature; empty: one that no other has
    double top = 0.5;      ///< where the peak lies between a (0) and b (1); of a ramp and a step nothing
};

/// Features narrower than this hold no voxel and cannot be seen or grabbed.
inline constexpr double kSmallestFeature = 1.0 / 4096;
/// Largest distance of a Gaussian's chords from the curve, as a part of its peak.
inline constexpr double kGaussianTolerance = 0.005;

/// The control points of a shape, sorted, from a to b; those at the bottom are fixed. The Gaussian is
/// (exp(−z²/2) − e^(−9/2)) / (1 − e^(−9/2)) with z = ±3 at its ends, as few chords as halving finds.
std::vector<ControlPoint> pointsOfShape(const Shape& shape);

struct AddedFeature {
    TransferFunction tf;
    int index = 0; ///< of the feature, in tf.features
};
/// The shape as a feature of its own; points of no feature in [a, b) are dropped. Throws Error where that is not an
/// interval, or meets a feature.
AddedFeature withShapeAdded(const TransferFunction& tf, const Shape& shape);

/// Points that make up the feature: those in (a, b), and at its ends those on its side where a neighbour touches it.
std::vector<int> pointsOfFeature(const TransferFunction& tf, int feature);
/// Index of the feature with that identity, −1 where there is none (or `id` is 0).
int featureWithId(const TransferFunction& tf, FeatureId id);
/// The next feature by intensity, −1: none.
int nextFeature(const TransferFunction& tf, int feature);
int previousFeature(const TransferFunction& tf, int feature);

/// Moves interval and points of the feature, as far as [0,1] and its neighbours allow; its opacities stay. Points of no
/// feature that are in the way are dropped.
TransferFunction withFeatureMoved(const TransferFunction& tf, int feature, double dx);
/// Its interval becomes [a, b), clamped likewise and at least kSmallestFeature wide; its points are mapped affinely.
TransferFunction withFeatureWidened(const TransferFunction& tf, int feature, double a, double b);
/// The shape `kind` in place of the feature's own: same interval, peak, place of the peak, colour.
TransferFunction withFeatureKind(const TransferFunction& tf, int feature, ShapeKind kind);

/// A copy of the same shape, shown, in the nearest gap that is as wide, else narrowed to the widest gap. Throws Error
/// where there is none of at least 1/64.
AddedFeature withFeatureDuplicated(const TransferFunction& tf, int feature);
/// Where a new feature of `width` fits between the others, centred as near to `near` as can be; where none fits, the
/// widest gap. Throws Error where that is less than 1/64.
ValueRange roomFor(const TransferFunction& tf, double width, double near);

/// The smallest part of a feature's voxels that a half may have after a split.
inline constexpr double kSmallestPart = 0.02;
/// Two features, [a, at) and [at, b), with names that tell them apart (part_names.h); α and points stay but for a point
/// on each side of the border. The lower one keeps the identity; the upper one's colour becomes one that is told apart,
/// where the feature is of one colour. `counts`, a histogram over [0,1], says how many voxels there are; empty: nobody
/// knows. Throws Error where `at` leaves either too narrow, or with less than kSmallestPart of the voxels.
TransferFunction withFeatureSplit(const TransferFunction& tf, int feature, double at,
                                  std::span<const std::uint64_t> counts = {});
/// Where to split: in the deepest valley of `counts` (a histogram over [0,1]) between two peaks of the feature that
/// leaves each side kSmallestPart of its voxels; else in its middle; where that leaves less, at the border between bins
/// that comes nearest to halving the voxels.
double splitPlace(const Feature& feature, std::span<const std::uint64_t> counts);
/// The feature and the next one by intensity as one, with what lies between; points stay. Colour, identity and eye are
/// the wider one's, the name is made of both. Throws Error where there is no next one.
AddedFeature withFeaturesMerged(const TransferFunction& tf, int feature);
/// The feature and its shape.
TransferFunction withFeatureRemoved(const TransferFunction& tf, int feature);

TransferFunction withFeatureHidden(const TransferFunction& tf, int feature, bool hidden);
/// All others hidden, itself shown.
TransferFunction withOthersHidden(const TransferFunction& tf, int feature);
TransferFunction withAllShown(const TransferFunction& tf);

} // namespace pellucid
