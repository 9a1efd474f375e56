#include "optimize/views/view_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "base/check.h"
#include "base/error.h"
#include "optimize/objective.h"
#include "render/view_direction.h"

namespace pellucid {

namespace {

constexpr double kPi = std::numbers::pi;

constexpr int kAnchors = 12; ///< directions that tell how the full volume differs from the coarse one
constexpr int kValleys = 6;  ///< best places of the map, measured on the full volume
constexpr int kFollowed = 3; ///< the best of them, from which it goes on
constexpr int kRounds = 3;   ///< of each: down on the coarse volume, then a look at the full one
constexpr int kMoves = 8;    ///< of each round, at most, four views each
constexpr double kFinestStep = 1.0 * kPi / 180; ///< radians, of these moves
constexpr double kNoMatter = 0.0005;            ///< of a value
constexpr double kReached = 0.001;              ///< F: nothing is to be gained any more

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

/// Figures of directions on one level.
class Judge {
public:
    Judge(const ViewLevel& level, const ViewSubject& subject, const ViewMetric& metric, const JobControl& job)
        : m_level(level), m_subject(subject), m_metric(metric), m_stop{job.stop, {}} {}

    Camera cameraFor(const Vec3& direction) const {
        return lookingFrom(m_subject.view.camera, m_level.engine.volume().geometry(), direction);
    }
    std::vector<double> look(const Camera& camera) {
        ++m_views;
        const View view(camera, m_subject.view.clipping);
        return m_metric.figuresOf(m_level.engine.sums(view, {&m_subject.tf, 1}, &m_level.weights, m_stop)[0],
                                  m_subject.options);
    }
    std::vector<double> look(const Vec3& direction) { return look(cameraFor(direction)); }
    int views() const { return m_views; }

private:
    const ViewLevel& m_level;
    const ViewSubject& m_subject;
    const ViewMetric& m_metric;
    JobControl m_stop;
    int m_views = 0;
};

/// A direction and what it is worth.
struct Place {
    Vec3 direction;
    double value = 0;
};

std::vector<double> sumOf(std::vector<double> a, const std::vector<double>& b, double sign = 1) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += sign * b[i];
    return a;
}

/// Tries four neighbours, goes to the best, and halves the step where none is better, until it is below kFinestStep or
/// kMoves have been made.
template <class Value>
Place descend(const Value& value, const ViewMetric& metric, Place at, double step) {
    for (int move = 0; step >= kFinestStep && move < kMoves; ++move) {
        Place best = at;
        for (int side = 0; side < 4; ++side) {
            const Vec3 direction = moved(at.direction, step, side * kPi / 2 + (move % 2) * kPi / 4);
            const Place next{direction, value(direction)};
            if (metric.isBetter(next.value, best.value)) best = next;
        }
        if (best.direction == at.direction) step /= 2;
        at = best;
    }
    return at;
}

/// Indices of directions none of whose neighbours is better, the best first, kValleys at most.
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
    const auto better = [&](double a, double b) { return map.metric.isBetter(a, b); };
    std::ranges::stable_sort(valleys, better, [&](std::size_t i) { return map.values[i]; });
    if (valleys.size() > kValleys) valleys.resize(kValleys);
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

std::vector<double> ViewMetric::figuresOf(const FeatureSums& sums, const VwsOptions& options) const {
    if (figure != Figure::Visibility) return vwsOf(sums, options);
    std::vector<double> shares = sums.visibility;
    for (double& share : shares) share = sums.allVisibility > 0 ? share / sums.allVisibility : 0;
    return shares;
}

double ViewMetric::valueOf(const std::vector<double>& figures) const {
    return figure == Figure::Objective ? objectiveOf(figures, targets) : std::clamp(figures[feature], 0.0, 1.0);
}

std::size_t ViewMap::best() const {
    const auto better = [&](double a, double b) { return metric.isBetter(a, b); };
    return static_cast<std::size_t>(std::ranges::min_element(values, better) - values.begin());
}

std::size_t ViewMap::worst() const {
    const auto worse = [&](double a, double b) { return metric.isBetter(b, a); };
    return static_cast<std::size_t>(std::ranges::min_element(values, worse) - values.begin());
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
    Judge judge(level, subject, metric, job);
    ViewSearch result;
    ViewMap& map = result.map;
    map.metric = metric;
    const std::vector<Vec3> directions = spreadDirections(count);
    const std::size_t atOnce = kWatchEvery * level.work.parts;
    for (std::size_t first = 0; first < directions.size(); first += atOnce) {
        const auto figures = madeTogether(level.work, std::min(atOnce, directions.size() - first), [&](std::size_t i) {
            job.throwIfStopped();
            job.report(static_cast<double>(first + i) / static_cast<double>(directions.size()));
            return judge.look(directions[first + i]);
        });
        for (const std::vector<double>& of : figures) {
            map.directions.push_back(directions[map.values.size()]);
            map.values.push_back(metric.valueOf(of));
        }
        result.figures.insert(result.figures.end(), figures.begin(), figures.end());
        if (watch) watch(map);
    }
    job.report(1);
    return result;
}

BestView bestView(const ViewLevel& coarse, const ViewLevel& full, const ViewSubject& subject, const ViewSearch& search,
                  const JobControl& job) {
    const ViewMetric& metric = search.map.metric;
    const std::vector<Vec3>& directions = search.map.directions;
    validate(subject, metric);
    Judge rough(coarse, subject, metric, job), exact(full, subject, metric, job);
    constexpr double kMost = 2 + kAnchors + kValleys + kFollowed * kRounds; // views of the full volume
    BestView result;
    std::optional<Place> best;
    const auto consider = [&](const Place& place, const Camera& camera) {
        if (best && !metric.isBetter(place.value, best->value)) return;
        best = place;
        result.best = {camera, place.value};
    };
    const auto measured = [&](const Vec3& direction) {
        const Camera camera = exact.cameraFor(direction);
        const std::vector<double> figures = exact.look(camera);
        consider({direction, metric.valueOf(figures)}, camera);
        job.report(std::min(1.0, exact.views() / kMost));
        return figures;
    };
    const Camera& present = subject.view.camera;
    result.present = {present, metric.valueOf(exact.look(present))};
    consider({-present.forward(), result.present.value}, present);

    // Means over blocks shift all figures of a view, and those of neighbouring views by nearly as much: the shift is
    // measured in a few directions, and averaged between them.
    std::vector<std::vector<double>> shifts;
    for (std::size_t i = 0; i < std::min<std::size_t>(kAnchors, directions.size()); ++i)
        shifts.push_back(sumOf(measured(directions[i]), search.figures[i], -1));
    result.map = search.map;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        std::vector<double> shift(search.figures[i].size(), 0.0);
        double weights = 0;
        for (std::size_t a = 0; a < shifts.size(); ++a) {
            const double weight = 1 / (std::pow(angleBetween(directions[i], directions[a]), 2) + 1e-4);
            shift = sumOf(std::move(shift), shifts[a], weight);
            weights += weight;
        }
        for (double& v : shift) v /= weights;
        result.map.values[i] = metric.valueOf(sumOf(search.figures[i], shift));
    }

