#include "results_json.h"

#include "optimize/answer/visibility_words.h"
#include "optimize/refine/refine_words.h"
#include "render/camera_motion.h"
#include "tf/formats/tf_json.h"

namespace pellucid::cli {

Json jsonFromRefinement(const TransferFunction& before, const RefineResult& r, RefineMethod method,
                        const RefineComparison& comparison, Json priority) {
    const auto changes = opacityChanges(before, r.tf);
    Json told = Json::array();
    for (const OpacityChange& c : changes)
        told.push_back({{"feature", c.feature}, {"before", c.before}, {"after", c.after}});
    return {
        {"command", "refine"},
        {"method", name(method)},
        {"priority", std::move(priority)},
        {"iterations", r.iterations},
        {"energy_before", r.energyBefore},
        {"energy_after", r.energyAfter},
        {"energy_movable_before", r.energyMovableBefore},
        {"energy_movable_after", r.energyMovableAfter},
        {"edges_before", r.edgesBefore},
        {"edges_after", r.edgesAfter},
        {"factors", r.factors},
        {"energy_curve", r.energyCurve},
        {"energy_curve_stride", r.energyCurveStride},
        {"comparison",
         {{"total_opacity", comparison.total}, {"greedy", comparison.greedyEnergy}, {"exact", comparison.exactEnergy}}},
        {"changes", told},
        {"text", changeText(changes)},
        {"tf", Json(jsonFromTf(r.tf))}};
}

void addRemarks(Json& json, const std::optional<PriorityOutcome>& outcome, const std::optional<Darkening>& dark) {
    if (outcome) {
        json["chosen"] = {
            {"name", outcome->name},          {"gained", outcome->gained},          {"value_gain", outcome->valueGain},
            {"part_gain", outcome->partGain}, {"others_gain", outcome->othersGain}, {"text", outcome->text}};
    }
    if (dark) {
        Json help = nullptr;
        if (dark->help == Darkening::Help::Exact) help = {{"method", "exact"}, {"coverage", dark->helped}};
        if (dark->help == Darkening::Help::Stop)
            help = {{"max_iterations", dark->iterations}, {"coverage", dark->helped}};
        json["darkening"] = {{"before", dark->before}, {"after", dark->after}, {"text", darkeningText(*dark)}};
        if (!help.is_null()) json["darkening"]["help"] = std::move(help);
    }
}

Json jsonFromVerdict(const Verdict& verdict, const TransferFunction& tf) {
    Json limits = Json::array(), helps = Json::array();
    for (const ReachLimit& l : verdict.limits)
        limits.push_back(
            {{"feature", tf.features[l.feature].name}, {"reason", name(l.reason)}, {"objective", l.objective}});
    for (const ReachHelp& h : verdict.helps) {
        Json help{{"kind", name(h.kind)}, {"objective", h.objective}};
        if (h.kind == ReachHelp::Kind::Release || h.kind == ReachHelp::Kind::Color)
            help["feature"] = tf.features[h.feature].name;
        if (h.view) help["view"] = {{"azimuth", h.view->azimuth}, {"elevation", h.view->elevation}};
        if (h.color) help["color"] = hexFromRgb(*h.color);
        helps.push_back(std::move(help));
    }
    return {{"objective", verdict.objective}, {"vws", verdict.vws},        {"opacity", verdict.opacity},
            {"limits", std::move(limits)},    {"helps", std::move(helps)}, {"occlusion", verdict.occlusion},
            {"sentences", verdict.sentences}};
}

Json jsonFromOptimization(const OptimizeResult& r, const OptimizeOptions& options) {
    Json j{{"command", "optimize"},
           {"method", name(options.method)},
           {"direction", name(options.direction)},
           {"converged", r.converged()},
           {"stopped", name(r.reason)},
           {"iterations", r.iterations()},
           {"coarse_iterations", r.coarseIterations()},
           {"later_steps", r.laterSteps()},
           {"evaluations", r.evaluations},
           {"spread_starts", r.spreadStarts},
           {"best", r.best},
           {"target", r.targets},
           {"objective", Json::array()},
           {"level", Json::array()},
           {"vws", Json::array()},
           {"opacity", Json::array()},
           {"tf", Json(jsonFromTf(r.tf))}};
    for (const OptimizeState& state : r.history) {
        j["objective"].push_back(state.objective);
        j["level"].push_back(state.level);
        j["vws"].push_back(state.vws);
        j["opacity"].push_back(state.opacity);
    }
    return j;
}

Json jsonFromShares(const SeenShares& shares) {
    return {{"vws", shares.vws},
            {"opacity", shares.opacity},
            {"objective", shares.objective},
            {"coverage", shares.look.coverage},
            {"covers", shares.look.covers}};
}

void addSeen(Json& json, const OptimizeResult& r) {
    const Seen& seen = *r.seen;
    json["coverage"] = seen.coverage.coverage;
    json["covers"] = seen.coverage.covers;
    if (seen.exact) {
        json["exact"] = jsonFromShares(*seen.exact);
        json["exact"]["text"] = keptText(r);
    }
    if (!seen.faint && seen.unseen.empty()) return;
    Json& faint = json["faint"] = {{"picture", seen.faint}, {"features", seen.unseen}, {"text", faintText(r)}};
    if (seen.visible) faint["visible"] = jsonFromShares(*seen.visible);
}

Json jsonFromView(const Camera& camera, const Geometry& geometry) {
    const ViewAngles angles = viewAngles(camera, geometry);
    return {{"view", {{"azimuth", angles.azimuth}, {"elevation", angles.elevation}}},
            {"camera", Json(jsonFromCamera(camera))}};
}

} // namespace pellucid::cli
