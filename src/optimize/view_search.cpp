#include "optimize/view_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "base/check.h"
#include "base/error.h"
#include "optimize/objective.h"
#include "render/view_direction.h"

namespace pellucid {

namespace {

constexpr double kPi = std::numbers::pi;

constexpr int kValleys = 6;                     ///< best places of the map that are followed between its directions
constexpr int kFinalists = 4;                   ///< of them, measured on the full volume
constexpr int kMoves = 24;                      ///< of each, at most
constexpr double kFinestStep = 0.5 * kPi / 180; ///< radians, of the steps between directions
constexpr double kFullStep = 4.0 * kPi / 180;   ///< of the first step on the full volume

constexpr int kReachSpread = 24; ///< directions from which opacities are searched, beside the best ones of the map
constexpr int kReachMoves = 6;   ///< of each search, at most
constexpr int kReachRounds = 6;  ///< of four neighbours of the nearest
constexpr double kNear = 0.005;  ///< F: views that come so near are equal

constexpr std::size_t kWatchEvery = 16; ///< views

double angleBetween(const Vec3& a, const Vec3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

/// Mean distance of neighbours among `count` spread directions, radians: that of a hexagonal lattice of the same area.
double spacingOf(std::size_t count) { return std::sqrt(8 * kPi / std::sqrt(3.0) / static_cast<double>(count)); }

/// `direction` moved by an angle (radians) toward the side `turn` (radians) of it.
Vec3 moved(const Vec3& direction, double angle, double turn) {
    const Vec3 helper = std::abs(direction.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
    const Vec3 u = glm::normalize(glm::cross(helper, direction)), v = glm::cross(direction, u);
    return glm::normalize(std::cos(angle) * direction + std::sin(angle) * (std::cos(turn) * u + std::sin(turn) * v));
}

/// The value of directions on one level.
class Judge {
public:
    Judge(const ViewLevel& level, const ViewSubject& subject, const ViewMetric& metric)
        : m_level(level), m_subject(subject), m_metric(metric) {}

    Camera cameraFor(const Vec3& direction) const {
        return lookingFrom(m_subject.view.camera, m_level.engine.volume().geometry(), direction);
    }
    SeenView look(const Camera& camera, const JobControl& job) {
        const View view(camera, m_subject.view.clipping);
        ++m_views;
        const auto sums = m_level.engine.sums(view, {&m_subject.tf, 1}, &m_level.weights, {job.stop, {}});
        return {camera, m_metric.valueOf(sums[0], m_subject.options)};
    }
    SeenView look(const Vec3& direction, const JobControl& job) { return look(cameraFor(direction), job); }
    int views() const { return m_views; }

private:
    const ViewLevel& m_level;
    const ViewSubject& m_subject;
    const ViewMetric& m_metric;
    int m_views = 0;
};

struct Place {
    Vec3 direction;
    SeenView seen;
};

/// Tries four neighbours, goes to the best, and halves the step where none is better, until it is below `finest` or
/// `moves` have been tried.
Place descend(Judge& judge, const ViewMetric& metric, Place at, double step, double finest, int moves,
              const JobControl& job, const std::function<void()>& tell = {}) {
    for (int move = 0; step >= finest && move < moves; ++move) {
        Place best = at;
        for (int side = 0; side < 4; ++side) {
            const Vec3 direction = moved(at.direction, step, side * kPi / 2 + (move % 2) * kPi / 4);
            Place next{direction, judge.look(direction, job)};
            if (metric.isBetter(next.seen.value, best.seen.value)) best = next;
            if (tell) tell();
        }
        if (best.direction == at.direction) step /= 2;
        at = best;
    }
    return at;
}

/// Indices of directions none of whose neighbours is better, the best first.
std::vector<std::size_t> valleysOf(const ViewMap& map) {
    const double reach = std::cos(1.5 * spacingOf(map.directions.size()));
    std::vector<std::size_t> valleys;
    for (std::size_t i = 0; i < map.directions.size(); ++i) {
        bool least = true;
        for (std::size_t j = 0; least && j < map.directions.size(); ++j)
            least = j == i || glm::dot(map.directions[i], map.directions[j]) < reach ||
                    !map.metric.isBetter(map.values[j], map.values[i]);
        if (least) valleys.push_back(i);
    }
    std::stable_sort(valleys.begin(), valleys.end(),
                     [&](std::size_t a, std::size_t b) { return map.metric.isBetter(map.values[a], map.values[b]); });
    return valleys;
}

void validate(const ViewSubject& subject, const ViewMetric& metric) {
    const std::size_t features = subject.tf.features.size();
    if (metric.figure == ViewMetric::Figure::Objective) {
        normalizedTargets(metric.targets, features);
    } else if (metric.feature >= features) {
        throw UsageError("there is no such feature", "views", "choose one of the transfer function's");
    }
}

} // namespace

std::vector<Vec3> spreadDirections(int count) {
    if (count < 1 || count > kMostSphereViews)
        throw UsageError("the number of views is not from 1 to " + std::to_string(kMostSphereViews), "views",
                         "correct it");
    const auto n = static_cast<std::size_t>(count);
    std::vector<Vec3> lattice(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(n);
        const double turn = 2 * kPi * std::fmod(static_cast<double>(i) / std::numbers::phi, 1.0);
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        lattice[i] = {r * std::cos(turn), r * std::sin(turn), z};
    }
    // Each next one is the one farthest from all before it.
    std::vector<Vec3> ordered;
    std::vector<double> nearest(n, -2); // cosine of the angle to the nearest one taken
    std::size_t next = 0;
    for (std::size_t taken = 0; taken < n; ++taken) {
        ordered.push_back(lattice[next]);
        nearest[next] = 2;
        std::size_t farthest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            nearest[i] = std::max(nearest[i], glm::dot(lattice[i], ordered.back()));
            if (nearest[i] < nearest[farthest]) farthest = i;
        }
        next = farthest;
    }
    return ordered;
}

const char* name(ViewMetric::Figure figure) {
    switch (figure) {
    case ViewMetric::Figure::Objective:
        return "objective";
    case ViewMetric::Figure::Vws:
        return "vws";
    case ViewMetric::Figure::Visibility:
        return "visibility";
    }
    return "";
}

double ViewMetric::valueOf(const FeatureSums& sums, const VwsOptions& options) const {
    switch (figure) {
    case Figure::Objective:
        return objectiveOf(vwsOf(sums, options), targets);
    case Figure::Vws:
        return vwsOf(sums, options)[feature];
    case Figure::Visibility:
        return sums.allVisibility > 0 ? sums.visibility[feature] / sums.allVisibility : 0;
    }
    return 0;
}

std::size_t ViewMap::best() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < values.size(); ++i)
        if (metric.isBetter(values[i], values[best])) best = i;
    return best;
}

