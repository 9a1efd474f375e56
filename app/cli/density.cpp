// `density`: pictures from faint to strong in which each feature keeps its share of attention.
#include "commands.h"
#include "optimize/answer/visibility_words.h"
#include "optimize/objective.h"
#include "options/limit_options.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "render/memory_needs.h"
#include "resolve.h"
#include "results_json.h"
#include "session/scene_data.h"
#include "tf/formats/tf_file.h"
#include "tf/shown_tf.h"
#include "tf_notices.h"

namespace pellucid::cli {

namespace {

struct DensityArguments {
    SceneOptions scene;
    LimitOptions limits;
    std::optional<double> coverage;
    std::optional<std::string> outTf;
};

struct DensitySeconds {
    double saliency = 0, curve = 0, total = 0;
};

/// The picture of a coverage that was asked for, with its own figures: between points of the curve they are close to
/// those of the curve, not equal.
DensityPoint chosenPoint(const DensityCurve& curve, double coverage, MeasureInput input, Workspace& workspace,
                         const JobControl& job) {
    DensityPoint point;
    point.opacity = curve.at(coverage);
    input.tf = withShownOpacities(input.tf, point.opacity);
    for (const FeatureMeasures& f : workspace.measure(input, {job.stop, {}}).features) point.vws.push_back(f.vws);
    point.objective = objectiveOf(point.vws, curve.shares);
    point.coverage = workspace.coverage(input, {job.stop, {}});
    return point;
}

std::string textOf(const DensityCurve& curve, const std::optional<DensityPoint>& chosen,
                   const std::vector<std::string>& names, const std::string& engine, const DensitySeconds& seconds) {
    std::vector<std::string> columns{"coverage"};
    for (const std::string& name : names) columns.push_back(name);
    columns.emplace_back("F");
    Table table(columns);
    const auto add = [&](const std::string& label, const std::vector<double>& numbers, const std::string& last) {
        std::vector<std::string> row{label};
        for (const double n : numbers) row.push_back(fixedText(n, 4));
        row.push_back(last);
        table.add(row);
    };
    add("VWS", curve.shares, "");
    for (const DensityPoint& point : curve.points)
        add(fixedText(point.coverage.coverage, 4), point.opacity, fixedText(point.objective, 4));
    if (chosen)
        add("chosen " + fixedText(chosen->coverage.coverage, 4), chosen->opacity, fixedText(chosen->objective, 4));
    return table.text() + (curve.isPoint() ? "limits and locks leave no other picture of these shares\n" : "") +
           "engine " + engine + ": curve " + secondsText(seconds.curve) + " (" + std::to_string(curve.evaluations) +
           " evaluations), saliency " + secondsText(seconds.saliency) + ", total " + secondsText(seconds.total) + "\n";
}

Json jsonOf(const DensityPoint& point) {
    return jsonFromShares({point.opacity, point.vws, point.objective, point.coverage});
}

Answer run(const DensityArguments& o, Progress& progress) {
    const Stopwatch total;
    refuse({{o.outTf && !o.coverage, "no picture is chosen", "--out-tf", "say which one by --coverage, such as 0.5"}});
    const Opened opened = resolve(o.scene, progress, {toMeasure("following"), true});
    const Scene& scene = opened.scene;
    if (scene.tf.features.empty())
        throw Error("the transfer function has no features", "--tf", "give one with features, such as tents:3");
    std::vector<std::string> notices = opened.notices();
    const std::vector<OpacityLimits> limits = o.limits.of(scene);
    const MeasureInput input = measureInput(scene);
    Workspace workspace;
    DensitySeconds seconds;
    const auto [engine, saliencySeconds] = prepare(workspace, input, progress);
    seconds.saliency = saliencySeconds;

    const JobControl job = progress.openPhase("following");
    const Stopwatch watch;
    const DensityCurve curve = workspace.densityCurve(input, limits, job);
    seconds.curve = watch.seconds();
    std::optional<DensityPoint> chosen;
    if (o.coverage) {
        chosen = chosenPoint(curve, *o.coverage, input, workspace, job);
        const double low = curve.faintest().coverage.coverage, high = curve.strongest().coverage.coverage;
        if (*o.coverage < low || *o.coverage > high)
            notices.push_back("pictures with these shares are from " + percentText(low) + " to " + percentText(high) +
                              " opaque; the nearest one was taken");
        if (o.outTf) {
            const TransferFunction tf = withShownOpacities(scene.tf, chosen->opacity);
            addTo(notices, writeTfFile(toWrite(tf, scene, *o.outTf), *o.outTf));
        }
    }
    seconds.total = total.seconds();

    Json json{{"command", "density"}, {"shares", curve.shares}, {"points", Json::array()}};
    for (const DensityPoint& point : curve.points) json["points"].push_back(jsonOf(point));
    if (chosen) json["chosen"] = jsonOf(*chosen);
    json["evaluations"] = curve.evaluations;
    json["engine"] = engine;
    json["volume"] = jsonFromVolume(*input.volume);
    json["seconds"] = {{"saliency", seconds.saliency}, {"curve", seconds.curve}, {"total", seconds.total}};
    addProfile(json, input.settings);
    addMapping(json, scene);
    return {textOf(curve, chosen, namesWithEmpty(scene.tf, *scene.histogram), engine + profileText(input.settings),
                   seconds),
            std::move(json), std::move(notices)};
}

} // namespace

Command addDensity(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "density", "Opacities from faint to strong with which each feature keeps its share of saliency");
    const auto o = std::make_shared<DensityArguments>();
    o->scene.addForFigures(*app);
    o->limits.add(*app);
    addValue(*app, "--coverage", "C", o->coverage, realAbove(0, 1),
             "choose the picture of this coverage: the mean alpha where features are drawn, above 0 to 1");
    addOutputFile(*app, "--out-tf", o->outTf, "write the transfer function of that picture" + std::string(kTfFileHelp));
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
