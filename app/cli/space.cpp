// `space`: VWS and the distance from the targets over the opacities of two or three features, as figures and a picture.
#include <algorithm>

#include "base/atomic_file.h"
#include "commands.h"
#include "image_io/image_file.h"
#include "options/target_input.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "render/memory_needs.h"
#include "report/space_picture.h"
#include "resolve.h"
#include "session/coarser_input.h"

namespace pellucid::cli {

namespace {

struct SpaceArguments {
    SceneOptions scene;
    std::optional<TargetInput> targets;
    std::optional<std::vector<std::string>> features;
    ParameterAxes axes;
    std::optional<int> reduce; ///< empty: automatic
    std::string show = "F";
    std::vector<SearchMethod> methods;
    bool runs = false; ///< draw those of the session
    std::optional<std::string> out, save, csv;
    ImageSize size;
    ViewAngles view{kSpaceAzimuth, kSpaceElevation, 1};
    Rgb background{0, 0, 0};
};

ViewAngles parseSpaceView(const std::string& text, const std::string& option) {
    const auto v = parseReals(text, option);
    const std::string form = "give AZIMUTH,ELEVATION[,ZOOM]: degrees, elevation from -90 to 90, zoom from 0.1 to 10";
    if (v.size() < 2 || v.size() > 3 || std::abs(v[1]) > 90 || (v.size() == 3 && !(v[2] >= 0.1 && v[2] <= 10)))
        throw UsageError("'" + text + "' is not a view", option, form);
    return {v[0], v[1], v.size() == 3 ? v[2] : 1.0};
}

/// The methods whose paths are drawn, and "runs".
void parsePaths(const std::string& text, const std::string& option, SpaceArguments& o) {
    o.methods.clear();
    o.runs = false;
    for (const std::string& word : split(text, ',')) {
        if (word == "runs")
            o.runs = true;
        else
            o.methods.push_back(parseName<SearchMethod>(word, option));
    }
}

/// What can be told before the volume is read.
void check(const SpaceArguments& o) {
    if (!o.targets && !o.scene.sessionFile) throw isRequired("--target", "space");
    if (o.runs && !o.scene.sessionFile)
        throw UsageError("runs come from a session, and none is given", "--paths",
                         "name methods, or give --session FILE");
}

ParameterAxes axesOf(const SpaceArguments& o, const Scene& scene, const std::vector<double>& targets) {
    const TransferFunction tf = scene.wantedTf();
    ParameterAxes axes = o.axes;
    if (!o.features) {
        axes.features = atOption("--tf", [&] { return defaultAxes(tf, targets); });
        return axes;
    }
    for (const std::string& one : *o.features) {
        const std::size_t f = parseFeature(one, "--features", tf);
        if (scene.isEmpty(f))
            throw UsageError("the feature '" + one + "' is empty: no voxel has its values", "--features",
                             "choose others");
        if (tf.features[f].hidden)
            throw UsageError("the feature '" + one + "' is hidden", "--features", "choose others");
        axes.features.push_back(f);
    }
    atOption("--features", [&] { axes.validate(tf.features.size()); });
    return axes;
}

/// All searches begin at the opacities of the transfer function, and see the same volume as the samples.
std::vector<SpacePath> searchPaths(const SpaceArguments& o, Workspace& workspace, const MeasureInput& input,
                                   const Scene& scene, const ParameterSpace& space, Progress& progress, Json& json) {
    std::vector<SpacePath> paths;
    if (o.runs) paths = pathsOfRuns(*scene.session.runs, scene.tf, space.axes);
    json = Json::array();
    for (const SearchMethod method : o.methods) {
        OptimizeOptions options = *scene.session.optimize;
        options.method = method;
        options.exactShares = true; // F is all that the space shows
        const OptimizeResult r = workspace.optimize(input, space.targets, limitsOf(scene.tf, *scene.session.goals),
                                                    options, progress.openPhase("optimizing"));
        if (r.reason == StopReason::Cancelled) throw Cancelled{};
        paths.push_back({name(method), pathColor(paths.size()), r.history, r.best});
        Json one{{"method", name(method)},
                 {"converged", r.converged()},
                 {"iterations", r.iterations()},
                 {"evaluations", r.evaluations},
                 {"best", r.best},
                 {"objective", Json::array()},
                 {"opacity", Json::array()}};
        for (const OptimizeState& state : r.history) {
            one["objective"].push_back(state.objective);
            one["opacity"].push_back(state.opacity);
        }
        json.push_back(std::move(one));
    }
    return paths;
}

std::vector<double> vwsAt(const ParameterSpace& space, std::size_t sample) {
    std::vector<double> w;
    for (const auto& one : space.vws) w.push_back(one[sample]);
    return w;
}

std::string textOf(const ParameterSpace& space, const std::vector<std::string>& names, int factor,
                   const std::vector<SpacePath>& paths, const std::vector<std::string>& files, double seconds) {
    Table table({"feature", "axis", "target", "best opacity", "VWS there"});
    const auto x = space.opacitiesAt(space.positionOfSample(space.best));
    const auto w = vwsAt(space, space.best);
    for (std::size_t f = 0; f < names.size(); ++f) {
        const auto axis = std::find(space.axes.features.begin(), space.axes.features.end(), f);
        table.add({names[f],
                   axis == space.axes.features.end()
                       ? "-"
                       : std::string(1, "xyz"[static_cast<std::size_t>(axis - space.axes.features.begin())]),
                   fixedText(space.targets[f], 4), plainText(x[f]), fixedText(w[f], 4)});
    }
    const ValueRange range = space.range(kObjective);
    std::string text = table.text() + "F from " + plainText(range.lo) + " to " + plainText(range.hi) + " over " +
                       std::to_string(space.evaluations) + " evaluations, " + secondsText(seconds) +
                       (factor > 1 ? ", of the volume made coarser by " + std::to_string(factor) : "") + "\n";
    for (const SpacePath& path : paths)
        text += path.name + ": " + std::to_string(path.states.size() - 1) + " moves, F " +
                plainText(path.states[path.best].objective) + "\n";
    for (const std::string& file : files) text += "wrote " + file + "\n";
    return text;
}

Json jsonOf(const ParameterSpace& space, const std::vector<std::string>& names) {
    Json axes = Json::array(), others = Json::object();
    for (const std::size_t f : space.axes.features) {
        Json opacities = Json::array();
        for (int i = 0; i < space.axes.samples; ++i)
            opacities.push_back(space.axes.opacityAt(space.axes.positionOfSample(i)));
        axes.push_back({{"feature", names[f]}, {"scale", name(space.axes.scale)}, {"opacity", opacities}});
    }
    for (std::size_t f = 0; f < names.size(); ++f)
        if (std::find(space.axes.features.begin(), space.axes.features.end(), f) == space.axes.features.end())
            others[names[f]] = space.base[f];
    return {{"axes", axes},
            {"others", others},
            {"target", space.targets},
            {"minimum",
             {{"opacity", space.opacitiesAt(space.positionOfSample(space.best))},
              {"objective", space.objective[space.best]},
              {"vws", vwsAt(space, space.best)}}},
            {"objective_range", jsonFromRange(space.range(kObjective))},
            {"evaluations", space.evaluations}};
}

/// Without paths.
SpaceView viewOf(const SpaceArguments& o, const Scene& scene, const ParameterSpace& space, int shown) {
    SpaceView view;
    view.shown = shown;
    for (const Feature& f : scene.tf.features) {
        view.names.push_back(f.name);
        view.colors.push_back(f.color);
    }
    view.tolerance = scene.session.optimize->tolerance;
    view.width = o.size.width;
    view.height = o.size.height;
    view.background = o.background;
    view.camera = spaceCamera(space, o.view.azimuth, o.view.elevation, o.view.zoom);
    return view;
}

/// Writes the files that are asked for, and returns their names.
std::vector<std::string> write(const SpaceArguments& o, const ParameterSpace& space, const SpaceView& view,
                               Progress& progress) {
    if (o.out) writeImage(spaceImage(space, view, progress.phase("rendering")), *o.out);
    if (o.save) {
        const std::vector<double>& values = space.values(view.shown);
        writeNrrd(space.geometry(), Grid<float>(space.dims(), {values.begin(), values.end()}), *o.save);
    }
    if (o.csv) writeTextAtomically(*o.csv, csvOf(space, view.names));
    std::vector<std::string> files;
    for (const std::optional<std::string>& file : {o.out, o.save, o.csv})
        if (file) files.push_back(*file);
    return files;
}

Answer run(const SpaceArguments& o, Progress& progress) {
    const Stopwatch total;
    check(o);
    const Opened opened = resolve(o.scene, progress, {toMeasure("sampling"), true});
    const Scene& scene = opened.scene;
    std::vector<std::string> notices = opened.notices();
    const std::vector<double> targets = targetsOf(o.targets, scene, notices);
    const ParameterAxes axes = axesOf(o, scene, targets);
    const int shown = o.show == "F" ? kObjective : static_cast<int>(parseFeature(o.show, "--show", scene.tf));

    MeasureInput input = measureInput(scene);
    const bool published = input.settings.profile == Profile::Published; // knows planes of voxels, and no lengths
    if (published && o.reduce.value_or(1) > 1)
        throw UsageError("the published profile has no coarser copies", "--reduce", "leave it out");
    const int factor = o.reduce.value_or(published ? 1 : reductionFor(input.volume->size(), axes));
    const Json volume = jsonFromVolume(*input.volume);
    input = coarserInput(input, factor);
    Workspace workspace;
    const std::string engine = prepare(workspace, input, progress).engine;
    const Stopwatch sampling;
    const ParameterSpace space = sampleParameterSpace(workspace.vws(input), targets, axes, progress.phase("sampling"));
    const double seconds = sampling.seconds();
    Json pathsJson;
    SpaceView view = viewOf(o, scene, space, shown);
    view.paths = searchPaths(o, workspace, input, scene, space, progress, pathsJson);
    const std::vector<std::string> files = write(o, space, view, progress);

    Json json{{"command", "space"}, {"engine", engine}, {"volume", volume}, {"coarser_by", factor}, {"show", o.show}};
    json.update(jsonOf(space, view.names));
    addMapping(json, scene);
    json["paths"] = std::move(pathsJson);
    json["files"] = files;
    json["seconds"] = {{"sampling", seconds}, {"total", total.seconds()}};
    json["empty"] = emptyFeatures(scene.tf, *scene.histogram);
    return {textOf(space, namesWithEmpty(scene.tf, *scene.histogram), factor, view.paths, files, seconds),
            std::move(json), std::move(notices)};
}

} // namespace

Command addSpace(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "space", "Shows how VWS and distance from the targets depend on the opacities of two or three features");
    const auto o = std::make_shared<SpaceArguments>();
    o->scene.addForFigures(*app, VolumeOptions::SizeIs::Image);
    addValue(*app, "--target", kTargetForms, o->targets, TargetInput::parse,
             "shares of attention, as in optimize; required unless a session has targets");
    addValue(
        *app, "--features", "A,B[,C]",
        [o](const std::string& text, const std::string& option) {
            o->features = split(text, ',');
            if (o->features->size() != 2 && o->features->size() != 3)
                throw UsageError("a parameter space has two features or three", option, "name two or three");
        },
        "names of the features that get an axis; the others keep their opacities (default: the three of the largest "
        "targets)");
    addValue(*app, "--samples", "N", o->axes.samples, wholeFrom(2, kMostAxisSamples),
             "samples along each axis, 2 to 64 (default 11)");
    addValue(
        *app, "--scale", "linear|log[:LOWEST]",
        [o](const std::string& text, const std::string& option) {
            const auto parts = split(text, ':');
            o->axes.scale = parseName<AxisScale>(parts.front(), option);
            if (parts.size() > 2 || (parts.size() == 2 && o->axes.scale == AxisScale::Linear))
                throw UsageError("'" + text + "' is not a scale", option, "give linear, log or log:LOWEST");
            if (parts.size() == 2) o->axes.lowest = parseRealFrom(parts[1], option, 1e-6, 0.5);
        },
        "opacities from 0 to 1 in equal steps (default), or from LOWEST (default 0.001) to 1 in equal factors");
    addValue(
        *app, "--reduce", "auto|N",
        [o](const std::string& text, const std::string& option) {
            o->reduce.reset();
            if (text != "auto") o->reduce = static_cast<int>(parseInteger(text, option, 1, 64));
        },
        "sample a copy of the volume that is coarser by N, of the same lengths; auto (default): 1 unless that takes "
        "long");
    addValue(*app, "--show", "F|NAME", o->show, anyText,
             "what the picture and --save show: the distance from the targets (default), or the VWS of a feature");
    addValue(
        *app, "--paths", "METHOD,...",
        [o](const std::string& text, const std::string& option) { parsePaths(text, option, *o); },
        "draw the paths that these methods take from the present opacities: newton, parallel, line, fixed; runs: the "
        "paths of the session's runs");
    addOutputFile(
        *app, "--out", o->out,
        "the picture to write: of three features a volume with its axes, of two a heat map; .png, .tif, .exr or .jpg",
        checkImageSuffix);
    addValue(*app, "--size", "WxH", o->size, parseImageSize, "pixels (default 512x512)");
    addValue(*app, "--background", "COLOR", o->background, parseColor,
             "components R,G,B from 0 to 1 or #rrggbb (default 0,0,0)");
    addValue(*app, "--space-view", "AZIMUTH,ELEVATION[,ZOOM]", o->view, parseSpaceView,
             "from where the volume of three features is seen, degrees (default 35,25); --view is that of the figures");
    addOutputFile(*app, "--save", o->save,
                  "write the samples of what is shown (NRRD, float32; positions along the axes from 0 to 1)");
    addOutputFile(*app, "--csv", o->csv, "write every sample: opacities, VWS of each feature, F");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
