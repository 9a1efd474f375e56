// `figure`: a scene as a figure for print.
#include "commands.h"
#include "figure/figure_file.h"
#include "options/setting_options.h"
#include "output_files.h"
#include "render/memory_needs.h"
#include "resolve.h"

namespace pellucid::cli {

namespace {

struct FigureArguments {
    SceneOptions scene;
    SettingOptions<FigureSettings> figure;
    std::string out;
};

Json jsonFromRows(const std::vector<FigureRow>& rows) {
    Json features = Json::array();
    for (const FigureRow& row : rows) {
        Json feature{{"name", row.name}, {"opacity", row.opacity}};
        if (row.vws) feature["vws"] = *row.vws;
        if (row.visibility) feature["visibility"] = *row.visibility;
        if (row.target) feature["target"] = *row.target;
        features.push_back(feature);
    }
    return features;
}

std::string millimetres(double length) { return fixedText(length, 1); }

Answer run(const FigureArguments& o, Progress& progress) {
    const Opened opened = resolve(o.scene, progress, {toMeasure("drawing the figure"), true});
    const Scene& scene = opened.scene;
    const FigureTask task{scene, o.scene.picture.pictureOf(scene).settings, o.figure.values(), o.out};
    const FigureFile figure = makeFigure(task, progress.phase("figure"));
    std::vector<std::string> notices = opened.notices();
    notices.insert(notices.end(), figure.notices.begin(), figure.notices.end());
    Json json{{"command", "figure"},
              {"file", o.out},
              {"bytes", figure.bytes},
              {"page_mm", {figure.width, figure.height}},
              {"pixels", {figure.pixels.width, figure.pixels.height}},
              {"features", jsonFromRows(figure.rows)},
              {"notices", notices},
              {"volume", jsonFromVolume(*scene.volume)}};
    if (figure.scale) json["scale"] = {{"mm", figure.scale->millimetres}, {"text", figure.scale->text}};
    if (!figure.caption.empty()) json["caption"] = figure.caption;
    return {"wrote " + o.out + ": " + millimetres(figure.width) + " x " + millimetres(figure.height) +
                " mm, the picture in " + std::to_string(figure.pixels.width) + " x " +
                std::to_string(figure.pixels.height) + " pixels\n",
            std::move(json), std::move(notices)};
}

} // namespace

Command addFigure(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "figure", "A figure for print: the picture with scale, legend and bars of shares as lines and letters");
    const auto o = std::make_shared<FigureArguments>();
    o->scene.addForFigures(*app);
    o->scene.picture.addLook(*app);
    o->scene.ground.add(*app);
    o->scene.overlay.add(*app);
    o->scene.coordinates.add(*app);
    o->figure.add(*app, "Figure");
    addOutputFile(*app, "--out", o->out, "the figure to write: .svg or .pdf", checkFigureSuffix)->required();
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