std::size_t ViewMap::worst() const {
    std::size_t worst = 0;
    for (std::size_t i = 1; i < values.size(); ++i)
        if (metric.isBetter(values[worst], values[i])) worst = i;
    return worst;
}

double ViewMap::interpolated(const Vec3& direction) const {
    // Shepard's average, local as Franke and Little have it: weights ((R − d)/(R·d))² within the radius R, 0 beyond.
    // The nearest one is within 0.7 spacings, so that one at least has weight.
    const double radius = 1.6 * spacingOf(values.size()), least = std::cos(std::min(kPi, radius));
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (glm::dot(direction, directions[i]) <= least) continue;
        const double distance = angleBetween(direction, directions[i]);
        if (distance < 1e-9) return values[i];
        const double weight = std::pow((radius - distance) / (radius * distance), 2);
        sum += weight * values[i];
        weights += weight;
    }
    if (weights > 0) return sum / weights;
    double nearest = -2, value = 0; // a map that is still growing
    for (std::size_t i = 0; i < values.size(); ++i)
        if (const double near = glm::dot(direction, directions[i]); near > nearest) {
            nearest = near;
            value = values[i];
        }
    return value;
}

ViewSearch searchViews(const ViewLevel& level, const ViewSubject& subject, const ViewMetric& metric, int count,
                       const JobControl& job, const std::function<void(const ViewMap&)>& watch) {
    validate(subject, metric);
    Judge judge(level, subject, metric);
    ViewSearch result;
    ViewMap& map = result.map;
    map.metric = metric;

    constexpr double kMapShare = 0.8; // of the work; how much comes after the map is not known before
    const std::vector<Vec3> directions = spreadDirections(count);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        map.values.push_back(judge.look(directions[i], job).value);
        map.directions.push_back(directions[i]);
        job.report(kMapShare * static_cast<double>(i + 1) / static_cast<double>(directions.size()));
        if (watch && (map.values.size() % kWatchEvery == 0 || map.values.size() == directions.size())) watch(map);
    }

    std::vector<Place> places;
    std::vector<std::size_t> valleys = valleysOf(map);
    if (valleys.size() > kValleys) valleys.resize(kValleys);
    const double spacing = spacingOf(directions.size());
    for (std::size_t i = 0; i < valleys.size(); ++i) {
        const Place start{directions[valleys[i]], {judge.cameraFor(directions[valleys[i]]), map.values[valleys[i]]}};
        places.push_back(descend(judge, metric, start, spacing / 2, kFinestStep, kMoves, job));
        job.report(kMapShare + (1 - kMapShare) * static_cast<double>(i + 1) / static_cast<double>(valleys.size()));
    }
    std::stable_sort(places.begin(), places.end(),
                     [&](const Place& a, const Place& b) { return metric.isBetter(a.seen.value, b.seen.value); });
    if (places.size() > kFinalists) places.resize(kFinalists);
    for (const Place& place : places) result.finalists.push_back(place.direction);
    result.views = judge.views();
    return result;
}

