// Views on coarse copies of volumes, and what they are worth on the volumes themselves.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>
#include <sstream>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/stopwatch.h"
#include "optimize/objective.h"
#include "render/view_direction.h"
#include "session/view_workspace.h"
#include "volume/excerpt.h"

using namespace pellucid;

namespace {

MeasureInput inputOf(const std::string& path, int sampleSize, const std::string& tf) {
    SceneInputs in;
    VolumeSource source;
    source.path = path;
    source.sampleSize = sampleSize;
    in.session = sessionOf(source);
    in.tf = tf;
    in.session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    return measureInput(openScene(in));
}

ViewMetric equalTargets(const MeasureInput& input) {
    ViewMetric metric;
    metric.targets.assign(input.tf.features.size(), 1.0 / static_cast<double>(input.tf.features.size()));
    return metric;
}

} // namespace

TEST_CASE("volumes are coarse enough for hundreds of views", "[views]") {
    CHECK(coarseningForViews({41, 41, 41}) == 1);
    CHECK(coarseningForViews({151, 151, 153}) == 1);    // 3 488 553 voxels
    CHECK(coarseningForViews({379, 229, 305}) == 2);    // 26 million; halved 3.3 million
    CHECK(coarseningForViews({1, 1, 4'000'000}) == 2);  // an axis of one voxel stays
    CHECK(coarseningForViews({1024, 1024, 1024}) == 7); // 147³ voxels, 3.2 million; by six 5.0
}

TEST_CASE("a coarser copy keeps place, window and reference length", "[views]") {
    const MeasureInput input = inputOf("sample:shells", 31, "tents:3:0.2");
    const Volume coarse = coarserCopy(*input.volume, 2);
    CHECK(coarse.dims() == Int3(16));
    CHECK(coarse.range() == input.volume->range());
    CHECK(coarse.geometry().spacing == 2.0 * input.volume->geometry().spacing);
    CHECK(coarse.geometry().d0() == input.volume->geometry().d0());
    // The first centre lies amid the first eight, half a voxel further in.
    CHECK(glm::length(coarse.geometry().origin - input.volume->geometry().worldFromVoxel(Vec3(0.5))) < 1e-12);
    CHECK(coarserCopy(coarse, 2).geometry().d0() == input.volume->geometry().d0());
}

TEST_CASE("a search of views does not depend on what was searched before", "[views]") {
    const MeasureInput first = inputOf("sample:shells", 20, "tents:3:0.2");
    MeasureInput other = inputOf("sample:disks", 16, "tents:2:0.4");
    MeasureInput recoloured = first;
    for (ControlPoint& p : recoloured.tf.points) p.color = {p.color.b, p.color.r, 0.5};
    ViewWorkspace used;
    used.search(other, equalTargets(other), 16);
    used.search(recoloured, equalTargets(recoloured), 16);
    const ViewSearch again = used.search(first, equalTargets(first), 16);
    const ViewSearch fresh = ViewWorkspace().search(first, equalTargets(first), 16);
    CHECK(again.map.values == fresh.map.values);
    CHECK(again.figures == fresh.figures);
    other.settings.profile = Profile::Published;
    CHECK_THROWS_AS(used.search(other, equalTargets(other), 16), UsageError);
}

TEST_CASE("view and opacities together come nearer than either", "[views]") {
    const MeasureInput input = inputOf("sample:shells", 24, "tents:3:0.6");
    const std::vector<double> targets{0.2, 0.3, 0.5};
    Workspace workspace;
    ViewWorkspace views;
    std::size_t moves = 0;
    const ViewAndOpacities found = optimizeViewAndOpacities(
        workspace, views, input, targets, {}, {}, {}, [&](const MeasureInput&, const OptimizeState&) { ++moves; });
    const OptimizeResult here = workspace.optimize(input, targets, {}, {});
    const auto objective = [](const OptimizeResult& r) { return r.history[r.best].objective; };
    CHECK(objective(found.result) <= std::max(objective(here), OptimizeOptions{}.tolerance));
    CHECK(moves >= found.result.history.size());
    CHECK(found.views > kSphereViews);
    // It is true of the view that it names.
    MeasureInput there = found.input;
    there.tf = withFeatureOpacities(there.tf, found.result.history[found.result.best].opacity);
    const Measures measures = workspace.measure(there);
    std::vector<double> vws;
    for (const FeatureMeasures& f : measures.features) vws.push_back(f.vws);
    CHECK(objectiveOf(vws, targets) == Approx(objective(found.result)).margin(1e-6));
}

// By hand, some minutes: PELLUCID_VOLUMES="tooth.mhd sample:shells …" PELLUCID_RANDOM_VIEWS=2000 test_session
// "[.acceptance]". The best view against random ones, each on the volume itself.
TEST_CASE("the best view is within 0.01 of the best of many random ones", "[.acceptance]") {
    const char* named = std::getenv("PELLUCID_VOLUMES");
    const char* many = std::getenv("PELLUCID_RANDOM_VIEWS");
    std::istringstream names(named ? named : "sample:shells sample:disks");
    const int count = many ? std::atoi(many) : 200;
    for (std::string name; names >> name;)
        for (const char* tf : {"tents:3", "auto"}) {
            const MeasureInput input = inputOf(name, 96, tf);
            ViewMetric metric = equalTargets(input);
            for (std::size_t i = 0; i < metric.targets.size(); ++i) metric.targets[i] = static_cast<double>(i + 1);
            metric.targets = normalizedTargets(metric.targets, metric.targets.size());
            Workspace workspace;
            ViewWorkspace views;
            const Stopwatch mapTime;
            const ViewSearch search = views.search(input, metric);
            const double mapSeconds = mapTime.seconds();
            workspace.weights(input);
            const Stopwatch bestTime;
            const BestView found = views.best(workspace, input, search);
            const double bestSeconds = bestTime.seconds();
            std::mt19937 random(7);
            std::normal_distribution<double> normal;
            double best = 1, off = 0;
            for (int i = 0; i < count; ++i) {
                const double x = normal(random), y = normal(random), z = normal(random);
                const Vec3 toward = glm::normalize(Vec3(x, y, z));
                const View view(lookingFrom(input.view.camera, input.volume->geometry(), toward));
                const FeatureSums sums =
                    workspace.engine(input).sums(view, {&input.tf, 1}, &workspace.weights(input))[0];
                const double value = metric.valueOf(sums, input.settings.vws);
                best = std::min(best, value);
                off = std::max(off, std::abs(value - found.map.interpolated(toward)));
            }
            std::cout << name << ' ' << tf << ": best " << found.best.value << ", of " << count << " random " << best
                      << ", present " << found.present.value << ", worst " << found.worst.value << ", map off by "
                      << off << ", " << mapSeconds << " s + " << bestSeconds << " s (" << found.coarseViews << " + "
                      << found.views << " views)" << std::endl;
            CHECK(found.best.value <= best + 0.01);
        }
}
