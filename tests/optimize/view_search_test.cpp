// The best view: directions, the map between them, and what is found on scenes whose best view is known.
#include <algorithm>
#include <random>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "optimize/views/view_search.h"
#include "render/cpu/cpu_engine.h"
#include "render/view_direction.h"
#include "saliency/saliency_field.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;

double smallestAngle(const std::vector<Vec3>& directions) {
    double largest = -1;
    for (std::size_t i = 0; i < directions.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) largest = std::max(largest, glm::dot(directions[i], directions[j]));
    return std::acos(std::min(1.0, largest));
}

/// Of what a view is made: a volume, what it shows, and its saliency.
struct Subject {
    std::shared_ptr<const Volume> volume;
    TransferFunction tf;
    std::unique_ptr<VisibilityEngine> engine;
    WeightFields weights;

    Subject(std::shared_ptr<const Volume> v, TransferFunction t)
        : volume(std::move(v)), tf(std::move(t)), engine(makeDraftEngine(volume)),
          weights(saliencyFields(*volume, tf)) {}
    ViewLevel level() const { return {*engine, weights}; }
    ViewSubject from(const Camera& camera) const { return {View(camera), tf, {}}; }
    Camera home() const { return homeCamera(volume->geometry(), Projection::Perspective); }
};

/// A box of intensity 0.75 in the middle, and an opaque plate of 0.25 that hides it from the side of low x.
Subject boxBehindPlate() {
    const auto volume = volumeFrom(geometryOf(Int3(28)), [](int i, int j, int k) {
        const auto inside = [](int v, int lo, int hi) { return v >= lo && v < hi; };
        if (inside(i, 11, 17) && inside(j, 11, 17) && inside(k, 11, 17)) return 0.75;
        return inside(i, 5, 8) && inside(j, 2, 26) && inside(k, 2, 26) ? 0.25 : 0.0;
    });
    TransferFunction tf;
    tf.points = {{0.1, 0, {0, 1, 0}, false, {}},    {0.15, 0.9, {0, 1, 0}, false, {}},
                 {0.35, 0.9, {0, 1, 0}, false, {}}, {0.4, 0, {1, 0, 0}, false, {}},
                 {0.6, 0, {1, 0, 0}, false, {}},    {0.65, 0.9, {1, 0, 0}, false, {}},
                 {0.85, 0.9, {1, 0, 0}, false, {}}, {0.9, 0, {1, 0, 0}, false, {}}};
    tf.features = {{"plate", 0.1, 0.4, {0, 1, 0}, {}}, {"box", 0.6, 0.9, {1, 0, 0}, {}}};
    return {volume, tf};
}

/// Unit vectors, evenly likely.
std::vector<Vec3> randomDirections(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Vec3> all;
    for (int i = 0; i < count; ++i) {
        const double x = normal(random), y = normal(random), z = normal(random);
        all.push_back(glm::normalize(Vec3(x, y, z)));
    }
    return all;
}

double valueFrom(const Subject& s, const Camera& camera, const ViewMetric& metric) {
    return metric.valueOf(s.engine->sums(View(camera), {&s.tf, 1}, &s.weights)[0], {});
}

} // namespace

TEST_CASE("directions are spread evenly, from coarse to fine", "[views]") {
    for (const int count : {1, 16, 256, 1000}) {
        const std::vector<Vec3> all = spreadDirections(count);
        INFO(count);
        REQUIRE(all.size() == static_cast<std::size_t>(count));
        for (const Vec3& d : all) CHECK(glm::length(d) == Approx(1));
        CHECK(all == spreadDirections(count));
    }
    // Neighbours of an even hexagonal lattice of N points on the unit sphere lie √(8π/(√3·N)) apart; a Fibonacci
    // lattice keeps 0.8 of that at least (0.94·√(4π/(N·…)) near the poles). 256: 0.238, in degrees 13.6.
    const std::vector<Vec3> all = spreadDirections(256);
    CHECK(smallestAngle(all) > 0.75 * 0.238);
    // The mean of an even spread is 0.
    Vec3 mean(0);
    for (const Vec3& d : all) mean += d / 256.0;
    CHECK(glm::length(mean) < 0.01);
    // Its first 32 alone: each is the farthest from those before it, which keeps them at least half as far apart as
    // 32 even ones (0.673), and leaves no place farther than that from all of them.
    const std::vector<Vec3> first(all.begin(), all.begin() + 32);
    CHECK(smallestAngle(first) > 0.5 * 0.673);
    for (const Vec3& d : randomDirections(500, 1)) {
        double nearest = -1;
        for (const Vec3& f : first) nearest = std::max(nearest, glm::dot(d, f));
        CHECK(std::acos(nearest) < 0.673);
    }
    CHECK_THROWS_AS(spreadDirections(0), UsageError);
    CHECK_THROWS_AS(spreadDirections(kMostSphereViews + 1), UsageError);
}

