// Which view is best: the distance from the targets, or one feature's share, over the sphere of views, and the search
// for the best of them (docs/method.md, "The best view").
#pragma once

#include <functional>
#include <vector>

#include "base/enum_names.h"
#include "base/shared_work.h"
#include "optimize/optimizer.h"
#include "render/view.h"
#include "render/view_direction.h"
#include "render/visibility.h"

namespace pellucid {

inline constexpr int kSphereViews = 256; ///< directions of a map, unless somebody asks for others

/// What a view is judged by.
struct ViewMetric {
    enum class Figure {
        Objective, ///< F (5.1), the distance from `targets`: the less the better
        Vws,       ///< W of `feature`: the more the better
        Visibility ///< FV of `feature`, likewise
    };
    Figure figure = Figure::Objective;
    std::vector<double> targets = {}; ///< Objective: shares, one per feature, sum 1
    std::size_t feature = 0;          ///< index, of the others

    /// What the value is made of, per feature: W, or FV.
    std::vector<double> figuresOf(const FeatureSums& sums, const VwsOptions& options) const;
    double valueOf(const std::vector<double>& figures) const; ///< in [0,1]
    double valueOf(const FeatureSums& sums, const VwsOptions& options) const {
        return valueOf(figuresOf(sums, options));
    }
    bool isBetter(double a, double b) const { return figure == Figure::Objective ? a < b : a > b; }
    bool operator==(const ViewMetric&) const = default;
};

template <>
inline constexpr auto kNamesOf<ViewMetric::Figure> = enumNames("figure", "objective", "vws", "visibility");

/// What is shown, whatever it is looked at from.
struct ViewSubject {
    View view; ///< the present one: its projection, center and distance hold for all views, and what it cuts away
    TransferFunction tf;
    VwsOptions options = {};
};

/// A volume as fine as views are measured on, and the saliency of the subject's colours on it. Both outlive the search.
struct ViewLevel {
    VisibilityEngine& engine;
    const WeightFields& weights;
    SharedWork work = {}; ///< of processes that all have such a level, and divide the views that are known beforehand
};

/// Values over the sphere of views.
struct ViewMap {
    ViewMetric metric;
    std::vector<Vec3> directions; ///< unit vectors from the center to the eye, world
    std::vector<double> values;   ///< of the metric, of each direction

    bool isEmpty() const { return values.empty(); }
    std::size_t best() const; ///< index; of equal ones the first; the map is not empty
    std::size_t worst() const;
    /// Between the directions: an average over those that are near, by their distance; the value itself in each of
    /// them, and never beyond the values around. 0 where the map is empty.
    double interpolated(const Vec3& direction) const;
};

/// A map, and what its values are made of.
struct ViewSearch {
    ViewMap map;
    std::vector<std::vector<double>> figures; ///< of each direction
};

/// Looks from all over the sphere. `watch` gets the map as it grows, on the calling thread. The same bits for any
/// number of threads and processes. Throws Cancelled; UsageError for a count out of range, and for a feature or targets
/// that `subject` has not.
ViewSearch searchViews(const ViewLevel& level, const ViewSubject& subject, const ViewMetric& metric,
                       int count = kSphereViews, const JobControl& job = {},
                       const std::function<void(const ViewMap&)>& watch = {});

struct SeenView {
    Camera camera;
    double value = 0;
};

/// Figures of the full volume.
struct BestView {
    SeenView best, worst;
    SeenView present; ///< the subject's own view
    ViewMap map;      ///< that of the search, brought to the full volume by what was measured there
    int views = 0;    ///< that were looked at on the full volume
    int coarseViews = 0;
};

/// Brings the map of `search`, which was made on `coarse`, to the full volume, by measuring some directions there; goes
/// down from its best places, on the coarse level plus what the full one has differed by so far, and measures where
/// that leads. The best of all that were measured on `full`, the present view among them. Throws Cancelled.
BestView bestView(const ViewLevel& coarse, const ViewLevel& full, const ViewSubject& subject, const ViewSearch& search,
                  const JobControl& job = {});

/// A view, and opacities by which it comes near the targets.
struct ReachableView {
    Camera camera;
    std::vector<double> opacity;
    double objective = 0;
    double seen = 0; ///< Σv over all voxels: how much of the picture is covered, and how densely
};

/// What can be reached of the targets of `search`, from its best directions, others all over the sphere and the present
/// view: each by a few moves of the optimizer, the best first. Views nearer than 0.005 to the targets count as equal;
/// of these the first is the one with the most to see. Where no view comes that near, neighbours of the nearest are
/// tried too. `options.maxIterations` bounds the moves. Throws as searchViews() does.
std::vector<ReachableView> reachableViews(const ViewLevel& level, const ViewSubject& subject, const ViewSearch& search,
                                          const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                                          const JobControl& job = {});

} // namespace pellucid
