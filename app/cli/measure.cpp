// `measure`: what each feature shows from one view.
#include <algorithm>
#include <filesystem>

#include "commands.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "output_files.h"
#include "prepare.h"
#include "render/feature_pictures.h"
#include "render/memory_needs.h"
#include "render/picture_shares.h"
#include "report/drawing_file.h"
#include "report/share_bars.h"
#include "resolve.h"
#include "results_json.h"

namespace pellucid::cli {

namespace {

struct MeasureArguments {
    SceneOptions scene;
    bool jacobian = false, occlusion = false;
    bool pictured = false;               ///< --2dfs
    bool shares = false;                 ///< of the picture
    std::optional<ImageSize> size;       ///< of the picture
    std::optional<std::string> maps;     ///< folder of pictures and maps
    std::optional<double> mapStrength;   ///< of maps as PNG; empty: there are none
    std::optional<std::string> bars;     ///< file of bar charts
    std::vector<CLI::Option*> ofPicture; ///< options that say nothing without a picture

    void check() const {
        refuse({{mapStrength && !maps, "there are no maps to write", "--map-strength", "add --maps DIR"},
                {maps && !pictured, "maps are those of 2D feature saliency", "--maps", "add --2dfs"}});
        if (pictured || shares) return;
        const auto given =
            std::ranges::find_if(ofPicture, [](const CLI::Option* option) { return option->count() > 0; });
        const std::string name = given != ofPicture.end() ? (*given)->get_name() : size ? "--size" : "";
        if (!name.empty()) throw UsageError("no picture is looked at", name, "add --2dfs or --shares, or leave it out");
    }
};

struct MeasureSeconds {
    double visibility = 0, saliency = 0, total = 0;
    std::optional<double> jacobian;
    std::optional<double> pictures; ///< to draw them
    std::optional<double> fs;       ///< to look at them
    std::optional<double> shares;
};

/// 2D feature saliency.
struct Pictured {
    std::vector<double> shares; ///< FS by feature
    int width = 0, height = 0;
    bool lit = false;
    std::string renderer;
    std::vector<std::string> files;
};

using Matrix = std::vector<std::vector<double>>;

/// What is asked for besides, one row and column for each feature.
struct Matrices {
    std::optional<Matrix> jacobian;  ///< ∂W_i/∂x_j
    std::optional<Matrix> occlusion; ///< the part of i that j hides
};

std::string textOf(const TransferFunction& tf, const std::optional<Matrix>& matrix, const std::string& corner) {
    if (!matrix || matrix->empty()) return {};
    std::vector<std::string> head{corner};
    for (const Feature& f : tf.features) head.push_back(f.name);
    Table table(head);
    for (std::size_t i = 0; i < matrix->size(); ++i) {
        std::vector<std::string> row{tf.features[i].name};
        for (const double d : (*matrix)[i]) row.push_back(fixedText(d, 4));
        table.add(row);
    }
    return table.text();
}

/// All that `measure` answers.
struct Found {
    Measures measures;
    Matrices matrices;
    std::optional<Pictured> pictured;
    std::optional<PictureShares> shares;
    std::string engine;
    MeasureSeconds seconds;
};

std::string sizeText(const Pictured& p) {
    std::string files;
    for (const std::string& file : p.files) files += "wrote " + file + "\n";
    return "2DFS of " + std::to_string(p.width) + " x " + std::to_string(p.height) + " pixels, " +
           (p.lit ? "lit" : "not lit") + ", drawn by " + p.renderer + "\n" + files;
}

std::string sharesText(const PictureShares& shares, bool overlaid) {
    return "opacity of the picture " + fixedText(shares.alpha, 4) + ", the sum of the features' parts" +
           (overlaid ? ", " + fixedText(shares.overlay, 4) + " of the overlay" : "") + " and " +
           fixedText(shares.rest, 4) + " of no feature\n";
}

std::string textOf(const Scene& scene, const Found& found, const std::string& profile) {
    const auto& [m, matrices, pictured, shares, engine, seconds] = found;
    const TransferFunction& tf = scene.tf;
    const std::vector<std::string> names = namesWithEmpty(tf, *scene.histogram);
    std::vector<std::string> head{"feature", "intensities", "opacity",    "visibility",
                                  "VWS",     "brightness",  "saturation", "cover"};
    if (pictured) head.emplace_back("2DFS");
    if (shares) head.emplace_back("part");
    Table table(head);
    for (std::size_t i = 0; i < tf.features.size(); ++i) {
        const FeatureMeasures& f = m.features[i];
        std::vector<std::string> row{names[i],
                                     fixedText(tf.features[i].a, 3) + " .. " + fixedText(tf.features[i].b, 3),
                                     fixedText(m.opacities[i], 4),
                                     fixedText(f.visibility, 4),
                                     fixedText(f.vws, 4),
                                     fixedText(f.vwsBrightness, 4),
                                     fixedText(f.vwsSaturation, 4),
                                     fixedText(m.coverage->covers[i], 4)};
        if (pictured) row.push_back(fixedText(pictured->shares[i], 4));
        if (shares) row.push_back(fixedText(shares->features[i], 4));
        table.add(row);
    }
    const std::string features = tf.features.empty()
                                     ? "the transfer function has no features\n"
                                     : table.text() + "coverage " + fixedText(m.coverage->coverage, 4) + "\n" +
                                           (pictured ? sizeText(*pictured) : "") +
                                           (shares ? sharesText(*shares, scene.overlay != nullptr) : "");
    return features + textOf(tf, matrices.jacobian, "dVWS / dopacity of") +
           textOf(tf, matrices.occlusion, "part hidden by") + "engine " + engine + profile + ": visibility " +
           secondsText(seconds.visibility) + ", saliency " + secondsText(seconds.saliency) +
           (seconds.jacobian ? ", jacobian " + secondsText(*seconds.jacobian) : "") +
           (seconds.shares ? ", shares " + secondsText(*seconds.shares) : "") +
           (seconds.fs ? ", pictures " + secondsText(*seconds.pictures) + ", 2DFS " + secondsText(*seconds.fs) : "") +
           ", total " + secondsText(seconds.total) + "\n";
}

Json jsonOf(const Scene& scene, const Found& found) {
    const auto& [m, matrices, pictured, shares, engine, seconds] = found;
    const TransferFunction& tf = scene.tf;
    Json features = Json::array();
    for (std::size_t i = 0; i < tf.features.size(); ++i) {
        const FeatureMeasures& f = m.features[i];
        features.push_back({{"name", tf.features[i].name},
                            {"range", {tf.features[i].a, tf.features[i].b}},
                            {"empty", scene.isEmpty(i)},
                            {"opacity", m.opacities[i]},
                            {"visibility", f.visibility},
                            {"vws", f.vws},
                            {"vws_brightness", f.vwsBrightness},
                            {"vws_saturation", f.vwsSaturation},
                            {"cover", m.coverage->covers[i]}});
        if (pictured) features.back()["fs"] = pictured->shares[i];
        if (shares) features.back()["picture_share"] = shares->features[i];
    }
    Json json{{"command", "measure"},
              {"engine", engine},
              {"volume", jsonFromVolume(*scene.volume)},
              {"features", features},
              {"coverage", m.coverage->coverage},
              {"visibility_histogram", m.visibilityHistogram}};
    if (scene.session.measure->profile == Profile::Default)
        json.update(jsonFromView(scene.camera, scene.volume->geometry()));
    if (matrices.jacobian) json["jacobian"] = *matrices.jacobian;
    if (matrices.occlusion) json["occlusion"] = *matrices.occlusion;
    if (pictured) {
        Json& picture = json["picture"];
        picture["size"] = {pictured->width, pictured->height};
        picture["lit"] = pictured->lit;
        picture["engine"] = pictured->renderer;
        if (!pictured->files.empty()) picture["files"] = pictured->files;
    }
    if (shares) {
        json["picture_shares"] = {{"alpha", shares->alpha}, {"rest", shares->rest}};
        if (scene.overlay) json["picture_shares"]["overlay"] = shares->overlay;
    }
    Json& times = json["seconds"] = {{"visibility", seconds.visibility}, {"saliency", seconds.saliency}};
    if (seconds.jacobian) times["jacobian"] = *seconds.jacobian;
    if (seconds.fs) {
        times["pictures"] = *seconds.pictures;
        times["fs"] = *seconds.fs;
    }
    if (seconds.shares) times["shares"] = *seconds.shares;
    times["total"] = seconds.total;
    return json;
}

/// As a picture: what is brighter than white is white.
Plane strengthened(Plane plane, double strength) {
    for (float& value : plane.values) value = std::clamp(static_cast<float>(strength) * value, 0.0f, 1.0f);
    return plane;
}

/// The files of --maps, and what writes each (figs A.1 to A.5).
std::vector<std::pair<std::string, std::function<void(const std::string&)>>>
filesOf(const FeaturePictures& pictures, const FeatureSaliency& saliency, std::optional<double> strength) {
    std::vector<std::pair<std::string, std::function<void(const std::string&)>>> files;
    const auto picture = [&](const std::string& name, const Image& image) {
        files.emplace_back(name + ".png", [&image](const std::string& path) {
            Image shown = image; // its colours are those over the background
            for (std::size_t i = 3; i < shown.rgba.size(); i += 4) shown.rgba[i] = 1;
            writeImage(shown, path);
        });
    };
    const auto map = [&](const std::string& name, const std::function<Plane()>& plane) {
        files.emplace_back(name + ".exr", [plane](const std::string& path) { writePlane(plane(), path); });
        if (strength)
            files.emplace_back(name + ".png",
                               [=](const std::string& path) { writePlane(strengthened(plane(), *strength), path); });
    };
    const auto kept = [&](const std::string& name, const Plane& plane) { map(name, [&plane] { return plane; }); };
    picture("picture", pictures.whole);
    kept("saliency", saliency.map);
    kept("rest", saliency.rest);
    for (std::size_t f = 0; f < saliency.shares.size(); ++f) {
        const std::string feature = "feature" + std::to_string(f + 1);
        picture(feature, pictures.alone[f]);
        kept(feature + "_shared", saliency.shared[f]);
        kept(feature + "_influence", saliency.influence[f]);
        kept(feature + "_rest", saliency.spread[f]);
        map(feature + "_total", [&saliency, f] { return totalOf(saliency, f); });
    }
    return files;
}

std::vector<std::string> writeMaps(const std::string& folder, const FeaturePictures& pictures,
                                   const FeatureSaliency& saliency, std::optional<double> strength) {
    const auto files = filesOf(pictures, saliency, strength);
    for (const auto& [name, write] : files) addOutputFile(folder, name, "--maps");
    const OutputFolder made(folder);
    std::vector<std::string> paths;
    for (const auto& [name, write] : files) {
        paths.push_back((std::filesystem::path(folder) / name).string());
        write(paths.back());
    }
    return paths;
}

PictureInput pictureOf(const MeasureArguments& o, const Scene& scene) {
    PictureOptions options = o.scene.picture;
    options.size = o.size.value_or(ImageSize{});
    return options.pictureOf(scene);
}

PictureShares sharesOf(const MeasureArguments& o, const Scene& scene, MeasureSeconds& seconds, Progress& progress) {
    const PictureInput picture = pictureOf(o, scene);
    const auto renderer = makeRenderer(scene.session.measure->engine, picture.volume);
    const Stopwatch drawing;
    PictureShares shares =
        pictureShares(*renderer, picture.camera, picture.tf, picture.settings, progress.phase("shares"));
    seconds.shares = drawing.seconds();
    return shares;
}

Pictured look(const MeasureArguments& o, const Scene& scene, MeasureSeconds& seconds, Progress& progress) {
    const PictureInput picture = pictureOf(o, scene);
    const auto renderer = makeRenderer(scene.session.measure->engine, picture.volume);
    const Stopwatch drawing;
    const FeaturePictures pictures =
        featurePictures(*renderer, picture.camera, picture.tf, picture.settings, progress.phase("rendering"));
    seconds.pictures = drawing.seconds();
    const Stopwatch looking;
    const FeatureSaliency saliency = featureSaliency(pictures, progress.phase("2D saliency"));
    seconds.fs = looking.seconds();
    Pictured pictured{saliency.shares,           picture.settings.width, picture.settings.height,
                      picture.settings.light.on, renderer->name(),       {}};
    if (o.maps) pictured.files = writeMaps(*o.maps, pictures, saliency, o.mapStrength);
    return pictured;
}

Answer run(const MeasureArguments& o, Progress& progress) {
    const Stopwatch total;
    o.check();
    const Opened opened = resolve(o.scene, progress, {toMeasure("measuring"), true});
    const MeasureInput input = measureInput(opened.scene);
    Workspace workspace;
    Found found;
    MeasureSeconds& seconds = found.seconds;
    const Prepared prepared = prepare(workspace, input, progress);
    found.engine = prepared.engine;
    seconds.saliency = prepared.saliencySeconds;

    found.measures = workspace.measure(input, progress.phase("visibility"));
    seconds.visibility = workspace.seconds().visibility;
    found.measures.coverage = workspace.coverage(input, progress.phase("coverage"));
    if (o.jacobian) {
        found.matrices.jacobian = workspace.jacobian(input, progress.phase("derivatives"));
        seconds.jacobian = workspace.seconds().visibility;
    }
    if (o.occlusion) found.matrices.occlusion = workspace.occlusion(input, progress.phase("occlusion"));
    if (o.pictured) found.pictured = look(o, opened.scene, seconds, progress);
    if (o.shares) found.shares = sharesOf(o, opened.scene, seconds, progress);
    seconds.total = total.seconds();
    Json json = jsonOf(opened.scene, found);
    addProfile(json, input.settings);
    addMapping(json, opened.scene);
    std::string text = textOf(opened.scene, found, profileText(input.settings));
    if (o.bars) {
        writeShareCharts(shareBarsOf(opened.scene.tf, found.measures.features,
                                     found.pictured ? found.pictured->shares : std::vector<double>()),
                         *o.bars);
        text += "wrote " + *o.bars + "\n";
        json["bars"] = *o.bars;
    }
    return {std::move(text), std::move(json), opened.notices()};
}

} // namespace

Command addMeasure(CLI::App& program) {
    CLI::App* app = program.add_subcommand("measure", "Visibility and visibility-weighted saliency of each feature");
    const auto o = std::make_shared<MeasureArguments>();
    o->scene.addForFigures(*app, VolumeOptions::SizeIs::Image);
    app->add_flag("--jacobian", o->jacobian,
                  "also print the derivatives of each VWS with respect to each feature's opacity");
    app->add_flag("--occlusion", o->occlusion,
                  "also print how much of each feature's visibility every other feature takes away");
    app->add_flag(
        "--2dfs", o->pictured,
        "also print each feature's 2D feature saliency: its share of what catches the eye in the picture that "
        "render draws with the same options");
    app->add_flag("--shares", o->shares,
                  "also print what part of the picture's opacity each feature has, and the overlay where there is one");
    o->scene.volume.addSizeOfBoth(
        *app, [o](const ImageSize& size) { o->size = size; },
        "WxH: pixels of the picture that --2dfs and --shares look at (default 512x512); N: as --sample-size");
    addOutputFolder(*app, "--maps", o->maps,
                    "folder for the pictures of --2dfs (PNG) and its maps (EXR, floats): saliency, rest and, for each "
                    "feature, shared, influence, rest, total; made where missing");
    addValue(*app, "--map-strength", "K", o->mapStrength, realAbove(0, 1e6),
             "also write the maps of --maps as PNG, multiplied by K; white stands for 1 and more");
    addOutputFile(
        *app, "--bars", o->bars,
        "write visibility and VWS, also of brightness and of saturation alone, as bar charts in the features' "
        "colours: .svg or .png",
        [](const std::string& path) { checkDrawingSuffix(path, "bars"); });
    const std::vector<CLI::Option*> others = app->get_options();
    o->scene.picture.addLook(*app);
    o->scene.ground.add(*app);
    o->scene.overlay.add(*app);
    for (CLI::Option* option : app->get_options())
        if (std::ranges::find(others, option) == others.end()) o->ofPicture.push_back(option);
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
