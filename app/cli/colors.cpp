// `colors`: which features look alike to viewers with a colour-vision deficiency, and colours that do not.
#include "commands.h"
#include "output_files.h"
#include "parse.h"
#include "resolve.h"
#include "results_json.h"
#include "session/scene_data.h"
#include "tf/alike_features.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/tf_json.h"
#include "tf_notices.h"

namespace pellucid::cli {

namespace {

struct ColorsArguments {
    SceneOptions scene;
    double difference = kWantedDifference;
    std::optional<std::string> outTf;
};

/// The transfer function in colours that all viewers can tell apart. Throws Error where there are none.
TransferFunction mended(const Scene& scene, const std::vector<std::size_t>& among, double wanted) {
    if (auto tf = withColorsApart(scene.tf, among, wanted)) return *std::move(tf);
    throw Error("no colours were found that are all " + plainText(wanted) + " apart for every viewer", "--out-tf",
                "hide some of the " + std::to_string(among.size()) + " features, or give a smaller --difference");
}

std::string textOf(const TransferFunction& tf, const std::vector<std::size_t>& among,
                   const std::vector<AlikePair>& alike, double wanted) {
    std::vector<std::string> columns{"feature"};
    for (const VisionKind vision : allOf<VisionKind>()) columns.emplace_back(name(vision));
    Table table(columns);
    const std::vector<Rgb> colors = featureColors(tf);
    for (const std::size_t f : among) {
        std::vector<std::string> row{tf.features[f].name};
        for (const VisionKind vision : allOf<VisionKind>())
            row.push_back(hexFromRgb(seenColor(colors[f], visionMatrix(vision))));
        table.add(row);
    }
    std::string text = table.text();
    for (const AlikePair& pair : alike) text += alikeText(tf, pair, wanted) + "\n";
    return alike.empty() ? text + "all features are at least " + plainText(wanted) + " apart for every viewer\n" : text;
}

Json jsonOf(const TransferFunction& tf, const std::vector<std::size_t>& among, const std::vector<AlikePair>& alike,
            double wanted) {
    Json json{{"command", "colors"}, {"wanted", wanted}, {"features", Json::array()}, {"alike", Json::array()}};
    const std::vector<Rgb> colors = featureColors(tf);
    for (const std::size_t f : among) {
        Json seen = Json::object();
        for (const VisionKind vision : allOf<VisionKind>())
            seen[name(vision)] = hexFromRgb(seenColor(colors[f], visionMatrix(vision)));
        json["features"].push_back({{"name", tf.features[f].name}, {"seen", seen}});
    }
    for (const AlikePair& pair : alike)
        json["alike"].push_back({{"features", {tf.features[pair.first].name, tf.features[pair.second].name}},
                                 {"vision", name(pair.vision)},
                                 {"difference", pair.difference}});
    return json;
}

Answer run(const ColorsArguments& o, Progress& progress) {
    const Opened opened = resolve(o.scene, progress);
    const Scene& scene = opened.scene;
    refuse({{scene.colors != nullptr, "the colours of this picture come from variables, not from features", "--hsb",
             "leave it out"}});
    const std::vector<std::size_t> among = featuresToTell(scene.wantedTf());
    const std::vector<AlikePair> alike = alikeFeatures(scene.tf, among, o.difference);
    std::vector<std::string> notices = opened.notices();
    std::string text = textOf(scene.tf, among, alike, o.difference);
    Json json = jsonOf(scene.tf, among, alike, o.difference);
    if (o.outTf) {
        const TransferFunction tf = mended(scene, among, o.difference);
        addTo(notices, writeTfFile(toWrite(tf, scene, *o.outTf), *o.outTf));
        text += "wrote " + *o.outTf + "\n";
        json["tf"] = jsonFromTf(tf);
    }
    return {std::move(text), std::move(json), std::move(notices)};
}

} // namespace

Command addColors(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "colors", "Which features look alike to viewers with a colour-vision deficiency, and colours that do not");
    const auto o = std::make_shared<ColorsArguments>();
    o->scene.addForData(*app);
    o->scene.tf.add(*app);
    addValue(*app, "--difference", "D", o->difference, realAbove(0, 50),
             "how far two features should be apart for every viewer, CIEDE2000, above 0 to 50 (default 10)");
    addOutputFile(*app, "--out-tf", o->outTf,
                  "write the transfer function in colours that are so far apart, near those it has and in their order "
                  "of lightness" +
                      std::string(kTfFileHelp));
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
