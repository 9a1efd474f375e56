// The transfer function as people edit it: control points and features (docs/method.md, "Transfer function").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tf/feature.h"
#include "volume/volume.h"

namespace pellucid {

struct ControlPoint {
    double x = 0;       ///< intensity, [0,1]
    double opacity = 0; ///< α of a path of length d0, [0,1]
    Rgb color;
    bool fixed = false; ///< refinement leaves it alone
    std::string extraJson;

    bool operator==(const ControlPoint&) const = default;
};

/// Control points sorted by x (two may share an x: a step, the later one holds from x on), and features that do not
/// overlap. A value type: comparing two tells whether anything has changed.
class TransferFunction {
public:
    std::vector<ControlPoint> points;
    std::vector<Feature> features;
    std::optional<ValueRange> range; ///< data units that x = 0 and x = 1 stand for, where the file says
    std::string extraJson;

    bool operator==(const TransferFunction&) const = default;

    /// The points with v_0 = (0, 0) and v_{n+1} = (1, 0) added, fixed, where no point lies at that end. An added
    /// point has the colour of its neighbour.
    std::vector<ControlPoint> pointsWithEnds() const;

    double opacity(double s) const; ///< α(s); s is clamped to [0,1]
    Rgb color(double s) const;

    /// Throws Error naming the point or feature: x or α outside [0,1], NaN, unsorted, overlapping features.
    void validate() const;
};

/// Evaluates one transfer function at many intensities without searching its points anew.
class TfSampler {
public:
    explicit TfSampler(const TransferFunction& tf) : m_points(tf.pointsWithEnds()) {}
    double opacity(double s) const;
    Rgb color(double s) const;

private:
    std::size_t segment(double s) const; ///< index of the last point with x ≤ s
    std::vector<ControlPoint> m_points;
};

inline constexpr double kDefaultPeak = 0.5;

/// `tents:N[:PEAK]`: N tents of equal peaks, one feature each, named f1 … fN. Throws UsageError (1 ≤ N ≤ 64, 0 ≤ peak ≤
/// 1).
TransferFunction tents(int count, double peak = kDefaultPeak);
/// `ramp:N`: N points of opacity 1/6; one feature over everything.
TransferFunction ramp(int count);
/// "tents:N[:PEAK]" or "ramp:N"; empty where `text` names neither (it is a file then); throws UsageError where it does
/// badly.
std::optional<TransferFunction> tfFromSpec(const std::string& text);

/// One feature per maximal interval of positive opacity between points of opacity 0, coloured like its peak, named
/// f1, f2, …: what a file without features gets.
std::vector<Feature> deriveFeatures(const TransferFunction& tf);

/// The peak opacity of each feature, in their order: the parameters x_F of the optimization. The supremum of α over
/// [a,b).
std::vector<double> featureOpacities(const TransferFunction& tf);

/// `tf` with feature f's α scaled so that its peak is x[f], each x in [0,1]. Where α is not 0 at a feature's end, a
/// step is inserted there, so that nothing outside the feature moves. A feature whose peak is 0 has no shape to scale:
/// its movable points inside [a,b) take x[f] (throws Error where it has none and x[f] > 0).
/// Scale from the same start every time: a shape that has been scaled to 0 is lost.
TransferFunction withFeatureOpacities(const TransferFunction& tf, const std::vector<double>& x);

/// The shapes that the parameters x_F scale: `tf` with every peak at 1, so that inside feature F ∂α/∂x_F is its α here.
/// A feature that nothing can raise stays at 0.
TransferFunction withFullPeaks(const TransferFunction& tf);

} // namespace pellucid
