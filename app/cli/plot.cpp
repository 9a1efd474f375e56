// `plot`: the transfer function over the histogram, as a drawing.
#include "commands.h"
#include "output_files.h"
#include "parse.h"
#include "report/drawing_file.h"
#include "report/tf_plot.h"
#include "resolve.h"

namespace pellucid::cli {

namespace {

struct PlotArguments {
    SceneOptions scene;
    std::string out;
    double highest = 0; ///< 0: what fits
};

Answer run(const PlotArguments& o, Progress& progress) {
    const Opened opened = resolve(o.scene, progress);
    const Scene& scene = opened.scene;
    const Plot plot =
        tfPlot(scene.tf, {scene.volume->range(), scene.unit.value_or(""), scene.histogram.get(), o.highest});
    progress.phase("writing");
    writeDrawing([&](const PlotPage& page) { return drawingOf(plot, page); }, {}, o.out);
    return {"wrote " + o.out + "\n",
            {{"command", "plot"},
             {"volume", jsonFromVolume(*scene.volume)},
             {"file", o.out},
             {"histogram", scene.histogram->counts}},
            opened.notices()};
}

} // namespace

Command addPlot(CLI::App& program) {
    CLI::App* app = program.add_subcommand("plot", "Draws the transfer function over the histogram of the volume");
    const auto o = std::make_shared<PlotArguments>();
    o->scene.addForData(*app);
    o->scene.tf.add(*app);
    addOutputFile(*app, "--out", o->out, "the drawing to write: .svg or .png", [](const std::string& path) {
        checkDrawingSuffix(path, "plots");
    })->required();
    addValue(*app, "--highest", "A", o->highest, realAbove(0, 1),
             "upper end of the axis of opacity, so that plots compare (default: what fits)");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