TEST_CASE("a map is the value itself in its directions, and between them of what is around", "[views]") {
    ViewMap map;
    map.metric.figure = ViewMetric::Figure::Vws;
    CHECK(map.interpolated({0, 0, 1}) == 0);
    map.directions = spreadDirections(256);
    for (const Vec3& d : map.directions) map.values.push_back(0.5 + 0.5 * d.x); // smooth, 0 to 1
    for (std::size_t i = 0; i < map.values.size(); ++i)
        CHECK(map.interpolated(map.directions[i]) == Approx(map.values[i]).margin(1e-6));
    // Averages of values at most 1.6 spacings (0.38) off: 0.5·0.38 at worst, and far less where they surround it.
    double worst = 0, square = 0;
    const std::vector<Vec3> places = randomDirections(400, 2);
    for (const Vec3& d : places) {
        const double off = std::abs(map.interpolated(d) - (0.5 + 0.5 * d.x));
        worst = std::max(worst, off);
        square += off * off / static_cast<double>(places.size());
    }
    CHECK(worst < 0.06);
    CHECK(std::sqrt(square) < 0.02);
    CHECK(map.directions[map.best()].x > 0.98);
    CHECK(map.directions[map.worst()].x < -0.98);
    map.metric.figure = ViewMetric::Figure::Objective; // now less is better
    CHECK(map.directions[map.best()].x < -0.98);
}

TEST_CASE("a camera looks from a direction at what it looked at before", "[views]") {
    const Geometry geometry = geometryOf({20, 30, 40});
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        const Camera camera = panned(homeCamera(geometry, projection), geometry, 10, 5, 100);
        for (const Vec3& d : spreadDirections(16)) {
            const Camera seen = lookingFrom(camera, geometry, d);
            CHECK(seen.center == camera.center);
            CHECK(glm::length(-seen.forward() - d) < 1e-9);
            CHECK(seen.projection == projection);
            CHECK(seen.trueUp().z >= 0);
            CHECK_NOTHROW(seen.validate(geometry, "test"));
        }
        for (const double z : {1.0, -1.0}) CHECK_NOTHROW(lookingFrom(camera, geometry, {0, 0, z}).validate("test"));
        CHECK(glm::length(lookingFrom(camera, geometry, -camera.forward()).eye - camera.eye) < 1e-9);
    }
    for (const Vec3& d : spreadDirections(16)) CHECK(glm::length(towardEye(anglesOf(d)) - d) < 1e-9);
}

TEST_CASE("the best view of a hidden box is from its free side", "[views]") {
    const Subject s = boxBehindPlate();
    const Camera hidden = lookingFrom(s.home(), s.volume->geometry(), {-1, 0, 0}); // straight onto the plate
    for (const auto figure : {ViewMetric::Figure::Vws, ViewMetric::Figure::Visibility}) {
        const ViewMetric metric{figure, {}, 1};
        const ViewSearch search = searchViews(s.level(), s.from(hidden), metric, 96);
        const BestView found = bestView(s.level(), s.level(), s.from(hidden), search);
        INFO(name(figure));
        REQUIRE(search.map.values.size() == 96);
        // From there α = 0.9 per voxel and a plate of three leave 1e-3 of the light.
        CHECK(found.present.value < 0.01);
        CHECK(found.worst.value <= found.present.value);
        // Edge-on the plate shows 3·24 voxels of its faces, the box 6·6: a third of all, less by what stands aslant.
        CHECK(found.best.value > 0.15);
        CHECK(found.best.value >= search.map.values[search.map.best()] - 1e-9);
        // The plate is thin: edge-on it shows least. The box is free for every eye on the other side of it.
        const Vec3 toward = -found.best.camera.forward();
        CHECK(toward.x > -0.2);
        CHECK(found.best.value == Approx(valueFrom(s, found.best.camera, metric)));
    }
}

TEST_CASE("the map and its refinement find what 300 random views find", "[views]") {
    const Subject s = boxBehindPlate();
    for (const ViewMetric& metric :
         {ViewMetric{ViewMetric::Figure::Objective, {0.6, 0.4}, 0}, ViewMetric{ViewMetric::Figure::Vws, {}, 0}}) {
        const ViewSearch search = searchViews(s.level(), s.from(s.home()), metric, 128);
        const BestView found = bestView(s.level(), s.level(), s.from(s.home()), search);
        double best = metric.figure == ViewMetric::Figure::Objective ? 1 : 0;
        for (const Vec3& d : randomDirections(300, 3)) {
            const double value = valueFrom(s, lookingFrom(s.home(), s.volume->geometry(), d), metric);
            if (metric.isBetter(value, best)) best = value;
        }
        INFO(name(metric.figure));
        const double sign = metric.figure == ViewMetric::Figure::Objective ? -1 : 1; // the more the better
        CHECK(sign * found.best.value >= sign * best - 0.01);
        CHECK(sign * found.best.value >= sign * found.present.value);
        CHECK(sign * found.present.value >= sign * found.worst.value);
    }
}

