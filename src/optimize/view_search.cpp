#include "optimize/view_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "base/error.h"
#include "optimize/objective.h"
#include "render/camera_motion.h"

namespace pellucid {

namespace {

constexpr double kPi = std::numbers::pi;

constexpr int kValleys = 6;             ///< best places of the map that are followed between its directions
constexpr int kFinalists = 4;           ///< of them, measured on the full volume
constexpr int kMoves = 24;              ///< of each, at most
constexpr double kFinestStep = 0.5;     ///< degrees, of the steps on the coarse volume
constexpr double kFullStep = 4.0;       ///< degrees, of the first steps on the full volume
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
              const JobControl& job) {
    for (int move = 0; step >= finest && move < moves; ++move) {
        Place best = at;
        for (int side = 0; side < 4; ++side) {
            const Vec3 direction = moved(at.direction, step, side * kPi / 2 + (move % 2) * kPi / 4);
            Place next{direction, judge.look(direction, job)};
            if (metric.isBetter(next.seen.value, best.seen.value)) best = next;
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

ViewSearchResult searchViews(const ViewLevel& coarse, const ViewLevel& full, const ViewSubject& subject,
                             const ViewMetric& metric, const ViewSearchOptions& options, const JobControl& job,
                             const std::function<void(const ViewMap&)>& watch) {
    validate(subject, metric);
    Judge rough(coarse, subject, metric), exact(full, subject, metric);
    const bool sameLevel = &coarse.engine == &full.engine;
    ViewSearchResult result;
    ViewMap& map = result.map;
    map.metric = metric;

    // The share of the map in all that is to be done; what comes after it is known only roughly.
    constexpr double kMapShare = 0.7;
    const std::vector<Vec3> directions = spreadDirections(options.count);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        map.values.push_back(rough.look(directions[i], job).value);
        map.directions.push_back(directions[i]);
        job.report(kMapShare * static_cast<double>(i + 1) / static_cast<double>(directions.size()));
        if (watch && (map.values.size() % kWatchEvery == 0 || map.values.size() == directions.size())) watch(map);
    }

    std::vector<Place> places;
    std::vector<std::size_t> valleys = valleysOf(map);
    if (valleys.size() > kValleys) valleys.resize(kValleys);
    const double spacing = spacingOf(directions.size()), finest = kFinestStep * kPi / 180;
    for (std::size_t i = 0; i < valleys.size(); ++i) {
        const Vec3 direction = directions[valleys[i]];
        Place place{direction, {rough.cameraFor(direction), map.values[valleys[i]]}};
        if (options.refinements > 0) place = descend(rough, metric, place, spacing / 2, finest, kMoves, job);
        places.push_back(std::move(place));
        job.report(kMapShare + 0.15 * static_cast<double>(i + 1) / static_cast<double>(valleys.size()));
    }
    std::stable_sort(places.begin(), places.end(),
                     [&](const Place& a, const Place& b) { return metric.isBetter(a.seen.value, b.seen.value); });
    if (places.size() > kFinalists) places.resize(kFinalists);

    // The last word has the full volume.
    result.present = exact.look(subject.view.camera, job);
    result.worst = exact.look(map.directions[map.worst()], job);
    Place best{-subject.view.camera.forward(), result.present};
    for (Place& place : places) {
        if (!sameLevel) place.seen = exact.look(place.seen.camera, job);
        if (metric.isBetter(place.seen.value, best.seen.value)) best = place;
    }
    job.report(0.93);
    if (!sameLevel) best = descend(exact, metric, best, kFullStep * kPi / 180, finest, options.refinements, job);
    result.best = best.seen;
    if (metric.isBetter(result.worst.value, result.present.value)) result.worst = result.present;
    result.views = rough.views();
    result.fullViews = exact.views();
    job.report(1);
    return result;
}

} // namespace pellucid
