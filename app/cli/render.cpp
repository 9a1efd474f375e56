// `render`: the picture of a volume as a file.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "commands.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "options/slice_options.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "render/annotation_raster.h"
#include "render/memory_needs.h"
#include "resolve.h"

namespace pellucid::cli {

namespace {

struct Options {
    SceneOptions scene;
    SliceOptions slice;
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
    if (o.scene.picture.transparent && isJpeg(o.out))
        throw UsageError("a JPEG file cannot be transparent", "--background transparent",
                         "write a PNG, TIFF or EXR file");
    o.slice.check();
    if (o.slice.at && o.annotate.any())
        throw UsageError("a slice is drawn without a frame of reference", "--annotate", "leave it out");
    const bool field = o.scene.field.isGiven();
    if (o.slice.at && o.scene.picture.feature && !field)
        throw UsageError("a slice always shows all features", "--feature", "leave it out");
    const char* const ofData = o.slice.window                     ? "--window"
                               : o.slice.given.has("tf_strength") ? "--tf-strength"
                                                                  : nullptr;
    if (field && ofData != nullptr)
        throw UsageError("a field does not use the colours of the transfer function", ofData,
                         "use --field-top or --field-colormap");
    if (field && o.scene.picture.given.has("mode"))
        throw UsageError("a field is always drawn by emission and absorption", "--mode", "leave it out");
    if (o.slice.at && o.scene.ground.path)
        throw UsageError("a slice is drawn without the ground", "--ground", "leave it out");
    if (field && o.scene.ground.path)
        throw UsageError("a field is drawn without the ground", "--ground", "leave it out");
    if (o.slice.at && o.scene.picture.given.has("mode"))
        throw UsageError("a slice has no rays, so it has no mode", "--mode", "leave it out");
}

/// What shows where the picture is transparent.
void paintBackground(Image& image, const RenderSettings& settings) {
    if (!settings.background) return;
    const Rgb bottom = *settings.background, top = settings.backgroundTop.value_or(bottom);
    for (int y = 0; y < image.height; ++y) {
        const double up = 1 - (y + 0.5) / image.height;
        const double behind[3] = {bottom.r + up * (top.r - bottom.r), bottom.g + up * (top.g - bottom.g),
                                  bottom.b + up * (top.b - bottom.b)};
        for (int x = 0; x < image.width; ++x) {
            float* pixel = image.pixel(x, y);
            const auto alpha = static_cast<double>(pixel[3]);
            for (int c = 0; c < 3; ++c)
                pixel[c] = static_cast<float>(alpha * static_cast<double>(pixel[c]) + (1 - alpha) * behind[c]);
            pixel[3] = 1;
        }
    }
}

/// The field that the session and the options want drawn; empty: the data. A session's is of views, not of slices.
std::optional<Field> fieldOf(const Options& o, const Scene& scene, Progress& progress) {
    const FieldView& view = *scene.session.field;
    if (!view.kind || (o.slice.at && !o.scene.field.isGiven())) return {};
    Workspace workspace;
    const MeasureInput input = measureInput(scene);
    if (dependsOnView(*view.kind)) {
        prepare(workspace, input, progress);
        return workspace.field(input, *view.kind, scene.fieldFeature(), progress.phase("field"));
    }
    return workspace.field(input, *view.kind, scene.fieldFeature(), progress.phase("saliency"));
}

Json jsonFromField(const Scene& scene, const Field& field) {
    const FieldView& view = *scene.session.field;
    Json json{{"kind", name(*view.kind)},    {"color_map", view.colorMap}, {"strength", view.strength},
              {"threshold", view.threshold}, {"top", topOf(view, field)},  {"largest", field.volume->dataRange().hi}};
    if (const int f = scene.fieldFeature(); f >= 0)
        json["feature"] = scene.tf.features[static_cast<std::size_t>(f)].name;
    return json;
}

Answer drawSlice(const Options& o, const Opened& opened, const PictureInput& picture, const Stopwatch& total,
                 Progress& progress) {
    const Geometry& g = picture.volume->geometry();
    const SlicePlane plane = o.slice.planeOf(g, picture.settings.width, picture.settings.height);
    SliceSettings settings = o.slice.settingsOf(opened.scene);
    settings.clipping = picture.settings.clipping;
    settings.colors = picture.settings.colors;
    if (o.scene.field.isGiven()) {
        settings.tfStrength = 1;
        settings.window = picture.volume->range();
    }
    const Stopwatch drawing;
    Image image = renderSlice(*picture.volume, picture.tf, plane, settings);
    paintBackground(image, picture.settings);
    const double renderSeconds = drawing.seconds();
    progress.phase("writing");
    writeImage(image, o.out);
    Json json{{"command", "render"},
              {"volume", jsonFromVolume(*opened.scene.volume)},
              {"file", o.out},
              {"size", {image.width, image.height}},
              {"slice",
               {{"axis", std::string(1, "xyz"[plane.axis])},
                {"name", sliceName(g, plane.axis)},
                {"position", o.slice.at->fraction},
                {"voxel", plane.position},
                {"window", jsonFromRange(settings.window)},
                {"tf_strength", settings.tfStrength}}},
              {"seconds", {{"render", renderSeconds}, {"total", total.seconds()}}}};
    return {"wrote " + o.out + ": " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                " pixels, slice " + sliceName(g, plane.axis) + ", " + secondsText(renderSeconds) + "\n",
            std::move(json),
            opened.notices(),
            {}};
}

Answer drawView(const Options& o, const Opened& opened, const PictureInput& picture, const std::optional<Field>& field,
                const Stopwatch& total, Progress& progress) {
    const auto renderer = makeRenderer(opened.scene.session.measure->engine, picture.volume);
    const Stopwatch drawing;
    Image image = renderer->render(picture.camera, picture.tf, picture.settings, progress.phase("rendering"));
    const double renderSeconds = drawing.seconds();
    if (o.annotate.any())
        drawMarks(image, annotationMarks(field ? fieldAnnotationInput(picture, opened.scene, *field, o.annotate)
                                               : annotationInput(picture, o.annotate)));
    progress.phase("writing");
    writeImage(image, o.out);

    Json json{{"command", "render"},
              {"engine", renderer->name()},
              {"volume", jsonFromVolume(*opened.scene.volume)},
              {"file", o.out},
              {"size", {image.width, image.height}},
              {"seconds", {{"render", renderSeconds}, {"total", total.seconds()}}}};
    return {"wrote " + o.out + ": " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                " pixels, engine " + renderer->name() + ", " + secondsText(renderSeconds) + "\n",
            std::move(json),
            opened.notices(),
            {}};
}

Answer run(const Options& o, Progress& progress) {
    const Stopwatch total;
    check(o);
    const bool field = o.scene.field.isGiven();
    const Opened opened = resolve(o.scene, progress, {field ? toMeasureAndDrawField() : toView("drawing"), field});
    const Scene& scene = opened.scene;
    PictureInput picture = o.scene.picture.pictureOf(scene);
    const std::optional<Field> shown = fieldOf(o, scene, progress);
    if (shown) {
        const RenderSettings& s = picture.settings;
        picture = fieldPictureInput(scene, *shown, s.width, s.height, o.scene.picture.transparent);
        o.scene.picture.applyTo(picture);
        if (o.slice.at) picture.tf = fieldSliceTf(picture.tf);
    }
    Answer answer = o.slice.at ? drawSlice(o, opened, picture, total, progress)
                               : drawView(o, opened, picture, shown, total, progress);
    if (Json mapping = jsonFromMapping(scene); !mapping.is_null()) answer.json["hsb"] = std::move(mapping);
    if (shown) answer.json["field"] = jsonFromField(scene, *shown);
    return answer;
}

} // namespace

Command addRender(CLI::App& program) {
    CLI::App* app = program.add_subcommand("render", "Writes the picture of a volume");
    const auto o = std::make_shared<Options>();
    o->scene.volume.add(*app, VolumeOptions::SizeIs::Image);
    o->scene.variables.add(*app);
    o->scene.session.add(*app);
    o->scene.tf.add(*app);
    o->scene.camera.add(*app);
    o->scene.clip.add(*app);
    o->scene.engine.add(*app);
    addOutputFile(
        *app, "--out", "FILE", [o](const std::string& path) { o->out = path; },
        "the picture to write: .png, .tif, .exr or .jpg", checkImageSuffix)
        ->required();
    o->scene.picture.add(*app);
    o->scene.ground.add(*app);
    o->slice.add(*app);
    o->scene.field.add(*app);
    o->scene.saliency.add(*app);
    addValue(
        *app, "--annotate", "PARTS",
        [o](const std::string& text, const std::string& option) { o->annotate = parseParts(text, option); },
        "draw the frame of reference over the picture: all, or some of cube, letters, axes, scale, legend, title with "
        "commas between");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