TEST_CASE("views do not depend on the number of threads", "[views]") {
    const auto search = [](int threads) {
        setThreadCount(threads);
        const Subject s = boxBehindPlate();
        const ViewMetric metric{ViewMetric::Figure::Vws, {}, 1};
        const ViewSearch found = searchViews(s.level(), s.from(s.home()), metric, 48);
        const Camera best = bestView(s.level(), s.level(), s.from(s.home()), found).best.camera;
        setThreadCount(0);
        return std::pair{found.map.values, best};
    };
    CHECK(search(1) == search(3));
}

TEST_CASE("a search of views tells how far it is, grows its map and stops when asked to", "[views]") {
    const Subject s = boxBehindPlate();
    const ViewMetric metric{ViewMetric::Figure::Vws, {}, 1};
    std::vector<std::size_t> sizes;
    double told = 0;
    JobControl job;
    job.progress = [&](double fraction) {
        CHECK(fraction >= told);
        told = fraction;
    };
    searchViews(s.level(), s.from(s.home()), metric, 40, job,
                [&](const ViewMap& map) { sizes.push_back(map.values.size()); });
    CHECK(sizes == std::vector<std::size_t>{16, 32, 40});
    CHECK(told == 1);

    std::stop_source stop;
    const auto watch = [&](const ViewMap&) { stop.request_stop(); };
    CHECK_THROWS_AS(searchViews(s.level(), s.from(s.home()), metric, 40, {stop.get_token(), {}}, watch), Cancelled);
    CHECK_THROWS_AS(searchViews(s.level(), s.from(s.home()), {ViewMetric::Figure::Vws, {}, 2}, 40), UsageError);
    CHECK_THROWS_AS(searchViews(s.level(), s.from(s.home()), {ViewMetric::Figure::Objective, {1}, 0}, 40), UsageError);
}

TEST_CASE("of views that reach the targets the one with the most to see comes first", "[views]") {
    const Subject s = boxBehindPlate();
    const Camera hidden = lookingFrom(s.home(), s.volume->geometry(), {-1, 0, 0}); // straight onto the plate
    const ViewMetric metric{ViewMetric::Figure::Objective, {0.5, 0.5}, 0};
    const ViewSearch search = searchViews(s.level(), s.from(hidden), metric, 64);
    OptimizeOptions options;
    options.tolerance = 0.001;
    const std::vector<ReachableView> all = reachableViews(s.level(), s.from(hidden), search, {}, options);
    REQUIRE(all.size() > 4);
    // A thin plate and a dense box have equal shares from everywhere.
    CHECK(all.front().objective < 0.005);
    for (const ReachableView& v : all) {
        const bool near = v.objective <= 0.005;
        CHECK((!near || v.seen <= all.front().seen));
        // What it says of itself is true.
        const TransferFunction tf = withFeatureOpacities(s.tf, v.opacity);
        const FeatureSums sums = s.engine->sums(View(v.camera), {&tf, 1}, &s.weights)[0];
        CHECK(metric.valueOf(sums, {}) == Approx(v.objective).margin(1e-6));
        CHECK(sums.allVisibility == Approx(v.seen));
    }
    CHECK(std::any_of(all.begin(), all.end(), [&](const ReachableView& v) { return v.camera == hidden; }));
}

TEST_CASE("targets are reached by turning the view where opacities alone cannot", "[views]") {
    // Straight onto the plate nothing is seen of the box while the plate keeps its opacity: W = (1, 0), and F = 0.2 for
    // the targets (0.8, 0.2), of which only 1e-3 of the light leaks. From its free side the box has what it needs.
    const Subject s = boxBehindPlate();
    const Camera hidden = lookingFrom(s.home(), s.volume->geometry(), {-1, 0, 0});
    const ViewMetric metric{ViewMetric::Figure::Objective, {0.8, 0.2}, 0};
    const ViewSearch search = searchViews(s.level(), s.from(hidden), metric, 64);
    const std::vector<OpacityLimits> limits{{0, 1, true}, {}};
    const std::vector<ReachableView> all = reachableViews(s.level(), s.from(hidden), search, limits, {});
    CHECK(all.front().objective < 0.03);
    CHECK(all.front().opacity[0] == Approx(0.9));
    CHECK((-all.front().camera.forward()).x > -0.5);
    const auto present =
        std::find_if(all.begin(), all.end(), [&](const ReachableView& v) { return v.camera == hidden; });
    REQUIRE(present != all.end());
    CHECK(present->objective == Approx(0.2).margin(0.01));
}
