// Entropy refinement of the opacities (docs/method.md, "Entropy refinement", thesis chapter 3).
#pragma once

#include <optional>
#include <vector>

#include "base/job.h"
#include "base/setting.h"
#include "render/profile.h"
#include "tf/transfer_function.h"
#include "volume/histogram.h"

namespace pellucid {

enum class RefineMethod {
    Greedy, ///< the thesis's: one opacity down, one up, while that helps (3.4.2)
    Exact   ///< the least energy that there is at constant total opacity
};
template <>
inline constexpr auto kNamesOf<RefineMethod> = enumNames("method", "greedy", "exact");

/// Pixels of one colour.
struct RegionColor {
    Rgb color;
    double count = 1; ///< > 0
    bool operator==(const RegionColor&) const = default;
};

/// What shall stand out: nothing, an intensity (3.6–3.9), or what has the colours of a region (3.10–3.14).
struct RefinePriority {
    std::optional<double> intensity; ///< x0, [0,1]
    std::vector<RegionColor> region; ///< in place of it; see regionColors()
    bool any() const { return intensity || !region.empty(); }
    bool operator==(const RefinePriority&) const = default;
};

/// How refinement goes about it. Ranges are those of settingsOf<RefineSteps>().
struct RefineSteps {
    double stepDown = 1.0 / 256; ///< opacity
    /// Empty: derived in each iteration from stepDown and the ratio of the two ends' significances.
    std::optional<double> stepUp = 1.0 / 256;
    int maxIterations = 5000;
    RefineMethod method = RefineMethod::Greedy;
    bool operator==(const RefineSteps&) const = default;
};
template <>
std::span<const Setting> settingsOf<RefineSteps>();

/// Both steps of the published profile.
inline constexpr double kPublishedStep = 1.0 / 255;

struct RefineOptions : RefineSteps {
    RefinePriority priority;
    /// Greedy: false goes on to maxIterations whether or not anything still improves.
    bool untilStable = true;
    /// Exact: the sum of the movable points' opacities, clamped to [0, their number]; empty: as in the start, which is
    /// what equal steps up and down keep until one of them meets a bound.
    std::optional<double> total;
    /// Published: edges weigh, and distances are, as docs/method.md, "The published profile", says; the steps are
    /// kPublishedStep then (refineOptions() in session/refine_priority.h). Follows from MeasureSettings::profile.
    Profile profile = Profile::Default;

    /// Throws UsageError: steps out of range, two priorities, an intensity outside [0,1], total < 0.
    void validate() const;
    bool operator==(const RefineOptions&) const = default;
};

struct RefineResult {
    TransferFunction tf; ///< the best seen
    int iterations = 0;
    double energyBefore = 0, energyAfter = 0;               ///< over all edges
    double energyMovableBefore = 0, energyMovableAfter = 0; ///< over participating edges, decides
    std::vector<double> edgesBefore, edgesAfter;            ///< n+1 weights, of pointsWithEnds()
    /// Movable energy: the start, then after every energyCurveStride-th iteration; at most 1000 numbers.
    std::vector<double> energyCurve;
    int energyCurveStride = 1;
    std::vector<double> factors; ///< d of pointsWithEnds(), see pointFactors()
};

/// Distance factors of pointsWithEnds(): |x0 − x_i| (3.6), the region's W_R (3.11), 1 without a priority. Where all
/// points have the region's one colour W_R is 1/n. Published: |x0 − x_i|, or the differences of hue from the region's
/// pixels added up, over their sum. Throws UsageError as RefineOptions::validate() does.
std::vector<double> pointFactors(const TransferFunction& tf, const RefinePriority& priority,
                                 Profile profile = Profile::Default);
/// The intensity whose colour is nearest in hue (any real, degrees); of equally near ones the most opaque, then the
/// lowest. Throws Error where every colour is grey.
double intensityOfHue(const TransferFunction& tf, double hueDegrees);

/// Edge weights e(i) of `tf` (3.3), (3.8), (3.13), integrated exactly (published: added up over whole bins): n+1
/// numbers, one per segment of pointsWithEnds().
std::vector<double> edgeWeights(const Histogram& histogram, const TransferFunction& tf,
                                const RefinePriority& priority = {}, Profile profile = Profile::Default);
/// Σ (e − ē)² (3.4).
double edgeEnergy(const std::vector<double>& edges);
/// Sum of the opacities of the points that are not fixed.
double movableOpacity(const TransferFunction& tf);

/// Throws UsageError (options.validate()), Cancelled.
RefineResult refine(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options = {},
                    const JobControl& job = {});

/// The greedy search that integrates every edge anew in each iteration: slow and obvious, the same bits as refine().
RefineResult refineReference(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options = {},
                             const JobControl& job = {});

/// How far greedy stays from the best that its total opacity allows.
struct RefineComparison {
    double total = 0;                         ///< sum of movable opacities, that of greedy's answer
    double greedyEnergy = 0, exactEnergy = 0; ///< movable energies at that total; exact ≤ greedy
    TransferFunction exact;                   ///< the exact answer at that total
};
/// `options.method` and `options.total` play no part.
RefineComparison compareMethods(const Histogram& histogram, const TransferFunction& tf,
                                const RefineOptions& options = {}, const JobControl& job = {});

} // namespace pellucid