BestView bestView(const ViewLevel& full, const ViewSubject& subject, const ViewSearch& search, int moves,
                  const JobControl& job) {
    const ViewMetric& metric = search.map.metric;
    validate(subject, metric);
    Judge judge(full, subject, metric);
    const double expected = static_cast<double>(search.finalists.size()) + 2 + 4 * moves;
    const auto tell = [&] { job.report(std::min(1.0, judge.views() / expected)); };

    BestView result;
    result.present = judge.look(subject.view.camera, job);
    Place best{-subject.view.camera.forward(), result.present};
    for (const Vec3& direction : search.finalists) {
        const Place place{direction, judge.look(direction, job)};
        if (metric.isBetter(place.seen.value, best.seen.value)) best = place;
        tell();
    }
    best = descend(judge, metric, best, kFullStep, kFinestStep, moves, job, tell);
    result.best = best.seen;
    result.worst = result.present;
    if (!search.map.isEmpty()) {
        const SeenView worst = judge.look(search.map.directions[search.map.worst()], job);
        if (metric.isBetter(result.worst.value, worst.value)) result.worst = worst;
    }
    result.views = judge.views();
    job.report(1);
    return result;
}

std::vector<ReachableView> reachableViews(const ViewLevel& level, const ViewSubject& subject, const ViewSearch& search,
                                          const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                                          const JobControl& job) {
    const ViewMetric& metric = search.map.metric;
    validate(subject, metric);
    PELLUCID_CHECK(metric.figure == ViewMetric::Figure::Objective);
    const Geometry& geometry = level.engine.volume().geometry();
    OptimizeOptions few = options;
    few.maxIterations = std::min(options.maxIterations, kReachMoves);
    few.coarse = few.restarts = false;

    const auto reach = [&](const Camera& camera) {
        const View view(camera, subject.view.clipping);
        const EngineVws function(level.engine, view, subject.tf, level.weights, subject.options);
        const OptimizeResult found = optimize({function, metric.targets, limits}, few, {job.stop, {}});
        job.throwIfStopped();
        const OptimizeState& best = found.history[found.best];
        const FeatureSums sums = level.engine.sums(view, {&found.tf, 1}, &level.weights, {job.stop, {}})[0];
        return ReachableView{camera, best.opacity, best.objective, sums.allVisibility};
    };

    std::vector<Camera> cameras{subject.view.camera};
    for (const Vec3& direction : search.finalists)
        cameras.push_back(lookingFrom(subject.view.camera, geometry, direction));
    for (int i = 0; i < kReachSpread && i < static_cast<int>(search.map.directions.size()); ++i)
        cameras.push_back(
            lookingFrom(subject.view.camera, geometry, search.map.directions[static_cast<std::size_t>(i)]));
    std::vector<ReachableView> all;
    for (const Camera& camera : cameras) {
        all.push_back(reach(camera));
        job.report(0.9 * static_cast<double>(all.size()) / static_cast<double>(cameras.size()));
    }
    const auto nearest = [&] {
        return *std::min_element(all.begin(), all.end(), [](const ReachableView& a, const ReachableView& b) {
            return a.objective < b.objective;
        });
    };
    // Where targets can be reached they mostly can from everywhere; only elsewhere the exact direction matters.
    double step = 0.5 * spacingOf(static_cast<std::size_t>(kReachSpread));
    for (int round = 0; round < kReachRounds && nearest().objective > kNear; ++round) {
        const ReachableView at = nearest();
        for (int side = 0; side < 4; ++side)
            all.push_back(
                reach(lookingFrom(subject.view.camera, geometry,
                                  moved(-at.camera.forward(), step, side * kPi / 2 + (round % 2) * kPi / 4))));
        if (nearest().camera == at.camera) step /= 2;
        job.report(0.9 + 0.1 * (round + 1) / kReachRounds);
    }
    const double least = std::max(kNear, nearest().objective);
    std::stable_sort(all.begin(), all.end(), [&](const ReachableView& a, const ReachableView& b) {
        const bool nearA = a.objective <= least, nearB = b.objective <= least;
        if (nearA && nearB) return a.seen > b.seen;
        return nearA != nearB ? nearA : a.objective < b.objective;
    });
    job.report(1);
    return all;
}

} // namespace pellucid
