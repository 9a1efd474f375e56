// `views`: how near to the targets, or how salient a feature is, over the sphere of views.
#include "base/atomic_file.h"
#include "commands.h"
#include "image_io/image_file.h"
#include "options/target_input.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "render/memory_needs.h"
#include "render/view_direction.h"
#include "resolve.h"
#include "results_json.h"
#include "session/view_workspace.h"
#include "tf/color_maps.h"

namespace pellucid::cli {

namespace {

using Figure = ViewMetric::Figure;

struct ViewsArguments {
    SceneOptions scene;
    std::optional<TargetInput> targets;
    std::optional<std::string> feature;
    Figure figure = Figure::Vws; ///< of `feature`
    int count = kSphereViews;
    std::optional<std::string> outCamera, map;
};

bool isTable(const std::string& path) { return path.ends_with(".csv"); }

ViewMetric metricOf(const ViewsArguments& o, const Scene& scene, std::vector<std::string>& notices) {
    ViewMetric metric;
    if (o.feature) {
        metric.figure = o.figure;
        metric.feature = parseFeature(*o.feature, "--feature", scene.tf);
        return metric;
    }
    metric.targets = normalizedTargets(targetsOf(o.targets, scene, notices), scene.tf.features.size());
    return metric;
}

/// azimuth,elevation,x,y,z,value
std::string tableOf(const ViewMap& map) {
    std::string text = "azimuth,elevation,x,y,z,value\n";
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        const Vec3& d = map.directions[i];
        const ViewAngles angles = anglesOf(d);
        for (const double v : {angles.azimuth, angles.elevation, d.x, d.y, d.z}) text += fixedText(v, 6) + ",";
        text += fixedText(map.values[i], 6) + "\n";
    }
    return text;
}

/// Azimuth −180 to 180 from left to right, elevation 90 to −90 from top to bottom; the better the brighter.
Image pictureOf(const ViewMap& map) {
    constexpr int kHeight = 256;
    Image image(2 * kHeight, kHeight);
    const ColorMap& colors = colorMapNamed("ember");
    const double best = map.values[map.best()], worst = map.values[map.worst()];
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const ViewAngles angles{(x + 0.5) / image.width * 360 - 180, 90 - (y + 0.5) / image.height * 180, 1};
            const double t = best == worst ? 1 : (map.interpolated(towardEye(angles)) - worst) / (best - worst);
            const Rgb c = colorOf(colors, t);
            float* pixel = image.pixel(x, y);
            pixel[0] = static_cast<float>(c.r), pixel[1] = static_cast<float>(c.g), pixel[2] = static_cast<float>(c.b);
            pixel[3] = 1;
        }
    return image;
}

struct ViewsSeconds {
    double saliency = 0, map = 0, best = 0, total = 0;
};

std::string textOf(const ViewMetric& metric, const std::string& feature, const BestView& b, const Geometry& geometry,
                   const std::string& engine, const ViewsSeconds& seconds) {
    const std::string head = metric.figure == Figure::Objective ? "distance F"
                             : metric.figure == Figure::Vws     ? "VWS of " + feature
                                                                : "visibility of " + feature;
    Table table({"view", "azimuth", "elevation", head});
    const auto add = [&](const std::string& name, const SeenView& v) {
        const ViewAngles angles = viewAngles(v.camera, geometry);
        table.add({name, fixedText(angles.azimuth, 1), fixedText(angles.elevation, 1), fixedText(v.value, 4)});
    };
    add("best", b.best);
    add("present", b.present);
    add("worst", b.worst);
    return table.text() + countText(b.map.values.size()) + " directions, " +
           countText(static_cast<std::size_t>(b.coarseViews)) + " views on the coarse volume, " +
           std::to_string(b.views) + " on the full one\nengine " + engine + ": map " + secondsText(seconds.map) +
           ", best " + secondsText(seconds.best) + ", saliency " + secondsText(seconds.saliency) + ", total " +
           secondsText(seconds.total) + "\n";
}

