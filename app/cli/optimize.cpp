// `optimize`: the opacities that give each feature its share of attention.
#include "commands.h"
#include "optimize_report.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "render/memory_needs.h"
#include "resolve.h"
#include "results_json.h"
#include "tf/formats/tf_json.h"
#include "tf/shown_tf.h"

namespace pellucid::cli {

namespace {

/// --method, --normalize, --step, --tolerance, --max-iterations: what is not given is as in the session.
struct SearchOptions {
    std::optional<SearchMethod> method;
    bool normalize = false;
    std::optional<double> step, tolerance;
    std::optional<int> maxIterations;

    void add(CLI::App& app);
    OptimizeOptions over(OptimizeOptions options) const {
        options.method = method.value_or(options.method);
        options.normalize = normalize || options.normalize;
        options.step = step.value_or(options.step);
        options.tolerance = tolerance.value_or(options.tolerance);
        options.maxIterations = maxIterations.value_or(options.maxIterations);
        return options;
    }
};

struct Options {
    SceneOptions scene;
    SearchOptions search;
    std::optional<std::vector<double>> targets;
    std::optional<std::string> outTf;
    bool requireConverged = false;
    ReportOptions report;
};

struct Seconds {
    double saliency = 0, search = 0, total = 0;
};

/// What can be told about the targets before their features are known.
std::vector<double> parseTargets(const std::string& text, const std::string& option) {
    auto targets = parseReals(text, option);
    double sum = 0;
    for (const double t : targets) {
        if (t < 0) throw UsageError("the target " + plainText(t) + " is negative", option, "give numbers from 0 on");
        if (t > 1e9) throw UsageError("the target " + plainText(t) + " is too large", option, "only proportions count");
        sum += t;
    }
    if (sum == 0) throw UsageError("all targets are 0", option, "give at least one above 0");
    return targets;
}

std::string textOf(const OptimizeResult& r, const std::string& engine, const Seconds& seconds) {
    Table table({"feature", "target", "VWS before", "VWS after", "opacity before", "opacity after"});
    const OptimizeState& start = r.history.front();
    const OptimizeState& best = r.history[r.best];
    for (std::size_t i = 0; i < r.targets.size(); ++i)
        table.add({r.tf.features[i].name, fixedText(r.targets[i], 4), fixedText(start.vws[i], 4),
                   fixedText(best.vws[i], 4), fixedText(start.opacity[i], 4), fixedText(best.opacity[i], 4)});
    return table.text() + "objective " + plainText(start.objective) + " -> " + plainText(best.objective) + ", " +
           name(r.reason) + " after " + std::to_string(r.iterations()) + " iterations, " +
           std::to_string(r.evaluations) + " evaluations\nengine " + engine + ": search " +
           secondsText(seconds.search) + ", saliency " + secondsText(seconds.saliency) + ", total " +
           secondsText(seconds.total) + "\n";
}

Json jsonOf(const OptimizeResult& r, const OptimizeOptions& options, const Volume& volume, const std::string& engine,
            const Seconds& seconds) {
    Json json = jsonFromOptimization(r, options);
    json["engine"] = engine;
    json["volume"] = jsonFromVolume(volume);
    json["seconds"] = {{"saliency", seconds.saliency}, {"search", seconds.search}, {"total", seconds.total}};
    return json;
}

std::optional<Error> failureOf(const Options& o, const OptimizeOptions& options, const OptimizeResult& r) {
    if (!o.requireConverged || r.converged()) return {};
    return Error("the targets were not reached (objective " + plainText(r.history[r.best].objective) +
                     ", wanted below " + plainText(options.tolerance) + ")",
                 std::string(name(r.reason)) + " after " + std::to_string(r.iterations()) + " iterations",
                 "raise --max-iterations or --tolerance, or choose other targets");
}

Answer run(const Options& o, Progress& progress) {
    const Stopwatch total;
    if (o.outTf) checkOutputFile(*o.outTf, "--out-tf", inputFiles(o.scene));
    o.report.check(o.scene);
    if (!o.targets && !o.scene.session.file)
        throw UsageError("--target is required", "pellucid-cli optimize", "see pellucid-cli optimize --help");
    const Opened opened = resolve(o.scene, progress, {toMeasure("optimizing"), true});
    const Scene& scene = opened.scene;
    const std::vector<double> named = o.targets.value_or(scene.targets());
    atOption("--target", [&] { return normalizedTargets(named, scene.tf.features.size()); });
    const std::vector<double> targets = shownShares(scene.tf, named);
    const OptimizeOptions options = o.search.over(*scene.session.optimize);
    const MeasureInput input = measureInput(scene);
    Workspace workspace;
    const auto [engine, saliencySeconds] = prepare(workspace, input, progress);

    JobControl job = progress.phase("optimizing");
    job.progress = nullptr; // engines tell the fraction of one evaluation; how many will be needed nobody knows
    int moves = -1;
    OptimizeResult result = workspace.optimize(
        input, targets, limitsOf(scene.tf, *scene.session.goals), options, job, [&](const OptimizeState& state) {
            progress.tell(std::to_string(++moves) + " moves, distance " + plainText(state.objective));
        });
    if (result.reason == StopReason::Cancelled) throw Cancelled{};
    result.tf = withShownOpacities(scene.tf, result.history[result.best].opacity);
    const Seconds seconds{saliencySeconds, workspace.seconds().visibility, total.seconds()};
    if (o.outTf) writeTf(result.tf, *o.outTf);
    Answer answer{textOf(result, engine, seconds), jsonOf(result, options, *input.volume, engine, seconds),
                  opened.notices(), failureOf(o, options, result)};
    o.report.write(scene, options, result, seconds.search, workspace, progress, answer);
    return answer;
}

void SearchOptions::add(CLI::App& app) {
    addValue(
        app, "--method", "fixed|line|parallel",
        [this](const std::string& text, const std::string& option) {
            method = atOption(option, [&] { return searchMethodFromName(text); });
        },
        "fixed step, line search, or line search with all steps at once (default parallel)");
    addValue(
        app, "--direction", "gradient",
        [](const std::string& text, const std::string& option) {
            if (text != "gradient") throw UsageError("unknown direction '" + text + "'", option, "give gradient");
        },
        "descent along 2(W - target) (the default)");
    app.add_flag("--normalize", normalize, "scale the direction to length 1, as section 5.3.4 prints it");
    addValue(
        app, "--step", "S",
        [this](const std::string& text, const std::string& option) { step = parseRealAbove(text, option, 0, 10); },
        "base step (default 0.05)");
    addValue(
        app, "--tolerance", "F",
        [this](const std::string& text, const std::string& option) { tolerance = parseRealAbove(text, option, 0, 1); },
        "converged below this distance from the targets (default 0.03)");
    addValue(
        app, "--max-iterations", "N",
        [this](const std::string& text, const std::string& option) {
            maxIterations = static_cast<int>(parseInteger(text, option, 0, 1'000'000'000));
        },
        "at most so many moves (default 200)");
}

} // namespace

Command addOptimize(CLI::App& program) {
    CLI::App* app =
        program.add_subcommand("optimize", "Finds the opacities that give each feature its target saliency");
    const auto o = std::make_shared<Options>();
    o->scene.addForFigures(*app);
    addValue(
        *app, "--target", "T1,T2,...",
        [o](const std::string& text, const std::string& option) { o->targets = parseTargets(text, option); },
        "one number for each feature, from 0 on; scaled to sum 1; required unless a session has targets");
    o->search.add(*app);
    addValue(
        *app, "--out-tf", "FILE", [o](const std::string& text, const std::string&) { o->outTf = text; },
        "write the optimized transfer function (the best one seen)");
    o->report.add(*app);
    app->add_flag("--require-converged", o->requireConverged,
                  "exit status 1 where the targets are not reached; the answer is written all the same");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
