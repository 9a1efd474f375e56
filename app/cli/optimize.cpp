// `optimize`: the opacities that give each feature its share of attention.
#include <algorithm>

#include "commands.h"
#include "optimize/answer/visibility_words.h"
#include "optimize_report.h"
#include "options/limit_options.h"
#include "options/target_input.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "render/camera_motion.h"
#include "render/memory_needs.h"
#include "resolve.h"
#include "results_json.h"
#include "session/scene_data.h"
#include "session/view_workspace.h"
#include "tf/formats/tf_file.h"
#include "tf/shown_tf.h"
#include "tf_notices.h"

namespace pellucid::cli {

namespace {

struct OptimizeArguments {
    SceneOptions scene;
    SettingOptions<OptimizeOptions> search;
    LimitOptions limits;
    std::optional<TargetInput> targets;
    std::optional<std::string> outTf, outCamera;
    bool requireConverged = false;
    ReportOptions report;
};

struct OptimizeSeconds {
    double saliency = 0, search = 0, total = 0;
};

/// What the answer looks like, where that is not what was asked for.
std::string seenLines(const OptimizeResult& r) {
    std::string text;
    if (const std::string kept = keptText(r); !kept.empty())
        text += kept + " Use --exact-shares for the shares alone.\n";
    if (const std::string faint = faintText(r); !faint.empty())
        text += (r.converged() ? "On target, but faint: " : "Faint: ") + faint + "\n";
    return text;
}

std::string textOf(const OptimizeResult& r, const std::vector<std::string>& names, const std::string& engine,
                   const OptimizeSeconds& seconds) {
    Table table({"feature", "target", "VWS before", "VWS after", "opacity before", "opacity after", "cover"});
    const OptimizeState& start = r.history.front();
    const OptimizeState& best = r.history[r.best];
    for (std::size_t i = 0; i < r.targets.size(); ++i)
        table.add({names[i], fixedText(r.targets[i], 4), fixedText(start.vws[i], 4), fixedText(best.vws[i], 4),
                   fixedText(start.opacity[i], 4), fixedText(best.opacity[i], 4),
                   fixedText(r.seen->coverage.covers[i], 4)});
    const auto later = std::count_if(r.history.end() - r.laterSteps(), r.history.end(),
                                     [](const OptimizeState& s) { return s.level == 0; });
    return table.text() + "coverage " + fixedText(r.seen->coverage.coverage, 4) + "\n" + seenLines(r) + "objective " +
           plainText(start.objective) + " -> " + plainText(best.objective) + ", " + name(r.reason) + " after " +
           std::to_string(r.iterations()) + (r.iterations() == 1 ? " move, " : " moves, ") +
           (r.coarseIterations() > 0 ? std::to_string(r.coarseIterations()) + " along rays, " : "") +
           (later > 0 ? std::to_string(later) + " more for the strength of the picture, " : "") +
           std::to_string(r.evaluations) + " evaluations\nengine " + engine + ": search " +
           secondsText(seconds.search) + ", saliency " + secondsText(seconds.saliency) + ", total " +
           secondsText(seconds.total) + "\n";
}

Json jsonOf(const OptimizeResult& r, const OptimizeOptions& options, const Volume& volume, const std::string& engine,
            const OptimizeSeconds& seconds) {
    Json json = jsonFromOptimization(r, options);
    addSeen(json, r);
    json["engine"] = engine;
    json["volume"] = jsonFromVolume(volume);
    json["seconds"] = {{"saliency", seconds.saliency}, {"search", seconds.search}, {"total", seconds.total}};
    return json;
}

std::optional<Error> failureOf(const OptimizeArguments& o, const OptimizeOptions& options, const OptimizeResult& r) {
    if (!o.requireConverged || r.converged()) return {};
    return Error("the targets were not reached (" + offTargetText(r.history[r.best].objective) + ", wanted below " +
                     plainText(100 * options.tolerance) + " %)",
                 std::string(name(r.reason)) + " after " + std::to_string(r.iterations()) +
                     (r.iterations() == 1 ? " move" : " moves"),
                 "raise --max-iterations or --tolerance, or choose other targets");
}

Answer run(const OptimizeArguments& o, Progress& progress) {
    const Stopwatch total;
    o.report.check();
    if (!o.targets && !o.scene.sessionFile) throw isRequired("--target", "optimize");
    const Opened opened = resolve(o.scene, progress, {toMeasure("optimizing"), true});
    Scene scene = opened.scene;
    std::vector<std::string> notices = opened.notices();
    const std::vector<double> targets = targetsOf(o.targets, scene, notices);
    OptimizeOptions options = *scene.session.optimize;
    o.search.applyTo(options);
    const std::vector<OpacityLimits> limits = o.limits.of(scene);
    MeasureInput input = measureInput(scene);
    Workspace workspace;
    const auto [engine, saliencySeconds] = prepare(workspace, input, progress);

    const JobControl job = progress.openPhase("optimizing");
    const auto tell = movesTold(progress);
    const auto known = knownAnswers(*scene.session.runs, normalizedTargets(targets, scene.tf.features.size()));
    OptimizeResult result;
    if (o.scene.camera.best) {
        ViewWorkspace views;
        ViewAndOpacities found =
            optimizeViewAndOpacities(workspace, views, input, targets, limits, options, progress.phase("views"),
                                     [&](const MeasureInput&, const OptimizeState& state) { tell(state); });
        input.view = found.input.view;
        scene.camera = input.view.camera;
        scene.session.camera = scene.camera;
        result = std::move(found.result);
    } else {
        result = workspace.optimize(input, targets, limits, options, job, tell, known);
    }
    if (result.reason == StopReason::Cancelled) throw Cancelled{};
    result.tf = withShownOpacities(scene.tf, result.history[result.best].opacity);
    const OptimizeSeconds seconds{saliencySeconds, workspace.seconds().visibility, total.seconds()};
    if (o.outTf) addTo(notices, writeTfFile(toWrite(result.tf, scene, *o.outTf), *o.outTf));
    if (o.outCamera) writeCamera(input.view.camera, *o.outCamera);
    std::string text =
        textOf(result, namesWithEmpty(scene.tf, *scene.histogram), engine + profileText(input.settings), seconds);
    Json json = jsonOf(result, options, *input.volume, engine, seconds);
    json["empty"] = emptyFeatures(scene.tf, *scene.histogram);
    addProfile(json, input.settings);
    addMapping(json, opened.scene);
    std::vector<std::string> remarks{keptText(result), faintText(result)};
    std::erase(remarks, "");
    if (result.history[result.best].objective >= options.tolerance && result.reason != StopReason::Visible) {
        const Verdict verdict =
            workspace.explain(input, targets, limits, options, result, progress.phase("explaining"), known);
        for (const std::string& sentence : verdict.sentences) text += sentence + "\n";
        json["verdict"] = jsonFromVerdict(verdict, scene.tf);
        remarks.insert(remarks.end(), verdict.sentences.begin(), verdict.sentences.end());
    }
    if (o.scene.camera.best) {
        const ViewAngles angles = viewAngles(input.view.camera, input.volume->geometry());
        text += "view " + fixedText(angles.azimuth, 1) + "," + fixedText(angles.elevation, 1) + " degrees\n";
        json.update(jsonFromView(input.view.camera, input.volume->geometry()));
    }
    Answer answer{std::move(text), std::move(json), std::move(notices), failureOf(o, options, result)};
    RunStart start = runStartOf(scene, options);
    start.limits = limits;
    o.report.write(scene, std::move(start), result, seconds.search, std::move(remarks), workspace, progress, answer);
    return answer;
}

} // namespace

Command addOptimize(CLI::App& program) {
    CLI::App* app =
        program.add_subcommand("optimize", "Finds the opacities that give each feature its target saliency");
    const auto o = std::make_shared<OptimizeArguments>();
    o->scene.camera.mayBeBest = true;
    o->scene.addForFigures(*app);
    addValue(
        *app, "--target", kTargetForms, o->targets, TargetInput::parse,
        "one number for each feature, from 0 on, scaled to sum 1; or all equal, by the value of their peaks, turned "
        "round, or all for one; required unless a session has targets");
    o->search.add(*app);
    o->limits.add(*app);
    addOutputFile(*app, "--out-tf", o->outTf,
                  "write the optimized transfer function (the best one seen)" + std::string(kTfFileHelp));
    o->report.add(*app);
    addOutputFile(*app, "--out-camera", o->outCamera, "write the camera, such as that of --view best");
    app->add_flag("--require-converged", o->requireConverged,
                  "exit with status 1 if the targets are not reached; the answer is written all the same");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