Json jsonOf(const ViewMetric& metric, const std::string& feature, const BestView& b, const Volume& volume,
            const std::string& engine, const ViewsSeconds& seconds) {
    Json json{{"command", "views"}, {"metric", name(metric.figure)}};
    if (metric.figure == Figure::Objective)
        json["target"] = metric.targets;
    else
        json["feature"] = feature;
    const auto seen = [&](const SeenView& v) {
        Json j = jsonFromView(v.camera, volume.geometry());
        j["value"] = v.value;
        return j;
    };
    json["best"] = seen(b.best);
    json["present"] = seen(b.present);
    json["worst"] = seen(b.worst);
    json["coarsening"] = coarseningForViews(volume.dims());
    Json views = Json::array();
    for (std::size_t i = 0; i < b.map.values.size(); ++i) {
        const Vec3& d = b.map.directions[i];
        const ViewAngles angles = anglesOf(d);
        views.push_back({{"azimuth", angles.azimuth},
                         {"elevation", angles.elevation},
                         {"direction", jsonFromVector(d)},
                         {"value", b.map.values[i]}});
    }
    json["views"] = views;
    json["evaluations"] = {{"coarse", b.coarseViews}, {"full", b.views}};
    json["engine"] = engine;
    json["volume"] = jsonFromVolume(volume);
    json["seconds"] = {
        {"saliency", seconds.saliency}, {"map", seconds.map}, {"best", seconds.best}, {"total", seconds.total}};
    return json;
}

Answer run(const ViewsArguments& o, Progress& progress) {
    const Stopwatch total;
    if (!o.targets && !o.feature && !o.scene.sessionFile) throw isRequired("--target or --feature", "views");
    if (o.targets && o.feature)
        throw UsageError("views are judged by one figure", "--target and --feature", "leave one out");
    const Opened opened = resolve(o.scene, progress, {toMeasure("measuring"), true});
    const Scene& scene = opened.scene;
    std::vector<std::string> notices = opened.notices();
    const ViewMetric metric = metricOf(o, scene, notices);
    const MeasureInput input = measureInput(scene);
    Workspace workspace;
    ViewWorkspace views;
    ViewsSeconds seconds;

    Stopwatch watch;
    const ViewSearch search = views.search(input, metric, o.count, progress.phase("views"));
    seconds.map = watch.seconds();
    const auto [engine, saliencySeconds] = prepare(workspace, input, progress);
    seconds.saliency = saliencySeconds;
    watch = Stopwatch();
    const BestView best = views.best(workspace, input, search, progress.phase("the best of them"));
    seconds.best = watch.seconds();
    seconds.total = total.seconds();

    if (o.outCamera) writeCamera(best.best.camera, *o.outCamera);
    if (o.map && isTable(*o.map)) writeTextAtomically(*o.map, tableOf(best.map));
    if (o.map && !isTable(*o.map)) writeImage(pictureOf(best.map), *o.map);
    const std::string feature = o.feature.value_or("");
    Json json = jsonOf(metric, feature, best, *input.volume, engine, seconds);
    addMapping(json, scene);
    return {textOf(metric, feature, best, input.volume->geometry(), engine, seconds), std::move(json),
            std::move(notices)};
}

} // namespace

Command addViews(CLI::App& program) {
    CLI::App* app = program.add_subcommand("views", "The best view: a figure over all directions, and its best");
    const auto o = std::make_shared<ViewsArguments>();
    o->scene.addForFigures(*app);
    addValue(*app, "--target", kTargetForms, o->targets, TargetInput::parse,
             "the distance F from these shares, as in optimize (default: the session's)");
    addValue(*app, "--feature", "NAME", o->feature, anyText, "how much of this feature is seen");
    addValue(
        *app, "--metric", "vws|visibility",
        [o](const std::string& text, const std::string& option) {
            if (text != "vws" && text != "visibility")
                throw UsageError("unknown metric '" + text + "'", option, "give vws or visibility");
            o->figure = text == "vws" ? Figure::Vws : Figure::Visibility;
        },
        "which figure of the feature (default vws)");
    addValue(*app, "--count", "N", o->count, wholeFrom(16, kMostSphereViews),
             "directions, 16 to " + std::to_string(kMostSphereViews) + " (default " + std::to_string(kSphereViews) +
                 ")");
    addOutputFile(*app, "--out-camera", o->outCamera, "write the best view's camera");
    addOutputFile(
        *app, "--map", o->map,
        "write the map: a table (.csv) or a picture, azimuth to the right and elevation up, the better the brighter",
        [](const std::string& path) {
            if (!isTable(path)) atOption("--map", [&] { checkImageSuffix(path); });
        });
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
