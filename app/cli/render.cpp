// `render`: the picture of a volume as a file.
#include <algorithm>
#include <filesystem>

#include "commands.h"
#include "inputs.h"
#include "output_files.h"
#include "parse.h"
#include "render/image_renderer.h"

namespace pellucid::cli {

namespace {

struct Options {
    VolumeOptions volume;
    TfOptions tf;
    CameraOptions camera;
    EngineOptions engine;
    std::string out;
    ImageSize size;
    std::optional<Rgb> background = Rgb{0, 0, 0};
    std::optional<double> step;
    bool shading = false;
    std::vector<Clip> clips;
    std::optional<std::string> feature;
};

bool isJpeg(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix == ".jpg" || suffix == ".jpeg";
}

/// What can be told before the volume is read.
void check(const Options& o) {
    requireFileName(o.out, "--out");
    checkImageSuffix(o.out);
    if (!o.background && isJpeg(o.out))
        throw UsageError("a JPEG file holds no transparency", "--background transparent",
                         "write a PNG, TIFF or EXR file");
    checkOutputFile(o.out, "--out", inputFiles(o.volume, o.tf, o.camera));
    o.camera.check();
}

/// Index of the feature of this name.
int featureIndex(const TransferFunction& tf, const std::string& name) {
    std::string known;
    for (std::size_t i = 0; i < tf.features.size(); ++i) {
        if (tf.features[i].name == name) return static_cast<int>(i);
        known += (known.empty() ? "'" : ", '") + tf.features[i].name + "'";
    }
    throw UsageError("no feature is named '" + name + "'", "--feature",
                     known.empty() ? "leave it out: this transfer function has none" : "known: " + known);
}

RenderSettings settingsOf(const Options& o, const TransferFunction& tf) {
    RenderSettings settings;
    settings.width = o.size.width;
    settings.height = o.size.height;
    settings.background = o.background;
    settings.stepInD0 = o.step.value_or(o.engine.quality == Quality::High ? 0.25 : 0.5);
    settings.shading = o.shading;
    for (const Clip& clip : o.clips) {
        settings.clipLo[clip.axis] = std::max(settings.clipLo[clip.axis], clip.lo);
        settings.clipHi[clip.axis] = std::min(settings.clipHi[clip.axis], clip.hi);
        if (!(settings.clipLo[clip.axis] < settings.clipHi[clip.axis]))
            throw UsageError("nothing is left between the clips of one axis", "--clip", "let them overlap");
    }
    if (o.feature) settings.onlyFeature = featureIndex(tf, *o.feature);
    settings.validate();
    return settings;
}

Answer run(const Options& o, Progress& progress) {
    const Stopwatch total;
    check(o);
    const auto [volume, tf] = loadVolumeAndTf(o.volume, o.tf, progress, {"drawing", kViewBytesPerVoxel});
    const Camera camera = o.camera.camera(volume->geometry());
    const RenderSettings settings = settingsOf(o, tf);
    const auto renderer = makeRenderer(o.engine.choice, volume);
    const Stopwatch drawing;
    const Image image = renderer->render(camera, tf, settings, progress.phase("rendering"));
    const double renderSeconds = drawing.seconds();
    progress.phase("writing");
    writeImage(image, o.out);

    Json json{{"command", "render"},
              {"engine", renderer->name()},
              {"volume", jsonFromVolume(*volume)},
              {"file", o.out},
              {"size", {image.width, image.height}},
              {"seconds", {{"render", renderSeconds}, {"total", total.seconds()}}}};
    return {"wrote " + o.out + ": " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                " pixels, engine " + renderer->name() + ", " + secondsText(renderSeconds) + "\n",
            std::move(json),
            volume->notices,
            {}};
}

} // namespace

Command addRender(CLI::App& program) {
    CLI::App* app = program.add_subcommand("render", "Writes the picture of a volume");
    const auto o = std::make_shared<Options>();
    o->volume.add(*app, VolumeOptions::SizeIs::Image);
    o->tf.add(*app);
    o->camera.add(*app);
    o->engine.add(*app, "high: samples at half the distance along each ray (unless --step is given)");
    addValue(
        *app, "--out", "FILE", [o](const std::string& text, const std::string&) { o->out = text; },
        "the picture to write: .png, .tif, .exr or .jpg")
        ->required();
    addValue(
        *app, "--size", "WxH",
        [o](const std::string& text, const std::string& option) { o->size = parseImageSize(text, option); },
        "pixels (default 512x512)");
    addValue(
        *app, "--background", "R,G,B|transparent",
        [o](const std::string& text, const std::string& option) {
            if (text == "transparent")
                o->background.reset();
            else
                o->background = parseColor(text, option);
        },
        "components from 0 to 1, #rrggbb or transparent (default 0,0,0)");
    addValue(
        *app, "--step", "D",
        [o](const std::string& text, const std::string& option) { o->step = parseRealAbove(text, option, 0, 16); },
        "largest distance of samples in reference lengths, the smallest voxel spacing (default 0.5)");
    app->add_flag("--shading", o->shading, "light from the eye, by the gradient");
    addRepeated(
        *app, "--clip", "x:A:B",
        [o](const std::string& text, const std::string& option) { o->clips.push_back(parseClip(text, option)); },
        "draw only this part of the box along x, y or z, in fractions from 0 to 1");
    addValue(
        *app, "--feature", "NAME", [o](const std::string& text, const std::string&) { o->feature = text; },
        "draw the voxels of this feature alone");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
