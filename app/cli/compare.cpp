// `compare`: two pictures; or two transfer functions, views or frames, as pictures and figures.
#include <algorithm>
#include <filesystem>

#include "base/text.h"
#include "commands.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "render/feature_pictures.h"
#include "render/memory_needs.h"
#include "render/ssim.h"
#include "resolve.h"
#include "tf/color_difference.h"

namespace pellucid::cli {

namespace {

constexpr double kNoticed = 2.3; ///< ΔE that is just noticed

struct Options {
    std::string a, b;
    SceneOptions scene;
    CameraOptions viewOfB;
    std::optional<int> frameOfB;
    std::optional<std::string> difference, sideBySide;
};

/// One side: a picture and, unless it was a file, what it shows.
struct Side {
    Image image;
    std::vector<std::string> names; ///< of the features
    std::vector<double> opacity, fs;
    std::vector<FeatureMeasures> measures;
    std::vector<std::string> notices;
};

bool isPicture(const std::string& name) {
    const std::string suffix = lowerCase(std::filesystem::path(name).extension().string());
    const auto known = {".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg"};
    return std::ranges::find(known, suffix) != known.end();
}

bool isSession(const std::string& name) { return lowerCase(name).ends_with(".pellucid.json"); }

void check(const Options& o) {
    const bool a = isPicture(o.a), b = isPicture(o.b);
    if (a != b)
        throw UsageError("one is a picture and the other is not", o.a + " and " + o.b,
                         "name two pictures, or two transfer functions or sessions");
    refuse({{a && o.scene.volume.path.has_value(), "two pictures need no volume", "VOLUME", "leave it out"}});
}

Side drawn(const Options& o, bool isB, Progress& progress) {
    SceneOptions options = o.scene;
    const std::string& name = isB ? o.b : o.a;
    if (isSession(name))
        options.sessionFile = name;
    else
        options.tf.spec = name;
    if (isB && (o.viewOfB.view || o.viewOfB.namedView)) {
        options.camera.file.reset();
        options.camera.view = o.viewOfB.view;
        options.camera.namedView = o.viewOfB.namedView;
    }
    if (isB && o.frameOfB) options.volume.frame = o.frameOfB;
    const Opened opened = resolve(options, progress, {toMeasureAndDrawField(), true});
    const MeasureInput input = measureInput(opened.scene);
    Workspace workspace;
    prepare(workspace, input, progress);
    Side side;
    side.measures = workspace.measure(input, progress.phase("visibility")).features;
    side.opacity = featureOpacities(input.tf);
    side.names = namesWithEmpty(opened.scene.tf, *opened.scene.histogram);
    const PictureInput picture = options.picture.pictureOf(opened.scene);
    const auto renderer = makeRenderer(opened.scene.session.measure->engine, picture.volume);
    FeaturePictures pictures =
        featurePictures(*renderer, picture.camera, picture.tf, picture.settings, progress.phase("rendering"));
    side.fs = featureSaliency(pictures, progress.phase("2D saliency")).shares;
    side.image = std::move(pictures.whole);
    side.notices = opened.notices();
    return side;
}

/// Features of both by their names: index in each, −1 where it has none.
std::vector<std::pair<int, int>> pairsOf(const Side& a, const Side& b) {
    std::vector<std::pair<int, int>> pairs;
    const auto indexIn = [](const Side& side, const std::string& name) {
        const auto at = std::ranges::find(side.names, name);
        return at == side.names.end() ? -1 : static_cast<int>(at - side.names.begin());
    };
    for (std::size_t i = 0; i < a.names.size(); ++i) pairs.emplace_back(static_cast<int>(i), indexIn(b, a.names[i]));
    for (std::size_t i = 0; i < b.names.size(); ++i)
        if (indexIn(a, b.names[i]) < 0) pairs.emplace_back(-1, static_cast<int>(i));
    return pairs;
}

const std::string& nameOf(const std::pair<int, int>& pair, const Side& a, const Side& b) {
    return pair.first >= 0 ? a.names[static_cast<std::size_t>(pair.first)]
                           : b.names[static_cast<std::size_t>(pair.second)];
}

std::string tableOf(const Side& a, const Side& b) {
    Table table({"feature", "VWS A", "B", "visibility A", "B", "2DFS A", "B", "opacity A", "B"});
    for (const auto& pair : pairsOf(a, b)) {
        std::vector<std::string> row{nameOf(pair, a, b)};
        const auto add = [&](const auto& of) {
            row.push_back(pair.first >= 0 ? fixedText(of(a, static_cast<std::size_t>(pair.first)), 4) : "-");
            row.push_back(pair.second >= 0 ? fixedText(of(b, static_cast<std::size_t>(pair.second)), 4) : "-");
        };
        add([](const Side& s, std::size_t f) { return s.measures[f].vws; });
        add([](const Side& s, std::size_t f) { return s.measures[f].visibility; });
        add([](const Side& s, std::size_t f) { return s.fs[f]; });
        add([](const Side& s, std::size_t f) { return s.opacity[f]; });
        table.add(row);
    }
    return table.text();
}

Json featuresOf(const Side& a, const Side& b) {
    Json features = Json::array();
    const auto figures = [](const Side& s, int index) -> Json {
        if (index < 0) return nullptr;
        const auto f = static_cast<std::size_t>(index);
        return {{"vws", s.measures[f].vws},
                {"visibility", s.measures[f].visibility},
                {"fs", s.fs[f]},
                {"opacity", s.opacity[f]}};
    };
    for (const auto& pair : pairsOf(a, b))
        features.push_back(
            {{"name", nameOf(pair, a, b)}, {"a", figures(a, pair.first)}, {"b", figures(b, pair.second)}});
    return features;
}

Image beside(const Image& a, const Image& b) {
    Image both(a.width + b.width, a.height);
    for (int y = 0; y < a.height; ++y) {
        std::copy_n(a.pixel(0, y), 4 * a.width, both.pixel(0, y));
        std::copy_n(b.pixel(0, y), 4 * b.width, both.pixel(a.width, y));
    }
    return both;
}

Answer run(const Options& o, Progress& progress) {
    const Stopwatch total;
    check(o);
    const bool files = isPicture(o.a);
    const auto side = [&](bool isB) {
        const std::string& name = isB ? o.b : o.a;
        if (!files) return drawn(o, isB, progress);
        addInputFile(name);
        Side read;
        read.image = readImage(name);
        return read;
    };
    const Side a = side(false), b = side(true);
    if (a.image.width != b.image.width || a.image.height != b.image.height)
        throw Error("the pictures differ in size", o.a + " and " + o.b, "draw them in one size");
    const Plane map = deltaEOf(a.image, b.image);
    const double alike = ssim(a.image, b.image), mean = meanDeltaE(a.image, b.image);
    const auto largest = static_cast<double>(*std::ranges::max_element(map.values));
    const auto noticed = static_cast<double>(std::ranges::count_if(map.values, [](float d) { return d > kNoticed; })) /
                         static_cast<double>(map.values.size());
    std::string text = files ? "" : tableOf(a, b);
    text += "SSIM " + fixedText(alike, 4) + ", mean delta E " + fixedText(mean, 3) + ", largest " +
            fixedText(largest, 2) + ", " + fixedText(100 * noticed, 1) + " % of the pixels above 2.3\n";
    Json json{{"command", "compare"},
              {"a", o.a},
              {"b", o.b},
              {"size", {a.image.width, a.image.height}},
              {"ssim", alike},
              {"delta_e", {{"mean", mean}, {"largest", largest}, {"noticed", noticed}}}};
    if (!files) json["features"] = featuresOf(a, b);
    const auto wrote = [&](const std::string& path) {
        text += "wrote " + path + "\n";
        json["files"].push_back(path);
    };
    if (o.difference) {
        Plane shown = map; // as floats ΔE itself, as a picture white for the 100 from black to white
        if (!lowerCase(*o.difference).ends_with(".exr"))
            for (float& d : shown.values) d = std::min(1.0f, d / 100);
        writePlane(shown, *o.difference);
        wrote(*o.difference);
    }
    if (o.sideBySide) {
        writeImage(beside(a.image, b.image), *o.sideBySide);
        wrote(*o.sideBySide);
    }
    json["seconds"] = {{"total", total.seconds()}};
    Answer answer{std::move(text), std::move(json), a.notices};
    for (const std::string& notice : b.notices)
        if (std::ranges::find(a.notices, notice) == a.notices.end()) answer.notices.push_back(notice);
    return answer;
}

} // namespace

Command addCompare(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "compare", "How alike two pictures are; or two transfer functions, views or frames of a volume, with figures");
    const auto o = std::make_shared<Options>();
    app->add_option("A", o->a,
                    "a picture (.png, .tif, .exr, .jpg), a session (*.pellucid.json), or a transfer function of "
                    "VOLUME, as --tf of the other commands takes it")
        ->required()
        ->type_name("");
    app->add_option("B", o->b, "likewise")->required()->type_name("");
    o->scene.volume.add(*app, VolumeOptions::SizeIs::Image);
    o->scene.variables.add(*app);
    o->scene.camera.add(*app);
    o->scene.clip.add(*app);
    o->scene.engine.add(*app);
    o->scene.saliency.add(*app);
    o->viewOfB.addView(*app, "--view-b", "the view of B (default: that of A, or of its session)");
    addValue(*app, "--frame-b", "N", o->frameOfB, wholeFrom(0, 1'000'000'000),
             "the frame of B, from 0 (default: that of A, or of its session)");
    o->scene.picture.add(*app);
    o->scene.ground.add(*app);
    addOutputFile(*app, "--difference", o->difference,
                  "write delta E of each pixel: .exr (floats) or .png (16 bits, white at 100)", checkPlaneSuffix);
    addOutputFile(*app, "--side-by-side", o->sideBySide, "write both as one picture: .png, .tif, .exr or .jpg",
                  checkImageSuffix);
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
