// How VWS and the distance F from the targets depend on the opacities of two or three features: both sampled on a grid
// of opacities (thesis §5.3.2, docs/method.md, "Parameter space").
#pragma once

#include <string>
#include <vector>

#include "base/enum_names.h"
#include "optimize/objective.h"

namespace pellucid {

/// How positions in [0,1] along an axis stand for opacities.
enum class AxisScale {
    Linear,     ///< the opacity is the position
    Logarithmic ///< lowest^(1 − position): from `lowest` to 1 in equal factors
};
template <>
inline constexpr auto kNamesOf<AxisScale> = enumNames("scale of an axis", "linear", "log");

inline constexpr int kMostAxisSamples = 64;

struct ParameterAxes {
    std::vector<std::size_t> features; ///< 2 or 3 different indices into the transfer function's: x, y, z
    int samples = 11;                  ///< of each axis, its ends too, [2, 64]
    AxisScale scale = AxisScale::Linear;
    double lowest = 0.001; ///< opacity at position 0 of a logarithmic axis, [1e-6, 0.5]

    void validate(std::size_t featureCount) const; ///< throws UsageError
    bool operator==(const ParameterAxes&) const = default;

    double opacityAt(double position) const;
    double positionOf(double opacity) const; ///< clamped to [0,1]
    double positionOfSample(int i) const { return static_cast<double>(i) / (samples - 1); }
    int sampleCount() const; ///< samples², samples³
    int sweepCount() const;  ///< engine calls that they take
    /// Opacities with round texts, as positions, about `wanted` of them.
    struct Tick {
        double position;
        std::string text;
    };
    std::vector<Tick> ticks(int wanted) const;
};

/// What is looked at in a space: the index of a feature (its VWS), or this (F).
inline constexpr int kObjective = -1;

/// Samples lie x fastest, then y, then z.
struct ParameterSpace {
    ParameterAxes axes;
    std::vector<double> base;             ///< opacities of all features; those that no axis has keep theirs
    std::vector<double> targets;          ///< of all features, sum 1
    std::vector<std::vector<double>> vws; ///< [feature][sample], of all features
    std::vector<double> objective;        ///< F of each sample
    std::size_t best = 0;                 ///< the sample of the least F, the first of equals
    int evaluations = 0;                  ///< of W

    bool isFlat() const { return axes.features.size() == 2; }
    Int3 dims() const { return {axes.samples, axes.samples, isFlat() ? 1 : axes.samples}; }
    const std::vector<double>& values(int shown) const; ///< kObjective or a feature
    ValueRange range(int shown) const;                  ///< of the samples
    /// Linear between the eight (four) samples around a position in [0,1]³; z counts for nothing where flat.
    double valueAt(int shown, const Vec3& position) const;

    Vec3 positionOfSample(std::size_t sample) const;
    /// Where opacities of all features lie, those of other features aside; z is 0 where flat.
    Vec3 positionOf(const std::vector<double>& opacities) const;
    std::vector<double> opacitiesAt(const Vec3& position) const; ///< of all features
    /// Sample (i,j,k) at its position: the space as a volume whose outer centres are the corners of [0,1]³ ([0,1]² ×
    /// 0).
    Geometry geometry() const;
};

/// The features that are worth an axis where nobody has chosen: of those that are shown the three of the largest
/// targets, in their own order. Throws UsageError where fewer than two are shown.
std::vector<std::size_t> defaultAxes(const TransferFunction& tf, const std::vector<double>& targets);

/// Every sample once, eight in an engine call. Throws UsageError, Cancelled.
ParameterSpace sampleParameterSpace(const VwsFunction& function, const std::vector<double>& targets,
                                    const ParameterAxes& axes, const JobControl& job = {});

/// The same samples under other targets: F follows from W.
ParameterSpace withTargets(ParameterSpace space, const std::vector<double>& targets);

/// The least factor by which a volume of so many voxels is made coarser so that sampling `axes` takes some ten seconds
/// rather than minutes.
int reductionFor(std::size_t voxels, const ParameterAxes& axes);

/// CSV: a line of names, then for each sample the opacities of the axes, W of every feature, and F.
std::string csvOf(const ParameterSpace& space, const std::vector<std::string>& featureNames);

} // namespace pellucid
