// What a scene gives a parameter space: a coarser volume, and runs as paths.
#include <catch2/catch.hpp>

#include "session/space_inputs.h"
#include "session/workspace.h"

using namespace pellucid;

namespace {

Scene shells(int size) {
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = size;
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    inputs.tf = "tents:3";
    return openScene(inputs);
}

OptimizeState stateOf(std::vector<double> opacity, std::vector<double> vws) {
    OptimizeState state;
    state.opacity = std::move(opacity);
    state.vws = std::move(vws);
    return state;
}

} // namespace

TEST_CASE("a coarser input keeps lengths, window and place", "[session][space]") {
    const MeasureInput whole = measureInput(shells(33));
    CHECK(coarserInput(whole, 1) == whole);
    const MeasureInput coarse = coarserInput(whole, 2);
    const Geometry &a = whole.volume->geometry(), &b = coarse.volume->geometry();
    CHECK(b.dims == Int3(17)); // ⌈33/2⌉
    CHECK(b.spacing == 2.0 * a.spacing);
    CHECK(b.d0() == a.d0());
    CHECK(coarse.volume->range() == whole.volume->range());
    CHECK(coarse.tf == whole.tf);
    CHECK(coarse.view == whole.view);
    // Its figures are those of the whole, to what halving does to shells some voxels thick.
    Workspace workspace;
    const Measures full = workspace.measure(whole), half = workspace.measure(coarse);
    for (std::size_t f = 0; f < 3; ++f) CHECK(half.features[f].vws == Approx(full.features[f].vws).margin(0.08));
}

TEST_CASE("runs are paths of the features that bear their names", "[session][space]") {
    Run old;
    old.kind = "optimize";
    old.features = {"f2", "f1"}; // another order, and no f3
    old.history = {stateOf({0.2, 0.1}, {0.9, 0.1}), stateOf({0.4, 0.3}, {0.5, 0.5})};
    old.best = 1;
    Run refinement;
    refinement.kind = "refine";
    Run other;
    other.kind = "optimize";
    other.features = {"bone", "f1"};
    other.history = old.history;
    ParameterAxes axes;
    axes.features = {0, 1};
    const auto paths = pathsOfRuns({refinement, other, old}, tents(3), axes);
    REQUIRE(paths.size() == 1); // the others know no f2
    CHECK(paths[0].name == "run 2");
    old.number = 7;
    old.start.edit([](RunStart& start) {
        start.tf = tents(3);
        start.options.method = SearchMethod::Line;
    });
    CHECK(pathsOfRuns({old}, tents(3), axes)[0].name == "run 7, line");
    old.name = "from above";
    CHECK(pathsOfRuns({old}, tents(3), axes)[0].name == "from above");
    CHECK(paths[0].best == 1);
    REQUIRE(paths[0].states.size() == 2);
    CHECK(paths[0].states[1].opacity == std::vector<double>{0.3, 0.4, 0});
    CHECK(paths[0].states[0].vws == std::vector<double>{0.1, 0.9, 0});
    axes.features = {0, 1, 2};
    CHECK(pathsOfRuns({old}, tents(3), axes).empty());
}
