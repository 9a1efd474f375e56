// `refine`: entropy refinement of the opacities.
#include "optimize/refine/refine.h"

#include <cmath>

#include "commands.h"
#include "optimize/coverage.h"
#include "optimize/refine/drawn_colors.h"
#include "optimize/refine/refine_features.h"
#include "optimize/refine/refine_outcome.h"
#include "optimize/refine/refine_words.h"
#include "options/priority_options.h"
#include "options/setting_options.h"
#include "output_files.h"
#include "parse.h"
#include "render/memory_needs.h"
#include "resolve.h"
#include "results_json.h"
#include "session/scene_data.h"
#include "tf/formats/tf_file.h"
#include "tf_notices.h"

namespace pellucid::cli {

namespace {

struct RefineArguments {
    SceneOptions scene;
    SettingOptions<RefineSteps> steps;
    PriorityOptions priority;
    std::optional<ImageSize> size;
    std::vector<double> fixed;
    std::optional<std::string> outTf;

    ImageSize pictureSize() const { return size.value_or(ImageSize{}); }
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
    throw UsageError("no control point is at intensity " + plainText(x), "--fix",
                     "known: " + joined(tf.points, " ", [](const ControlPoint& p) { return plainText(p.x); }));
}

/// Refuses options of a picture that nothing looks at.
void checkPicture(const RefineArguments& o, bool looks) {
    if (looks) return;
    const CameraOptions& camera = o.scene.camera;
    const char* of = o.size                            ? "--size WxH"
                     : camera.file                     ? "--camera"
                     : camera.view || camera.namedView ? "--view"
                     : camera.orthographic             ? "--orthographic"
                     : !o.scene.clip.clips.empty()     ? "--clip"
                     : o.scene.clip.holder             ? "--holder"
                                                       : nullptr;
    if (of)
        throw UsageError("refinement looks at a picture only where a region of it is prioritized", of,
                         "leave it out, or give --region X0,Y0,X1,Y1");
}

/// "12 % above the least at the same total opacity", of greedy.
std::string textOfComparison(const RefineComparison& c) {
    if (!(c.exactEnergy < c.greedyEnergy)) return "as even as it gets at the same total opacity";
    return "exact has " + fixedText(100 * (1 - c.exactEnergy / c.greedyEnergy), 1) +
           " % less energy than greedy at the same total opacity";
}

/// What the command says of a refinement beside its figures.
struct Remarks {
    std::optional<PriorityOutcome> outcome;
    std::optional<Darkening> dark;
};

std::string textOf(const RefineOptions& options, const TransferFunction& before, const RefineResult& r,
                   const RefineComparison& comparison, const Json& priority, const Remarks& remarks, double seconds) {
    const auto change = [](double from, double to) {
        const std::string share = from > 0 ? " (" + fixedText(100 * (to / from - 1), 1) + " %)" : "";
        return plainText(from) + " -> " + plainText(to) + share;
    };
    Table points({"point", "intensity", "opacity before", "after", "fixed"});
    // Features that have moved as wholes may have steps at their ends that were not there before.
    const bool same = r.tf.points.size() == before.points.size();
    for (std::size_t i = 0; i < r.tf.points.size(); ++i) {
        const ControlPoint& p = r.tf.points[i];
        points.add({std::to_string(i + 1), fixedText(p.x, 4),
                    fixedText(same ? before.points[i].opacity : before.opacity(p.x), 4), fixedText(p.opacity, 4),
                    p.fixed ? "yes" : "no"});
    }
    std::vector<std::pair<std::string, std::string>> rows{{"changes", changeText(opacityChanges(before, r.tf))}};
    if (options.profile != Profile::Default) rows.emplace_back("profile", name(options.profile));
    rows.insert(rows.end(), {{"priority", textOfPriority(priority)},
                             {"method", name(options.method)},
                             {"moves", movesFeatures(before, options) ? "features as wholes" : "control points"},
                             {"iterations", std::to_string(r.iterations)},
                             {"energy", change(r.energyBefore, r.energyAfter)},
                             {"energy of movable edges", change(r.energyMovableBefore, r.energyMovableAfter)},
                             {"methods", textOfComparison(comparison)},
                             {"time", secondsText(seconds)}});
    std::string text = listing(rows);
    if (remarks.outcome && !remarks.outcome->gained) text += remarks.outcome->text + "\n";
    if (remarks.dark) text += darkeningText(*remarks.dark) + "\n";
    return text + points.text();
}

Answer run(const RefineArguments& o, Progress& progress) {
    o.priority.check(o.pictureSize());
    const bool hasSession = o.scene.sessionFile.has_value(); // which may bring a region
    if (!hasSession) checkPicture(o, o.priority.region.has_value());
    const Opened opened =
        resolve(o.scene, progress, {o.priority.region || hasSession ? toView("drawing") : MemoryUse{}});
    Scene scene = opened.scene;
    scene.session.refine.edit([&](RefineSettings& settings) {
        o.priority.applyTo(settings, o.pictureSize());
        if (o.size && settings.region) settings.regionSize = {o.size->width, o.size->height};
    });
    checkPicture(o, scene.session.refine->region.has_value());
    TransferFunction tf = scene.tf;
    for (const double x : o.fixed) fixPoint(tf, x);
    RefineOptions options = refineOptions(scene.session);
    requireOwnSteps(options.profile, o.steps);
    o.steps.applyTo(options);
    options.priority = refinePriority(scene, progress.phase("looking"));
    const Json priority = o.priority.told(*scene.session.refine, options.priority);
    const Histogram histogram = makeHistogram(*scene.volume);
    const JobControl job = progress.phase("refining");
    const Stopwatch refining;
    const RefineResult result = refineAsDrawn(histogram, tf, *scene.volume, scene.colors.get(), options, job);
    const double seconds = refining.seconds();
    const TransferFunction drawn =
        options.priority.region.empty() ? tf : withDrawnColors(tf, *scene.volume, scene.colors.get());
    const RefineComparison comparison = compareMethods(histogram, drawn, options, job);
    Remarks remarks;
    const RefineAgain again = [&](const RefineOptions& by) {
        return refineAsDrawn(histogram, tf, *scene.volume, scene.colors.get(), by, job).tf;
    };
    remarks.outcome = priorityOutcome(histogram, drawn, result.tf, options, again);
    const MeasureInput seen = measureInput(scene);
    const RayBundle rays(*scene.volume, tf, seen.view, kCoverageRays, progress.phase("coverage"));
    remarks.dark = darkeningOf(rays, histogram, tf, result.tf, options, again);
    std::vector<std::string> notices = opened.notices();
    if (o.outTf) addTo(notices, writeTfFile(toWrite(result.tf, scene, *o.outTf), *o.outTf));
    Json json = jsonFromRefinement(tf, result, options.method, comparison, priority);
    addRemarks(json, remarks.outcome, remarks.dark);
    if (options.profile != Profile::Default) json["profile"] = name(options.profile);
    addMapping(json, scene);
    return {textOf(options, tf, result, comparison, priority, remarks, seconds), std::move(json), std::move(notices)};
}

} // namespace

Command addRefine(CLI::App& program) {
    CLI::App* app = program.add_subcommand("refine", "Evens out the information along the transfer function (entropy)");
    const auto o = std::make_shared<RefineArguments>();
    o->scene.addForView(*app, VolumeOptions::SizeIs::Both);
    o->priority.add(*app, o->scene.volume);
    o->scene.volume.addSizeOfBoth(
        *app, [o](const ImageSize& size) { o->size = size; },
        "WxH: pixels of the picture that --region is of (default 512x512); N: as --sample-size");
    o->steps.add(*app);
    o->scene.engine.addDefinitions(*app);
    addRepeated(
        *app, "--fix", "X",
        [o](const std::string& text, const std::string& option) {
            for (const double x : parseReals(text, option)) {
                if (x < 0 || x > 1)
                    throw UsageError(plainText(x) + " is not an intensity", option, "give numbers from 0 to 1");
                o->fixed.push_back(x);
            }
        },
        "leave the control point at this intensity (0 to 1) as it is");
    addOutputFile(*app, "--out-tf", o->outTf, "write the refined transfer function" + std::string(kTfFileHelp));
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
