// `render`: the picture of a volume as a file.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "commands.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "output_files.h"
#include "parse.h"
#include "render/annotation_raster.h"
#include "render/memory_needs.h"
#include "resolve.h"

namespace pellucid::cli {

namespace {

struct Options {
    SceneOptions scene;
    std::string out;
    FrameOfReference annotate = FrameOfReference::none();
};

/// "cube,scale" or "all".
FrameOfReference parseParts(const std::string& text, const std::string& option) {
    FrameOfReference show = FrameOfReference::none();
    std::istringstream words(text);
    bool known = !text.empty() && text.back() != ',';
    for (std::string word; known && std::getline(words, word, ',');) {
        known = word == "all";
        for (const FramePartInfo& part : kFrameParts)
            if (word == part.name || word == "all") known = show.*part.shown = true;
    }
    if (!known)
        throw UsageError("'" + text + "' does not name parts of the frame of reference", option,
                         "give all, or some of cube, letters, axes, scale, legend, title with commas between");
    return show;
}

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
    if (o.scene.picture.transparent && isJpeg(o.out))
        throw UsageError("a JPEG file holds no transparency", "--background transparent",
                         "write a PNG, TIFF or EXR file");
    checkOutputFile(o.out, "--out", inputFiles(o.scene));
}

Answer run(const Options& o, Progress& progress) {
    const Stopwatch total;
    check(o);
    const Opened opened = resolve(o.scene, progress, {toView("drawing")});
    const PictureInput picture = o.scene.picture.pictureOf(opened.scene);
    const auto renderer = makeRenderer(opened.scene.session.measure->engine, picture.volume);
    const Stopwatch drawing;
    Image image = renderer->render(picture.camera, picture.tf, picture.settings, progress.phase("rendering"));
    const double renderSeconds = drawing.seconds();
    if (o.annotate.any()) drawMarks(image, annotationMarks(annotationInput(picture, o.annotate)));
    progress.phase("writing");
    writeImage(image, o.out);

    Json json{{"command", "render"},
              {"engine", renderer->name()},
              {"volume", jsonFromVolume(*picture.volume)},
              {"file", o.out},
              {"size", {image.width, image.height}},
              {"seconds", {{"render", renderSeconds}, {"total", total.seconds()}}}};
    return {"wrote " + o.out + ": " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                " pixels, engine " + renderer->name() + ", " + secondsText(renderSeconds) + "\n",
            std::move(json),
            opened.notices(),
            {}};
}

} // namespace

Command addRender(CLI::App& program) {
    CLI::App* app = program.add_subcommand("render", "Writes the picture of a volume");
    const auto o = std::make_shared<Options>();
    o->scene.volume.add(*app, VolumeOptions::SizeIs::Image);
    o->scene.session.add(*app);
    o->scene.tf.add(*app);
    o->scene.camera.add(*app);
    o->scene.clip.add(*app);
    o->scene.engine.add(*app, "high: samples at half the distance along each ray (unless --step is given)");
    addValue(
        *app, "--out", "FILE", [o](const std::string& text, const std::string&) { o->out = text; },
        "the picture to write: .png, .tif, .exr or .jpg")
        ->required();
    o->scene.picture.add(*app);
    addValue(
        *app, "--annotate", "PARTS",
        [o](const std::string& text, const std::string& option) { o->annotate = parseParts(text, option); },
        "draw the frame of reference over the picture: all, or some of cube, letters, axes, scale, legend, title with "
        "commas between");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
