// Features as objects: tents, ramps, trapezoids, Gaussians and steps that are added, moved, widened, split, merged.
// Pure functions, each from one valid transfer function to another; `feature` is an index into tf.features.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tf/transfer_function.h"

namespace pellucid {

enum class ShapeKind { Tent, Trapezoid, Gaussian, Ramp, Step };
inline constexpr ShapeKind kShapeKinds[] = {ShapeKind::Tent, ShapeKind::Trapezoid, ShapeKind::Gaussian, ShapeKind::Ramp,
                                            ShapeKind::Step};
std::string name(ShapeKind kind); ///< "tent", "trapezoid", "Gaussian", "ramp", "step"

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
/// The shape as a feature of its own. What lies in [a, b) without belonging to a feature gives way. Throws Error where
/// the interval is none or meets a feature.
AddedFeature withShapeAdded(const TransferFunction& tf, const Shape& shape);

/// Points that make up the feature: those in (a, b), and at its ends those on its side where a neighbour touches it.
std::vector<int> pointsOfFeature(const TransferFunction& tf, int feature);
/// Index of the feature with that identity, −1 where there is none (or `id` is 0).
int featureWithId(const TransferFunction& tf, FeatureId id);
/// The next feature by intensity, −1: none.
int nextFeature(const TransferFunction& tf, int feature);
int previousFeature(const TransferFunction& tf, int feature);

/// Its points and its interval go along, as far as [0,1] and its neighbours let them. Nothing else moves; α of its
/// shape stays. What lies there without belonging to a feature gives way.
TransferFunction withFeatureMoved(const TransferFunction& tf, int feature, double dx);
/// Its interval becomes [a, b), clamped as above and at least kSmallestFeature wide; its points are mapped affinely.
TransferFunction withFeatureWidened(const TransferFunction& tf, int feature, double a, double b);
/// The shape `kind` in place of the feature's own: same interval, peak, place of the peak, colour.
TransferFunction withFeatureKind(const TransferFunction& tf, int feature, ShapeKind kind);

/// A copy of the same shape, shown, in the nearest gap that is as wide, else narrowed to the widest gap. Throws Error
/// where there is none of at least 1/64.
AddedFeature withFeatureDuplicated(const TransferFunction& tf, int feature);
/// A gap between features in which a new one of `width` would stand, centred as near as can be to `near`; where none is
/// as wide, the widest whole. Throws Error where there is none of at least 1/64.
ValueRange roomFor(const TransferFunction& tf, double width, double near);

/// The smallest part of a feature's voxels that a half may have after a split.
inline constexpr double kSmallestPart = 0.02;
/// Two features, [a, at) and [at, b), with names that tell them apart (part_names.h); α and points stay but for a point
/// on each side of the border. The lower one keeps the identity; the upper one's colour becomes one that is told apart,
/// where the feature is of one colour. `counts`, a histogram over [0,1], says how many voxels there are; empty: nobody
/// knows. Throws Error where `at` leaves either too narrow, or with less than kSmallestPart of the voxels.
TransferFunction withFeatureSplit(const TransferFunction& tf, int feature, double at,
                                  std::span<const std::uint64_t> counts = {});
/// Where to split: the bottom of the deepest valley of `counts` (a histogram over [0,1]) between two peaks inside the
/// feature that leaves each side kSmallestPart of its voxels; where there is none its middle, and where that leaves
/// less, the border between bins that comes nearest to halving the voxels.
double splitPlace(const Feature& feature, std::span<const std::uint64_t> counts);
/// The feature and the next one by intensity as one, with what lies between; α and points stay. The wider one's colour,
/// identity and eye, both names (those of parts become that of the whole). Throws Error where there is no next one.
AddedFeature withFeaturesMerged(const TransferFunction& tf, int feature);
/// The feature and its shape.
TransferFunction withFeatureRemoved(const TransferFunction& tf, int feature);

TransferFunction withFeatureHidden(const TransferFunction& tf, int feature, bool hidden);
/// All others hidden, itself shown.
TransferFunction withOthersHidden(const TransferFunction& tf, int feature);
TransferFunction withAllShown(const TransferFunction& tf);

} // namespace pellucid
