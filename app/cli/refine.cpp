// `refine`: entropy refinement of the opacities.
#include "optimize/refine/refine.h"

#include <cmath>

#include "commands.h"
#include "optimize/coverage.h"
#include "optimize/refine/drawn_colors.h"
#include "optimize/refine/refine_features.h"
#include "optimize/refine/refine_outcome.h"
#include "optimize/refine/refine_words.h"
#include "optimize/refine/region_colors.h"
#include "options/setting_options.h"
#include "output_files.h"
#include "parse.h"
#include "render/image_renderer.h"
#include "render/memory_needs.h"
#include "resolve.h"
#include "results_json.h"
#include "tf/formats/tf_json.h"

namespace pellucid::cli {

namespace {

/// Pixels of a picture: [x0, x1) × [y0, y1).
struct PixelRectangle {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct Options {
    SceneOptions scene;
    SettingOptions<RefineSteps> steps;
    std::optional<double> intensity;
    std::optional<double> hue; ///< degrees
    std::optional<PixelRectangle> region;
    std::optional<ImageSize> size;
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
    throw UsageError("no control point is at intensity " + plainText(x), "--fix",
                     "known: " + joined(tf.points, " ", [](const ControlPoint& p) { return plainText(p.x); }));
}

PixelRectangle parseRectangle(const std::string& text, const std::string& option) {
    const std::vector<double> v = parseReals(text, option, 4, "X0,Y0,X1,Y1 in pixels");
    for (const double pixel : v)
        if (!(pixel >= 0 && pixel <= kMostPixels && pixel == std::floor(pixel)))
            throw UsageError("'" + text + "' does not name a region of a picture", option,
                             "give whole numbers of pixels");
    const PixelRectangle r{static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2]),
                           static_cast<int>(v[3])};
    if (r.x0 >= r.x1 || r.y0 >= r.y1)
        throw UsageError("the region '" + text + "' holds no pixel", option,
                         "give X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1, y down");
    return r;
}

/// What can be told before the volume is read.
void check(const Options& o) {
    if ((o.intensity ? 1 : 0) + (o.hue ? 1 : 0) + (o.region ? 1 : 0) > 1)
        throw UsageError("more than one priority is given", "--intensity, --hue and --region", "leave one of them");
    const ImageSize size = o.size.value_or(ImageSize{});
    if (o.region && (o.region->x1 > size.width || o.region->y1 > size.height))
        throw UsageError("the region lies outside the picture of " + std::to_string(size.width) + " x " +
                             std::to_string(size.height) + " pixels",
                         "--region", "correct it, or give the picture's --size WxH");
}

/// Refuses options of a picture that nothing looks at.
void checkPicture(const Options& o, bool looks) {
    if (looks) return;
    const CameraOptions& camera = o.scene.camera;
    const char* of = o.size                            ? "--size WxH"
                     : camera.file                     ? "--camera"
                     : camera.view || camera.namedView ? "--view"
                     : camera.orthographic             ? "--orthographic"
                     : !o.scene.clip.clips.empty()     ? "--clip"
                                                       : nullptr;
    if (of)
        throw UsageError("refinement looks at a picture only where a region of it is prioritized", of,
                         "leave it out, or give --region X0,Y0,X1,Y1");
}

/// The region that counts, of a picture of `o.size`: the one given, else the session's where nothing else counts.
std::optional<ImageRegion> regionOf(const Options& o, const Session& session) {
    if (!o.region) return o.intensity || o.hue ? std::nullopt : session.refine->region;
    const ImageSize size = o.size.value_or(ImageSize{});
    const double w = size.width, h = size.height;
    const PixelRectangle& r = *o.region;
    return ImageRegion{{{r.x0 / w, r.y0 / h}, {r.x1 / w, r.y0 / h}, {r.x1 / w, r.y1 / h}, {r.x0 / w, r.y1 / h}}};
}

/// As corners in fractions of the picture.
Json jsonFromRegion(const ImageRegion& region) {
    Json corners = Json::array();
    for (const glm::dvec2& corner : region.outline) corners.push_back({corner.x, corner.y});
    return corners;
}

/// The priority that the options or the session ask for, and in `said` what it is.
RefinePriority priorityOf(const Options& o, const Scene& scene, const TransferFunction& tf, Progress& progress,
                          Json& said) {
    RefinePriority priority;
    priority.intensity = o.intensity;
    if (!o.intensity && !o.hue && !o.region) priority.intensity = scene.session.refine->intensity;
    if (o.hue) priority.intensity = intensityOfHue(withDrawnColors(tf, *scene.volume, scene.colors.get()), *o.hue);
    if (priority.intensity) {
        said = {{"kind", "intensity"}, {"intensity", *priority.intensity}};
        if (o.hue) said["hue"] = *o.hue;
    } else if (const std::optional<ImageRegion> region = regionOf(o, scene.session)) {
        const ImageSize size = o.size.value_or(ImageSize{});
        // Always by the cpu renderer: the same answer on every machine.
        const PictureInput picture = plainPictureInput(scene, size.width, size.height);
        const Image image = makeCpuRenderer(picture.volume)
                                ->render(picture.camera, picture.tf, picture.settings, progress.phase("rendering"));
        priority.region = regionColors(image, *region);
        double pixels = 0;
        for (const RegionColor& c : priority.region) pixels += c.count;
        said = {{"kind", "region"}};
        if (o.region)
            said["region"] = {o.region->x0, o.region->y0, o.region->x1, o.region->y1};
        else
            said["outline"] = jsonFromRegion(*region);
        said["size"] = {size.width, size.height};
        said["pixels"] = static_cast<long long>(pixels);
    } else {
        said = {{"kind", "none"}};
    }
    return priority;
}

std::string textOfPriority(const Json& said) {
    if (said["kind"] == "region") return countText(said["pixels"].get<std::size_t>()) + " pixels of a region";
    if (said["kind"] == "none") return "none";
    const std::string intensity = "intensity " + plainText(said["intensity"].get<double>());
    return said.contains("hue") ? intensity + ", hue " + plainText(said["hue"].get<double>()) : intensity;
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
    std::vector<std::pair<std::string, std::string>> rows{
        {"changes", changeText(opacityChanges(before, r.tf))},
        {"priority", textOfPriority(priority)},
        {"method", name(options.method)},
        {"moves", movesFeatures(before, options) ? "features as wholes" : "control points"},
        {"iterations", std::to_string(r.iterations)},
        {"energy", change(r.energyBefore, r.energyAfter)},
        {"energy of movable edges", change(r.energyMovableBefore, r.energyMovableAfter)},
        {"methods", textOfComparison(comparison)},
        {"time", secondsText(seconds)}};
    std::string text = listing(rows);
    if (remarks.outcome && !remarks.outcome->gained) text += remarks.outcome->text + "\n";
    if (remarks.dark) text += darkeningText(*remarks.dark) + "\n";
    return text + points.text();
}

Answer run(const Options& o, Progress& progress) {
    check(o);
    const bool hasSession = o.scene.sessionFile.has_value(); // which may bring a region
    if (!hasSession) checkPicture(o, o.region.has_value());
    const Opened opened = resolve(o.scene, progress, {o.region || hasSession ? toView("drawing") : MemoryUse{}});
    checkPicture(o, regionOf(o, opened.scene.session).has_value());
    TransferFunction tf = opened.scene.tf;
    for (const double x : o.fixed) fixPoint(tf, x);
    Json priority;
    RefineOptions options = opened.scene.session.refine->options();
    o.steps.applyTo(options);
    options.priority = priorityOf(o, opened.scene, tf, progress, priority);
    const Histogram histogram = makeHistogram(*opened.scene.volume);
    const JobControl job = progress.phase("refining");
    const Stopwatch refining;
    const Scene& scene = opened.scene;
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
    if (o.outTf) writeTf(result.tf, *o.outTf);
    Json json = jsonFromRefinement(tf, result, options.method, comparison, priority);
    addRemarks(json, remarks.outcome, remarks.dark);
    addMapping(json, scene);
    return {textOf(options, tf, result, comparison, priority, remarks, seconds), std::move(json), opened.notices()};
}

void addPriority(CLI::App& app, const std::shared_ptr<Options>& o) {
    addValue(app, "--intensity", "X", o->intensity, realFrom(0, 1),
             "prioritize what is near this intensity, from 0 to 1 (the ends of the range)");
    addValue(app, "--hue", "DEG", o->hue, parseReal,
             "prioritize the intensity whose colour is nearest in hue, in degrees: a click on the palette");
    addValue(
        app, "--region", "X0,Y0,X1,Y1|X0:X1,Y0:Y1,Z0:Z1",
        [o](const std::string& text, const std::string& option) {
            if (text.find(':') != std::string::npos)
                o->scene.volume.region = parseVoxelRegion(text, option);
            else
                o->region = parseRectangle(text, option);
        },
        "four numbers: prioritize what has the colours of these pixels of the picture, y down, the last ones not "
        "included; three intervals: only these voxels of the data");
    o->scene.volume.addSizeOfBoth(
        app, [o](const ImageSize& size) { o->size = size; },
        "WxH: pixels of the picture that --region is of (default 512x512); N: as --sample-size");
}

} // namespace

Command addRefine(CLI::App& program) {
    CLI::App* app = program.add_subcommand("refine", "Evens out the information along the transfer function (entropy)");
    const auto o = std::make_shared<Options>();
    o->scene.addForView(*app, VolumeOptions::SizeIs::Both);
    addPriority(*app, o);
    o->steps.add(*app);
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
    addOutputFile(*app, "--out-tf", o->outTf, "write the refined transfer function");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
