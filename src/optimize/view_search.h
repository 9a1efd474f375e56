// Which view is best: the distance from the targets, or one feature's share, over the sphere of views, and the search
// for the best of them (docs/method.md, "The best view").
#pragma once

#include <functional>
#include <vector>

#include "render/view.h"
#include "render/visibility.h"

namespace pellucid {

inline constexpr int kSphereViews = 256;      ///< directions of a map, unless somebody asks for others
inline constexpr int kMostSphereViews = 4096; ///< at most

/// `count` unit vectors, 1 to kMostSphereViews, evenly spread over the sphere: a Fibonacci lattice. They come in an
/// order from coarse to fine: the first n of them are spread over all of the sphere, for any n. Always the same.
std::vector<Vec3> spreadDirections(int count);

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

    /// In [0,1].
    double valueOf(const FeatureSums& sums, const VwsOptions& options) const;
    bool isBetter(double a, double b) const { return figure == Figure::Objective ? a < b : a > b; }
    bool operator==(const ViewMetric&) const = default;
};

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

struct SeenView {
    Camera camera;
    double value = 0;
};

struct ViewSearchOptions {
    int count = kSphereViews;
    /// Moves on the full volume, four views each; 0: nothing but the directions of the map is looked at.
    int refinements = 3;
};

struct ViewSearchResult {
    ViewMap map;                  ///< of the coarse level
    SeenView best, worst;         ///< measured on the full level; the best of all that were
    SeenView present;             ///< the subject's own view, likewise
    int views = 0, fullViews = 0; ///< measured on the coarse level and on the full one
};

/// The map on `coarse`; from its best valleys down to views between its directions; the best of those and the present
/// view on `full`, where the last steps are made. Both levels may be the same. `watch` gets the map as it grows, on the
/// calling thread. The same bits for any number of threads. Throws Cancelled, UsageError for a count out of range or a
/// feature or targets that `subject` has not.
ViewSearchResult searchViews(const ViewLevel& coarse, const ViewLevel& full, const ViewSubject& subject,
                             const ViewMetric& metric, const ViewSearchOptions& options = {},
                             const JobControl& job = {}, const std::function<void(const ViewMap&)>& watch = {});

} // namespace pellucid
