// `render`: the picture of a volume as a file.
#include <filesystem>

#include "base/memory.h"
#include "base/text.h"
#include "command_line.h"
#include "commands.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "image_io/layer_files.h"
#include "options/annotate_option.h"
#include "options/slice_options.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "render/annotation_raster.h"
#include "render/background.h"
#include "render/mark_maker.h"
#include "render/memory_needs.h"
#include "render/picture_layers.h"
#include "render/ruler_marks.h"
#include "report/session_picture.h"
#include "resolve.h"
#include "results_json.h"
#include "session/caption.h"
#include "tf/color_vision.h"

namespace pellucid::cli {

namespace {

/// Whose eyes the picture is for.
struct SimulatedVision {
    VisionKind vision = VisionKind::Normal;
    double severity = 1; ///< [0,1]
    bool operator==(const SimulatedVision&) const = default;
};

/// "deuteranopia", or "deuteranopia:0.6".
SimulatedVision parseVision(const std::string& text, const std::string& option) {
    const std::vector<std::string> parts = split(text, ':');
    if (parts.size() > 2)
        throw UsageError("'" + text + "' is not KIND or KIND:SEVERITY", option, "give such as deuteranopia:0.6");
    SimulatedVision simulated{parseName<VisionKind>(parts[0], option)};
    if (parts.size() == 2) simulated.severity = parseRealFrom(parts[1], option, 0, 1);
    return simulated;
}

struct RenderArguments {
    SceneOptions scene;
    SliceOptions slice;
    std::string out;    ///< empty: layers alone
    std::string layers; ///< empty: none
    bool caption = false, noMetadata = false;
    AnnotationChoice annotate = AnnotationChoice::none();
    bool preview = false;
    SimulatedVision vision;
};

bool isJpeg(const std::string& path) {
    const std::string suffix = lowerCase(std::filesystem::path(path).extension().string());
    return suffix == ".jpg" || suffix == ".jpeg";
}

/// What can be told before the volume is read.
void check(const RenderArguments& o) {
    const bool slice = o.slice.at.has_value(), field = o.scene.drawsField();
    const bool mode = o.scene.picture.given.has("mode"), ground = o.scene.ground.path.has_value();
    refuse({{o.scene.picture.transparent && isJpeg(o.out), "a JPEG file cannot be transparent",
             "--background transparent", "write a PNG, TIFF or EXR file"}});
    o.slice.check();
    if (o.out.empty() && o.layers.empty()) throw isRequired("--out", "render");
    const bool layers = !o.layers.empty();
    refuse({{layers && slice, "a slice has no layers", "--layers", "leave it out"},
            {layers && field, "a field has no layers", "--layers", "leave it out"},
            {layers && o.preview, "the quick picture has no layers", "--layers", "leave it out"},
            {o.caption && (slice || field), "a caption is of the data in a view", "--caption", "leave it out"},
            {o.caption && o.noMetadata, "a caption goes into the file", "--caption", "leave out --no-metadata"}});
    refuse({{o.preview && slice, "a slice has no preview", "--preview", "leave it out"}});
    refuse({{field && mode, "a field is always drawn by emission and absorption", "--mode", "leave it out"},
            {slice && ground, "a slice is drawn without the ground", "--ground", "leave it out"},
            {field && ground, "a field is drawn without the ground", "--ground", "leave it out"},
            {field && o.scene.overlay.path, "a field is drawn without the overlay", "--overlay", "leave it out"},
            {slice && mode, "a slice has no rays, so it has no mode", "--mode", "leave it out"}});
}

/// Everything that the annotations depend on. What spheres and boxes say is measured only where it is shown.
AnnotationInput annotationsOf(const RenderArguments& o, const Scene& scene, const PictureInput& picture,
                              const std::optional<Field>& field, Progress& progress) {
    AnnotationInput input =
        field ? fieldAnnotationInput(picture, scene, *field, o.annotate) : annotationInput(picture, o.annotate);
    const bool measures = o.annotate.measures && !scene.session.rulers->empty();
    addMeasures(input, scene,
                measures ? readRulers(*scene.session.rulers, *scene.data, progress.phase("measuring"))
                         : RulerReadings{});
    return input;
}

/// What can be told of a slice as soon as it is known whether the session, too, wants a field.
void checkSlice(const RenderArguments& o, bool field) {
    if (!o.slice.at) return;
    AnnotationChoice others = o.annotate;
    others.measures = false; // of slices of anything
    const bool ofView = others.any();
    others.legend = others.title = false;
    const char* const ofData = o.slice.lookOfData();
    refuse({{ofView && !field, "a slice of the data has no other annotations than measures", "--annotate",
             "give measures, or leave it out"},
            {others.any(), "a slice of a field has no other annotations than these", "--annotate",
             "give legend,title,measures, or leave it out"},
            {o.scene.picture.feature && !field, "a slice of the data always shows all features", "--feature",
             "leave it out"},
            {field && ofData != nullptr, "a field does not use the colours of the transfer function", ofData,
             "use --field-top or --field-colormap, or draw the data with --field none"}});
}

/// The field that the session and the options want drawn; empty: the data.
std::optional<Field> fieldOf(const Scene& scene, Progress& progress) {
    const FieldView& view = *scene.session.field;
    if (!view.kind) return {};
    Workspace workspace;
    const MeasureInput input = measureInput(scene);
    const bool ofView = dependsOnView(*view.kind);
    if (ofView) prepare(workspace, input, progress);
    return workspace.field(input, *view.kind, scene.fieldFeature(), progress.phase(ofView ? "field" : "saliency"));
}

Json jsonFromField(const Scene& scene, const Field& field) {
    const FieldView& view = *scene.session.field;
    Json json{{"kind", name(*view.kind)},    {"color_map", view.colorMap}, {"strength", view.strength},
              {"threshold", view.threshold}, {"top", topOf(view, field)},  {"largest", field.volume->dataRange().hi}};
    if (const int f = scene.fieldFeature(); f >= 0)
        json["feature"] = scene.tf.features[static_cast<std::size_t>(f)].name;
    return json;
}

/// A picture, and what is said of it.
struct Drawn {
    Image image;
    double seconds = 0;
    std::string engine = {}; ///< its name; empty: no engine has drawn it
    std::string order = {};  ///< of a preview: "slices" in storage order, else "rays"
    Json slice = nullptr;    ///< where it lies; null: it is none
};

Drawn drawSlice(const RenderArguments& o, const Scene& scene, const PictureInput& picture,
                const std::optional<Field>& field, Progress& progress) {
    const SliceInput input = o.slice.inputOf(scene, field ? &*field : nullptr);
    const Geometry& g = input.volume->geometry();
    const SlicePlane plane = o.slice.planeOf(g, picture.settings.width, picture.settings.height);
    const Stopwatch drawing;
    Drawn drawn{renderSlice(*input.volume, input.tf, plane, input.settings)};
    paintBackground(drawn.image, picture.settings);
    drawn.seconds = drawing.seconds();
    drawn.slice = {{"axis", std::string(1, "xyz"[plane.axis])},
                   {"name", sliceName(g, plane.axis)},
                   {"position", o.slice.at->fraction},
                   {"voxel", plane.position},
                   {"window", jsonFromRange(input.settings.window)},
                   {"tf_strength", input.settings.tfStrength}};
    if (!o.annotate.any()) return drawn;
    AnnotationInput around = annotationsOf(o, scene, picture, field, progress);
    if (around.show.measures) {
        const double cap = MarkMaker(plane.width, plane.height, around.density, {}).capHeight;
        drawMarks(drawn.image, rulerMarks(around.rulers, scene.data->geometry(), plane, {around.density, cap}));
    }
    around.show.measures = false; // they lie in the slice, not in the view
    if (field) drawMarks(drawn.image, annotationMarks(around));
    return drawn;
}

Drawn drawPicture(const Scene& scene, const PictureInput& picture, Progress& progress) {
    const auto renderer = makeRenderer(scene.session.measure->engine, picture.volume);
    const Stopwatch drawing;
    Drawn drawn{renderer->render(picture.camera, picture.tf, picture.settings, progress.phase("rendering"))};
    drawn.seconds = drawing.seconds();
    drawn.engine = renderer->name();
    return drawn;
}

/// What the window shows while the hand moves.
Drawn drawPreview(const PictureInput& picture, Progress& progress) {
    const auto renderer = makeCpuRenderer(picture.volume);
    const Stopwatch drawing;
    Drawn drawn{renderer->preview(picture.camera, picture.tf, picture.settings, 1, progress.phase("rendering"))};
    drawn.seconds = drawing.seconds();
    drawn.engine = renderer->name();
    drawn.order = renderer->previewsInStorageOrder(picture.camera, picture.settings) ? "slices" : "rays";
    return drawn;
}

/// Without figures in it, unless these are asked for.
CaptionFacts factsOf(const RenderArguments& o, const Scene& scene, Progress& progress) {
    if (!o.caption) return captionFacts(scene, {});
    Workspace workspace;
    const MeasureInput input = measureInput(scene);
    prepare(workspace, input, progress);
    Measures measures = workspace.measure(input, progress.phase("visibility"));
    measures.coverage = workspace.coverage(input, progress.phase("coverage"));
    return captionFacts(scene, measures, workspace.occlusion(input, progress.phase("occlusion")));
}

/// What a file of these, at `path`, says of itself. `slice`: the name of the one that it shows; empty: none.
PictureText textOf(const RenderArguments& o, const Scene& scene, const std::string& slice, const std::string& path,
                   Progress& progress) {
    if (o.noMetadata) return {};
    const CaptionFacts facts = factsOf(o, scene, progress);
    std::string description = slice.empty() ? caption(facts) : facts.title + ", slice " + slice + ".";
    if (const FieldView& view = *scene.session.field; view.kind)
        description += std::string(" Field: ") + name(*view.kind) + ".";
    const bool ofLayers = path == o.layers;
    const std::string out = (ofLayers ? "layers" : "picture") + std::filesystem::path(path).extension().string();
    return {"Pellucid " PELLUCID_VERSION, description, printable(pictureCommand(ofLayers ? "--layers" : "--out", out)),
            sessionText(scene, path)};
}

/// Draws and writes them. Throws UsageError where the picture has none.
void writeLayersOf(const RenderArguments& o, const Scene& scene, const PictureInput& picture, Progress& progress) {
    const RenderSettings& settings = picture.settings;
    checkLayers(picture.tf, settings);
    const double bytes = bytesOfLayers(settings.width, settings.height, picture.tf.features.size());
    requireMemory("layers of this size", o.layers, static_cast<std::uint64_t>(2 * bytes)); // and again for the file
    const PictureLayers layers =
        pictureLayers(picture.volume, picture.camera, picture.tf, settings, progress.phase("layers"));
    const PictureText text = textOf(o, scene, {}, o.layers, progress);
    writeLayers(layers, picture.tf.features, o.layers, text, progress.phase("writing"));
}

Drawn drawView(const RenderArguments& o, const Scene& scene, const PictureInput& picture,
               const std::optional<Field>& field, Progress& progress) {
    Drawn drawn = o.preview ? drawPreview(picture, progress) : drawPicture(scene, picture, progress);
    if (o.annotate.any()) drawMarks(drawn.image, annotationMarks(annotationsOf(o, scene, picture, field, progress)));
    return drawn;
}

/// Where nothing but layers is written.
Answer answerOfLayers(const RenderArguments& o, const Opened& opened, const PictureInput& picture, double seconds) {
    const RenderSettings& settings = picture.settings;
    Json json{{"command", "render"}, {"engine", "cpu"}, {"volume", jsonFromVolume(*opened.scene.volume)}};
    json["layers"] = o.layers;
    json["size"] = {settings.width, settings.height};
    json.update(jsonFromView(picture.camera, picture.volume->geometry()));
    json["seconds"] = {{"total", seconds}};
    return {"wrote " + o.layers + ": layers of " + std::to_string(settings.width) + " x " +
                std::to_string(settings.height) + " pixels, " + secondsText(seconds) + "\n",
            std::move(json), opened.notices()};
}

Answer run(const RenderArguments& o, Progress& progress) {
    const Stopwatch total;
    check(o);
    const bool field = o.scene.drawsField();
    if (field || !o.scene.sessionFile) checkSlice(o, field);
    const Opened opened = resolve(o.scene, progress,
                                  {field       ? toMeasureAndDrawField()
                                   : o.caption ? toMeasure("measuring")
                                   : o.preview ? toPreview("drawing")
                                               : toView("drawing"),
                                   field || o.caption});
    const Scene& scene = opened.scene;
    const EngineChoice engine = scene.session.measure->engine;
    refuse({{o.preview && o.scene.engine.given.has("engine") && engine != EngineChoice::Auto &&
                 engine != EngineChoice::Cpu,
             "only the cpu engine draws previews", "--preview", "give --engine cpu, or leave out --preview"}});
    PictureInput picture = o.scene.picture.pictureOf(scene);
    checkSlice(o, scene.session.field->kind.has_value());
    const std::optional<Field> shown = fieldOf(scene, progress);
    if (shown) {
        const RenderSettings& s = picture.settings;
        picture = fieldPictureInput(scene, *shown, s.width, s.height, o.scene.picture.transparent);
        o.scene.picture.applyTo(picture);
    }
    if (!o.layers.empty()) writeLayersOf(o, scene, picture, progress);
    if (o.out.empty()) return answerOfLayers(o, opened, picture, total.seconds());
    Drawn drawn =
        o.slice.at ? drawSlice(o, scene, picture, shown, progress) : drawView(o, scene, picture, shown, progress);
    simulateVision(drawn.image, visionMatrix(o.vision.vision, o.vision.severity));
    const PictureText text =
        textOf(o, scene, drawn.slice.is_null() ? "" : drawn.slice["name"].get<std::string>(), o.out, progress);
    progress.phase("writing");
    writeImage(drawn.image, o.out, text);

    const auto [width, height] = std::pair(drawn.image.width, drawn.image.height);
    const std::string how =
        drawn.slice.is_null() ? "engine " + drawn.engine : "slice " + drawn.slice["name"].get<std::string>();
    Json json{{"command", "render"}};
    if (!drawn.engine.empty()) json["engine"] = drawn.engine;
    if (o.preview) json["preview"] = drawn.order;
    json["volume"] = jsonFromVolume(*scene.volume);
    json["file"] = o.out;
    if (!o.layers.empty()) json["layers"] = o.layers;
    json["size"] = {width, height};
    if (drawn.slice.is_null())
        json.update(jsonFromView(picture.camera, picture.volume->geometry()));
    else
        json["slice"] = std::move(drawn.slice);
    json["seconds"] = {{"render", drawn.seconds}, {"total", total.seconds()}};
    addMapping(json, scene);
    if (o.vision != SimulatedVision())
        json["simulated_vision"] = {{"kind", name(o.vision.vision)}, {"severity", o.vision.severity}};
    if (shown) json["field"] = jsonFromField(scene, *shown);
    return {"wrote " + o.out + ": " + std::to_string(width) + " x " + std::to_string(height) + " pixels, " + how +
                ", " + secondsText(drawn.seconds) + "\n",
            std::move(json), opened.notices()};
}

} // namespace

Command addRender(CLI::App& program) {
    CLI::App* app = program.add_subcommand("render", "Writes the picture of a volume");
    const auto o = std::make_shared<RenderArguments>();
    o->scene.addForView(*app, VolumeOptions::SizeIs::Image);
    o->scene.engine.add(*app);
    o->scene.engine.addDefinitions(*app);
    addOutputFile(*app, "--out", o->out,
                  "the picture to write: .png, .tif, .exr or .jpg; it says of itself what --no-metadata leaves out",
                  checkImageSuffix);
    addValue(
        *app, "--layers", "FILE.exr|DIR", o->layers,
        [](const std::string& path, const std::string& option) {
            checkLayersPath(path);
            if (!isLayersFile(path)) return parseOutputFolder(path, option);
            addOutputFile(path, option);
            return path;
        },
        "write what the picture is made of: what each feature adds to every pixel, depth and normals, as one EXR file "
        "or as a folder of PNG files; without --out nothing else");
    app->add_flag("--caption", o->caption, "measure what the features show, and say it in the file, as describe does");
    app->add_flag("--no-metadata", o->noMetadata,
                  "write no caption, command and session into the file; they name the data files as seen from its "
                  "folder");
    o->scene.picture.add(*app);
    o->scene.ground.add(*app);
    o->scene.overlay.add(*app);
    o->slice.add(*app);
    o->scene.field.add(*app, "Field");
    o->scene.saliency.add(*app);
    addAnnotate(*app, o->annotate,
                "draw annotations over the picture: all, or some of cube, letters, axes, scale, legend, title, "
                "measures with commas between; measures are those of the session, and slices have them, too");
    o->scene.coordinates.add(*app);
    app->add_flag("--preview", o->preview,
                  "draw the quick picture that the window shows while the view turns, by the cpu renderer");
    addValue(*app, "--simulate-vision", "KIND[:S]", o->vision, parseVision,
             "draw the picture as a viewer with a colour-vision deficiency sees it: protanopia, deuteranopia, "
             "tritanopia or grey, of severity S from 0 to 1 (default 1); normal changes nothing");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
