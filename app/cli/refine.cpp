// `refine`: entropy refinement of the opacities.
#include "optimize/refine.h"

#include <cmath>

#include "commands.h"
#include "output_files.h"
#include "parse.h"
#include "resolve.h"
#include "results_json.h"
#include "tf/formats/tf_json.h"

namespace pellucid::cli {

namespace {

struct Options {
    SceneOptions scene;
    RefineOptions refine;
    std::vector<double> fixed;
    std::optional<std::string> outTf;
};

/// How far a number given with --fix may be from the control point it means: people copy rounded ones.
constexpr double kFixTolerance = 0.005;

void fixPoint(TransferFunction& tf, double x) {
    double nearest = kFixTolerance;
    for (const ControlPoint& p : tf.points) nearest = std::min(nearest, std::abs(p.x - x));
    bool found = false;
    for (ControlPoint& p : tf.points)
        if (std::abs(p.x - x) <= nearest) p.fixed = found = true;
    if (found) return;
    std::string known;
    for (const ControlPoint& p : tf.points) known += (known.empty() ? "" : " ") + plainText(p.x);
    throw UsageError("no control point is at intensity " + plainText(x), "--fix", "known: " + known);
}

std::string textOf(const RefineResult& r, double seconds) {
    const auto change = [](double before, double after) { return plainText(before) + " -> " + plainText(after); };
    Table points({"point", "intensity", "opacity", "fixed"});
    for (std::size_t i = 0; i < r.tf.points.size(); ++i)
        points.add({std::to_string(i + 1), fixedText(r.tf.points[i].x, 4), fixedText(r.tf.points[i].opacity, 4),
                    r.tf.points[i].fixed ? "yes" : "no"});
    return listing({{"iterations", std::to_string(r.iterations)},
                    {"energy", change(r.energyBefore, r.energyAfter)},
                    {"energy of movable edges", change(r.energyMovableBefore, r.energyMovableAfter)},
                    {"time", secondsText(seconds)}}) +
           points.text();
}

Answer run(const Options& o, Progress& progress) {
    if (o.outTf) checkOutputFile(*o.outTf, "--out-tf", inputFiles(o.scene));
    o.refine.validate();
    const Opened opened = resolve(o.scene, progress);
    TransferFunction tf = opened.scene.tf;
    for (const double x : o.fixed) fixPoint(tf, x);
    const Histogram histogram = makeHistogram(*opened.scene.volume);
    const Stopwatch refining;
    const RefineResult result = refine(histogram, tf, o.refine, progress.phase("refining"));
    const double seconds = refining.seconds();
    if (o.outTf) writeTf(result.tf, *o.outTf);
    return {textOf(result, seconds), jsonFromRefinement(result), opened.notices(), {}};
}

} // namespace

Command addRefine(CLI::App& program) {
    CLI::App* app = program.add_subcommand("refine", "Evens out the information along the transfer function (entropy)");
    const auto o = std::make_shared<Options>();
    o->scene.volume.add(*app);
    o->scene.session.add(*app);
    o->scene.tf.add(*app);
    addValue(
        *app, "--step-down", "D",
        [o](const std::string& text, const std::string& option) {
            o->refine.stepDown = parseRealAbove(text, option, 0, 1);
        },
        "opacity taken from the heaviest edge in an iteration (default 1/256)");
    addValue(
        *app, "--step-up", "D|auto",
        [o](const std::string& text, const std::string& option) {
            if (text == "auto")
                o->refine.stepUp.reset();
            else
                o->refine.stepUp = parseRealAbove(text, option, 0, 1);
        },
        "opacity given to the lightest one (default 1/256); auto: from --step-down and the two ends' significances");
    addValue(
        *app, "--max-iterations", "N",
        [o](const std::string& text, const std::string& option) {
            o->refine.maxIterations = static_cast<int>(parseInteger(text, option, 0, 1'000'000'000));
        },
        "at most so many (default 5000)");
    addRepeated(
        *app, "--fix", "X",
        [o](const std::string& text, const std::string& option) {
            for (const double x : parseReals(text, option)) {
                if (x < 0 || x > 1)
                    throw UsageError(plainText(x) + " is no intensity", option, "give numbers from 0 to 1");
                o->fixed.push_back(x);
            }
        },
        "leave the control point at this intensity (0 to 1) as it is");
    addValue(
        *app, "--out-tf", "FILE", [o](const std::string& text, const std::string&) { o->outTf = text; },
        "write the refined transfer function");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
