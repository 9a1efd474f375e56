// The objects of `refine --json` and `optimize --json`.
#include <catch2/catch.hpp>

#include "results_json.h"

using namespace pellucid;

namespace {

std::vector<std::string> keysOf(const cli::Json& j) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : j.items()) keys.push_back(key);
    return keys;
}

} // namespace

TEST_CASE("optimizations have their keys in the order of the manual", "[cli][json]") {
    OptimizeResult r;
    r.tf = tents(3, 0.5);
    r.targets = {0.1, 0.3, 0.6};
    r.history = {{0.5, {0.8, 0.1, 0.1}, {0.5, 0.5, 0.5}}, {0.02, {0.1, 0.3, 0.6}, {0.1, 0.5, 0.9}}};
    r.best = 1;
    r.evaluations = 9;
    r.reason = StopReason::Converged;
    const cli::Json j = cli::jsonFromOptimization(r, {});
    CHECK(keysOf(j) == std::vector<std::string>{"command", "method", "direction", "converged", "stopped", "iterations",
                                                "coarse_iterations", "later_steps", "evaluations", "spread_starts",
                                                "best", "target", "objective", "level", "vws", "opacity", "tf"});
    CHECK(j["command"] == "optimize");
    CHECK(j["method"] == "newton");
    CHECK(j["coarse_iterations"] == 0);
    CHECK(j["best"] == 1);
    CHECK(j["level"] == cli::Json({0, 0}));
    CHECK(j["direction"] == "gradient");
    CHECK(j["converged"] == true);
    CHECK(j["iterations"] == r.iterations());
    CHECK(j["evaluations"] == 9);
    CHECK(j["objective"].size() == r.history.size());
    CHECK(j["vws"][0].size() == 3);
    CHECK(j["opacity"].back() == r.history.back().opacity);
    CHECK(j["target"][2] == 0.6);
    CHECK(j["tf"]["format"] == "pellucid-tf");
}

TEST_CASE("refinements have their keys in the order of the manual", "[cli][json]") {
    RefineResult r;
    r.tf = tents(1);
    r.iterations = 4;
    r.energyBefore = 2;
    r.energyMovableAfter = 0.5;
    r.edgesBefore = {1, 2, 3, 4};
    r.factors = {1, 1, 1, 1, 1};
    r.energyCurve = {2, 1, 0.5};
    TransferFunction before = r.tf;
    before.points[1].opacity = 0.25;
    const cli::Json j =
        cli::jsonFromRefinement(before, r, RefineMethod::Exact, {0.5, 0.2, 0.1, r.tf}, {{"kind", "none"}});
    CHECK(keysOf(j) == std::vector<std::string>{"command", "method", "priority", "iterations", "energy_before",
                                                "energy_after", "energy_movable_before", "energy_movable_after",
                                                "edges_before", "edges_after", "factors", "energy_curve",
                                                "energy_curve_stride", "comparison", "changes", "text", "tf"});
    CHECK(j["method"] == "exact");
    CHECK(j["priority"]["kind"] == "none");
    CHECK(j["comparison"] == cli::Json({{"total_opacity", 0.5}, {"greedy", 0.2}, {"exact", 0.1}}));
    CHECK(j["changes"][0]["before"] == 0.25);
    CHECK(j["text"] == "at 0.5 × 2"); // one feature is told by its points
    CHECK(j["iterations"] == 4);
    CHECK(j["energy_before"] == 2.0);
    CHECK(j["energy_movable_after"] == 0.5);
    CHECK(j["edges_before"].size() == 4);
}
