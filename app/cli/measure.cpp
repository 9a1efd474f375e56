// `measure`: what each feature shows from one view.
#include "commands.h"
#include "prepare.h"
#include "render/memory_needs.h"
#include "resolve.h"

namespace pellucid::cli {

namespace {

struct Options {
    SceneOptions scene;
    bool jacobian = false, occlusion = false;
};

struct Seconds {
    double visibility = 0, saliency = 0, total = 0;
    std::optional<double> jacobian;
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

std::string textOf(const Scene& scene, const Measures& m, const Matrices& matrices, const std::string& engine,
                   const Seconds& seconds) {
    const TransferFunction& tf = scene.tf;
    const std::vector<std::string> names = namesWithEmpty(tf, *scene.histogram);
    Table table({"feature", "intensities", "opacity", "visibility", "VWS", "brightness", "saturation", "cover"});
    for (std::size_t i = 0; i < tf.features.size(); ++i) {
        const FeatureMeasures& f = m.features[i];
        table.add({names[i], fixedText(tf.features[i].a, 3) + " .. " + fixedText(tf.features[i].b, 3),
                   fixedText(m.opacities[i], 4), fixedText(f.visibility, 4), fixedText(f.vws, 4),
                   fixedText(f.vwsBrightness, 4), fixedText(f.vwsSaturation, 4), fixedText(m.coverage->covers[i], 4)});
    }
    const std::string features = tf.features.empty()
                                     ? "the transfer function has no features\n"
                                     : table.text() + "coverage " + fixedText(m.coverage->coverage, 4) + "\n";
    return features + textOf(tf, matrices.jacobian, "dVWS / dopacity of") +
           textOf(tf, matrices.occlusion, "part hidden by") + "engine " + engine + ": visibility " +
           secondsText(seconds.visibility) + ", saliency " + secondsText(seconds.saliency) +
           (seconds.jacobian ? ", jacobian " + secondsText(*seconds.jacobian) : "") + ", total " +
           secondsText(seconds.total) + "\n";
}

Json jsonOf(const Scene& scene, const Measures& m, const Matrices& matrices, const std::string& engine,
            const Seconds& seconds) {
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
    }
    Json json{{"command", "measure"},
              {"engine", engine},
              {"volume", jsonFromVolume(*scene.volume)},
              {"features", features},
              {"coverage", m.coverage->coverage},
              {"visibility_histogram", m.visibilityHistogram}};
    if (matrices.jacobian) json["jacobian"] = *matrices.jacobian;
    if (matrices.occlusion) json["occlusion"] = *matrices.occlusion;
    Json& times = json["seconds"] = {{"visibility", seconds.visibility}, {"saliency", seconds.saliency}};
    if (seconds.jacobian) times["jacobian"] = *seconds.jacobian;
    times["total"] = seconds.total;
    return json;
}

Answer run(const Options& o, Progress& progress) {
    const Stopwatch total;
    const Opened opened = resolve(o.scene, progress, {toMeasure("measuring"), true});
    const MeasureInput input = measureInput(opened.scene);
    Workspace workspace;
    const auto [engine, saliencySeconds] = prepare(workspace, input, progress);

    Seconds seconds;
    seconds.saliency = saliencySeconds;
    Measures m = workspace.measure(input, progress.phase("visibility"));
    seconds.visibility = workspace.seconds().visibility;
    m.coverage = workspace.coverage(input, progress.phase("coverage"));
    Matrices matrices;
    if (o.jacobian) {
        matrices.jacobian = workspace.jacobian(input, progress.phase("derivatives"));
        seconds.jacobian = workspace.seconds().visibility;
    }
    if (o.occlusion) matrices.occlusion = workspace.occlusion(input, progress.phase("occlusion"));
    seconds.total = total.seconds();
    Json json = jsonOf(opened.scene, m, matrices, engine, seconds);
    addProfile(json, input.settings);
    addMapping(json, opened.scene);
    return {textOf(opened.scene, m, matrices, engine + profileText(input.settings), seconds), std::move(json),
            opened.notices()};
}

} // namespace

Command addMeasure(CLI::App& program) {
    CLI::App* app = program.add_subcommand("measure", "Visibility and visibility-weighted saliency of each feature");
    const auto o = std::make_shared<Options>();
    o->scene.addForFigures(*app);
    app->add_flag("--jacobian", o->jacobian,
                  "also print the derivatives of each VWS with respect to each feature's opacity");
    app->add_flag("--occlusion", o->occlusion,
                  "also print how much of each feature's visibility every other feature takes away");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
