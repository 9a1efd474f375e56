#include "figure/figure_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "base/atomic_file.h"
#include "base/text.h"
#include "engines/engines.h"
#include "figure/print.h"
#include "figure/svg_figure.h"
#include "session/caption.h"

namespace pellucid {

namespace {

constexpr std::size_t kLongestName = 200; // bytes; what goes on has "…" at its end

std::string suffixOf(const std::string& path) { return lowerCase(std::filesystem::path(path).extension().string()); }

/// On one line, and not for pages.
std::string shownName(const std::string& name) {
    std::string text = printable(name);
    if (text.size() <= kLongestName) return text;
    std::size_t end = kLongestName;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end; // whole characters
    return text.substr(0, end) + "…";
}

/// Names in sentences, too, are cut.
Scene withShownNames(Scene scene) {
    for (Feature& feature : scene.tf.features) feature.name = shownName(feature.name);
    return scene;
}

/// What is drawn: hidden features, those without a voxel and, where one is drawn alone, the others have no row.
std::vector<FigureRow> rowsOf(const Scene& scene, const PictureInput& picture, const Measures* measures,
                              bool targeted) {
    std::vector<FigureRow> rows;
    if (!isColored(picture.settings.mode)) return rows;
    const std::vector<double> opacities = featureOpacities(scene.tf), targets = scene.targets();
    const int alone = picture.settings.onlyFeature;
    for (std::size_t f = 0; f < scene.tf.features.size(); ++f) {
        const Feature& feature = scene.tf.features[f];
        if (feature.hidden || scene.isEmpty(f) || (alone >= 0 && static_cast<std::size_t>(alone) != f)) continue;
        FigureRow row{.name = feature.name, .color = feature.color, .opacity = opacities[f]};
        if (measures != nullptr) {
            row.vws = measures->features[f].vws;
            row.visibility = measures->features[f].visibility;
            if (targeted) row.target = targets[f];
        }
        rows.push_back(row);
    }
    return rows;
}

AnnotationInput aroundOf(const PictureInput& picture, const FigureContent& content, const Scene& scene,
                         const JobControl& job) {
    AnnotationInput around = annotationInput(picture, AnnotationChoice::none(), annotationDensity(content.settings));
    if (!around.picture.background) around.picture.background = Rgb{1, 1, 1}; // paper
    if (figurePartsOf(content.settings.parts).measures)
        addMeasures(around, scene, readRulers(*scene.session.rulers, *scene.data, job));
    else
        addMeasures(around, scene, {});
    return around;
}

} // namespace

std::string fontNotice(const std::string& font) {
    static constexpr std::array<std::string_view, 10> kGeneric{"sans",  "sans-serif", "serif",   "monospace", "mono",
                                                               "emoji", "cursive",    "fantasy", "system-ui", "math"};
    const auto plain = [](std::string name) { // fontconfig compares families without blanks
        std::erase(name, ' ');
        return lowerCase(name);
    };
    const std::vector<std::string> taken = familyOf(font);
    const auto isTaken = [&](const std::string& name) {
        return std::ranges::any_of(taken, [&](const std::string& other) { return plain(other) == plain(name); });
    };
    std::vector<std::string> wanted;
    for (const std::string& family : splitAt(',', font)) {
        const std::string name = trimmed(family);
        if (name.empty()) continue;
        if (isTaken(name) || std::ranges::find(kGeneric, plain(name)) != kGeneric.end()) return {};
        wanted.push_back(printable(name));
    }
    if (wanted.empty() || taken.empty()) return {};
    return (wanted.size() == 1 ? "the font " + wanted[0] + " is not"
                               : "none of the fonts " + joined(wanted, ", ") + " is") +
           " installed: " + printable(taken.front()) + " is used instead";
}

void checkFigureSuffix(const std::string& path) {
    const std::string suffix = suffixOf(path);
    if (suffix != ".svg" && suffix != ".pdf")
        throw UsageError("figures are written as .svg or .pdf", path, "give one of these suffixes");
}

void checkFigure(const FigureTask& task) {
    if (task.scene.session.field->kind)
        throw Error("a figure shows the data, and a field is shown in their place", task.scene.volume->title,
                    "switch the field off");
    checkSettings(task.settings, "figure");
    const FigurePixels pixels = figurePixels(task.settings);
    if (std::max(pixels.width, pixels.height) > kMostPixels)
        throw UsageError("the picture would have " + std::to_string(pixels.width) + " x " +
                             std::to_string(pixels.height) + " pixels, and at most " + std::to_string(kMostPixels) +
                             " are drawn along a side",
                         "", "take fewer dots per inch, or make it smaller");
}

FigureContent figureContent(const FigureTask& task, Workspace& workspace, const JobControl& job) {
    checkFigure(task);
    Scene scene = withShownNames(task.scene);
    const FigureParts parts = figurePartsOf(task.settings.parts);
    const FigurePixels pixels = figurePixels(task.settings);
    FigureContent content;
    content.settings = task.settings;
    content.picture = pictureInput(scene, pixels.width, pixels.height);
    content.picture.settings = task.look;
    content.picture.settings.width = pixels.width;
    content.picture.settings.height = pixels.height;
    content.picture.settings.validate();

    const bool measured = task.look.mode == RenderMode::Composite && !scene.tf.features.empty();
    Measures measures;
    OcclusionMatrix occlusion;
    if (measured) {
        const MeasureInput input = measureInput(scene);
        workspace.weights(input, job.part(0, 4));
        measures = workspace.measure(input, job.part(1, 4));
        if (parts.caption) {
            measures.coverage = workspace.coverage(input, {job.stop, {}});
            occlusion = workspace.occlusion(input, {job.stop, {}});
        }
    }
    const auto renderer = makeRenderer(scene.session.measure->engine, content.picture.volume);
    content.image = std::make_shared<const Image>(renderer->render(content.picture.camera, content.picture.tf,
                                                                   content.picture.settings,
                                                                   job.part(measured ? 2 : 0, measured ? 4 : 2)));
    content.around = aroundOf(content.picture, content, scene, {job.stop, {}});
    content.rows = rowsOf(scene, content.picture, measured ? &measures : nullptr, parts.targets);
    if (parts.colors && !scene.unit) prepareToShow(scene, {job.stop, {}}); // it finds out
    content.unit = printable(scene.unit.value_or(""));
    CaptionFacts facts = captionFacts(scene, measures, occlusion);
    facts.lit = task.look.light.on;
    facts.cut = !task.look.clipping.isNone();
    facts.mode = task.look.mode;
    facts.title = shownName(facts.title);
    content.title = task.settings.title.empty() ? facts.title : shownName(task.settings.title);
    if (parts.caption) content.caption = caption(facts);
    content.alt = altText(facts);
    return content;
}

FigureFile makeFigure(const FigureTask& task, const JobControl& job) {
    checkFigureSuffix(task.path);
    Workspace workspace;
    const FigureContent content = figureContent(task, workspace, job);
    workspace.releaseEngine();
    const Figure figure = layOut(content);
    const std::string bytes = suffixOf(task.path) == ".svg" ? svgOf(figure) : pdfOf(figure);
    job.throwIfStopped();
    writeTextAtomically(task.path, bytes);
    job.report(1);
    FigureFile file{figurePixels(task.settings),
                    figure.width,
                    figure.height,
                    content.rows,
                    figure.scale,
                    content.caption,
                    bytes.size(),
                    {}};
    if (std::string notice = fontNotice(task.settings.font); !notice.empty()) file.notices.push_back(std::move(notice));
    return file;
}

} // namespace pellucid