    struct Start {
        Place place;
        std::vector<double> shift;
    };
    std::vector<Start> starts{{{-present.forward(), result.present.value}, {}}};
    for (const std::size_t i : valleysOf(result.map)) {
        const std::vector<double> figures = measured(directions[i]);
        starts.push_back({{directions[i], metric.valueOf(figures)}, sumOf(figures, search.figures[i], -1)});
    }
    std::ranges::stable_sort(
        starts, [&](const Start& a, const Start& b) { return metric.isBetter(a.place.value, b.place.value); });
    if (starts.size() > kFollowed) starts.resize(kFollowed);
    const double spacing = spacingOf(directions.size());
    const auto isReached = [&] { return metric.figure == ViewMetric::Figure::Objective && best->value < kReached; };
    for (Start& start : starts) {
        Place at = start.place;
        if (start.shift.empty()) start.shift = sumOf(exact.look(present), rough.look(at.direction), -1);
        double step = spacing / 2;
        for (int round = 0; round < kRounds && !isReached(); ++round, step /= 2) {
            const Place next = descend([&](const Vec3& d) { return metric.valueOf(sumOf(rough.look(d), start.shift)); },
                                       metric, at, step);
            if (std::abs(next.value - at.value) < kNoMatter) break;
            const std::vector<double> figures = measured(next.direction);
            start.shift = sumOf(figures, rough.look(next.direction), -1);
            at = {next.direction, metric.valueOf(figures)};
        }
    }
    result.worst = result.present;
    if (!result.map.isEmpty()) {
        const Camera camera = exact.cameraFor(directions[result.map.worst()]);
        const SeenView worst{camera, metric.valueOf(exact.look(camera))};
        if (metric.isBetter(result.worst.value, worst.value)) result.worst = worst;
    }
    result.views = exact.views();
    result.coarseViews = static_cast<int>(directions.size()) + rough.views();
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
    for (const std::size_t i : valleysOf(search.map))
        cameras.push_back(lookingFrom(subject.view.camera, geometry, search.map.directions[i]));
    for (int i = 0; i < kReachSpread && i < static_cast<int>(search.map.directions.size()); ++i)
        cameras.push_back(
            lookingFrom(subject.view.camera, geometry, search.map.directions[static_cast<std::size_t>(i)]));
    std::vector<ReachableView> all;
    const auto reachTogether = [&](const std::vector<Camera>& from, double done, double then) {
        const auto found = madeTogether(level.work, from.size(), [&](std::size_t i) {
            const ReachableView view = reach(from[i]);
            job.report(done + (then - done) * static_cast<double>(i + 1) / static_cast<double>(from.size()));
            std::vector<double> figures{view.objective, view.seen};
            figures.insert(figures.end(), view.opacity.begin(), view.opacity.end());
            return figures;
        });
        for (std::size_t i = 0; i < from.size(); ++i)
            all.push_back({from[i], {found[i].begin() + 2, found[i].end()}, found[i][0], found[i][1]});
    };
    reachTogether(cameras, 0, 0.9);
    const auto nearest = [&] { return *std::ranges::min_element(all, {}, &ReachableView::objective); };
    // Where targets can be reached they mostly can from everywhere; only elsewhere the exact direction matters.
    double step = 0.5 * spacingOf(static_cast<std::size_t>(kReachSpread));
    for (int round = 0; round < kReachRounds && nearest().objective > kNear; ++round) {
        const ReachableView at = nearest();
        cameras.clear();
        for (int side = 0; side < 4; ++side)
            cameras.push_back(lookingFrom(subject.view.camera, geometry,
                                          moved(-at.camera.forward(), step, side * kPi / 2 + (round % 2) * kPi / 4)));
        reachTogether(cameras, 0.9 + 0.1 * round / kReachRounds, 0.9 + 0.1 * (round + 1) / kReachRounds);
        if (nearest().camera == at.camera) step /= 2;
    }
    const double least = std::max(kNear, nearest().objective);
    std::ranges::stable_sort(all, [&](const ReachableView& a, const ReachableView& b) {
        const bool nearA = a.objective <= least, nearB = b.objective <= least;
        if (nearA && nearB) return a.seen > b.seen;
        return nearA != nearB ? nearA : a.objective < b.objective;
    });
    job.report(1);
    return all;
}

} // namespace pellucid
