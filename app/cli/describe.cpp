// `describe`: what the picture shows, in words.
#include "commands.h"
#include "optimize/fields.h"
#include "prepare.h"
#include "render/memory_needs.h"
#include "resolve.h"
#include "session/caption.h"

namespace pellucid::cli {

namespace {

Answer run(const SceneOptions& options, Progress& progress) {
    const Opened opened = resolve(options, progress, {toMeasure("measuring"), true});
    const MeasureInput input = measureInput(opened.scene);
    Workspace workspace;
    const std::string engine = prepare(workspace, input, progress).engine;
    Measures measures = workspace.measure(input, progress.phase("visibility"));
    measures.coverage = workspace.coverage(input, progress.phase("coverage"));
    const CaptionFacts facts =
        captionFacts(opened.scene, measures, workspace.occlusion(input, progress.phase("occlusion")));
    Json json{{"command", "describe"},     {"engine", engine},
              {"caption", caption(facts)}, {"alt", altText(facts)},
              {"from", facts.from},        {"lit", facts.lit},
              {"cut", facts.cut},          {"coverage", measures.coverage->coverage}};
    if (!facts.alone.empty()) json["alone"] = facts.alone;
    Json features = Json::array();
    for (const CaptionFeature& f : facts.features)
        features.push_back({{"name", f.name}, {"vws", f.vws}, {"visibility", f.visibility}});
    json["features"] = features;
    addProfile(json, input.settings);
    return {caption(facts) + "\n", std::move(json), opened.notices()};
}

} // namespace

Command addDescribe(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "describe", "Says in words what the picture shows: a caption, and with --json also a short alternative text");
    const auto o = std::make_shared<SceneOptions>();
    o->addForFigures(*app);
    o->picture.addLook(*app); // the words of a picture that was drawn can be given again
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
