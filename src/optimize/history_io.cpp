#include "optimize/history_io.h"

#include <nlohmann/json.hpp>

#include "tf/formats/tf_json.h"

namespace pellucid {

using nlohmann::json;

json jsonFromRefinement(const RefineResult& r) {
    return {{"command", "refine"},
            {"iterations", r.iterations},
            {"energy_before", r.energyBefore},
            {"energy_after", r.energyAfter},
            {"energy_movable_before", r.energyMovableBefore},
            {"energy_movable_after", r.energyMovableAfter},
            {"edges_before", r.edgesBefore},
            {"edges_after", r.edgesAfter},
            {"tf", jsonFromTf(r.tf)}};
}

json jsonFromOptimization(const OptimizeResult& r, const OptimizeOptions& options) {
    json j = {{"command", "optimize"},        {"method", name(options.method)},
              {"direction", "gradient"},      {"converged", r.converged()},
              {"stopped", name(r.reason)},    {"iterations", r.iterations()},
              {"evaluations", r.evaluations}, {"target", r.targets},
              {"objective", json::array()},   {"vws", json::array()},
              {"opacity", json::array()},     {"tf", jsonFromTf(r.tf)}};
    for (const OptimizeState& state : r.history) {
        j["objective"].push_back(state.objective);
        j["vws"].push_back(state.vws);
        j["opacity"].push_back(state.opacity);
    }
    return j;
}

} // namespace pellucid
