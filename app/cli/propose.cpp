// `propose`: the automatic start.
#include "tf/proposal.h"

#include "base/round_numbers.h"
#include "commands.h"
#include "optimize/answer/first_sight.h"
#include "optimize/views/opening_view.h"
#include "output_files.h"
#include "parse.h"
#include "render/holder.h"
#include "resolve.h"
#include "results_json.h"
#include "session/scene_data.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/tf_json.h"
#include "tf_notices.h"

namespace pellucid::cli {

namespace {

struct ProposeArguments {
    SceneOptions scene;
    std::optional<std::string> outTf;
};

std::string textOf(const Proposal& p, const std::vector<double>& targets, double seconds) {
    // As many digits as the window needs: it may be 1e-9 wide about 1.
    const auto number = [&](double value) { return numberText(value, p.window.hi - p.window.lo); };
    const auto range = [&](const ValueRange& r) {
        return number(r.lo) + " .. " + number(r.hi) + (p.unit.empty() ? "" : " " + p.unit);
    };
    std::vector<std::pair<std::string, std::string>> lines{{"kind", name(p.kind)},
                                                           {"window", range(p.window)},
                                                           {"background", p.background ? range(*p.background) : "none"},
                                                           {"time", secondsText(seconds)}};
    for (const std::string& sentence : p.why) lines.emplace_back("why", sentence);
    const std::vector<double> opacities = featureOpacities(p.tf);
    Table features({"feature", "from", "to", "typical", "share %", "inside", "opacity", "target", "colour"});
    for (std::size_t f = 0; f < p.features.size(); ++f) {
        const ProposedFeature& feature = p.features[f];
        features.add({feature.name, number(feature.lo), number(feature.hi), number(feature.mode),
                      fixedText(100 * feature.share, 2), fixedText(feature.inside, 2), fixedText(opacities[f], 4),
                      targets.empty() ? "–" : fixedText(targets[f], 3), hexFromRgb(p.tf.features[f].color)});
    }
    return listing(lines) + features.text();
}

Json jsonOf(const Proposal& p, const std::vector<double>& targets, double seconds) {
    Json json{{"command", "propose"}, {"kind", name(p.kind)}};
    if (!p.unit.empty()) json["unit"] = p.unit;
    json["window"] = jsonFromRange(p.window);
    json["outside"] = p.outside;
    if (p.background) json["background"] = jsonFromRange(*p.background);
    const std::vector<double> opacities = featureOpacities(p.tf);
    Json features = Json::array();
    for (std::size_t f = 0; f < p.features.size(); ++f) {
        const ProposedFeature& feature = p.features[f];
        features.push_back({{"name", feature.name},
                            {"range", Json::array({feature.lo, feature.hi})},
                            {"mode", feature.mode},
                            {"share", feature.share},
                            {"inside", feature.inside},
                            {"opacity", opacities[f]},
                            {"color", hexFromRgb(p.tf.features[f].color)}});
        if (!targets.empty()) features.back()["target"] = targets[f];
    }
    json["features"] = features;
    json["why"] = p.why;
    json["tf"] = jsonFromTf(p.tf);
    json["seconds"] = seconds;
    return json;
}

/// What cuts a holder off, as values of --clip: "x:0.1:0.9", or planes.
std::vector<std::string> clipsWithout(const Holder& holder) {
    std::vector<std::string> clips;
    const BoxPart& part = holder.without;
    for (int a = 0; a < 3; ++a)
        if (part.lo[a] > 0 || part.hi[a] < 1)
            clips.push_back(std::string(1, "xyz"[a]) + ":" + fixedText(part.lo[a], 4) + ":" + fixedText(part.hi[a], 4));
    for (const ClipPlane& plane : part.planes) {
        std::string clip;
        for (int a = 0; a < 3; ++a) clip += plainText(plane.normal[a]) + ",";
        clips.push_back(clip + plainText(plane.offset));
    }
    return clips;
}

std::string textOf(const Holder& holder) {
    return std::string("the object lies on a board or holder, which runs along ") + "xyz"[holder.along] + " at " +
           (holder.isHigh ? "high " : "low ") + "xyz"[holder.axis] +
           ": it is drawn faintly and not measured; --holder 0 leaves it out, --holder 1 draws it like the rest";
}

Answer run(const ProposeArguments& o, Progress& progress) {
    Opened opened = resolve(o.scene, progress, {.use = {}, .byEngine = false, .needsTf = false});
    const Stopwatch looking;
    const Volume& volume = *opened.scene.volume;
    Proposal proposal = propose(volume, progress.phase("looking at the data"));
    const Volume seen = proposal.window == volume.range() ? volume : volume.withRange(proposal.window);
    const std::optional<Holder> holder = findHolder(seen, proposal.tf);
    const View home = openingView(seen, proposal.tf, holder);
    const FirstSight sight = withOpacitiesForView(seen, proposal, proposal.tf, home);
    proposal.tf = sight.tf;
    if (holder) proposal.why.push_back(textOf(*holder));
    const double seconds = looking.seconds();
    std::vector<std::string> notices = opened.notices();
    if (o.outTf) addTo(notices, writeTfFile(toWrite(proposal.tf, opened.scene, *o.outTf, proposal.window), *o.outTf));
    Json json = jsonOf(proposal, sight.shares, seconds);
    json.update(jsonFromView(home.camera, volume.geometry()));
    if (holder)
        json["holder"] = {{"along", std::string(1, "xyz"[holder->along])},
                          {"toward", {holder->toward.x, holder->toward.y, holder->toward.z}},
                          {"density", faintRest(*holder, seen, proposal.tf).density},
                          {"clip", clipsWithout(*holder)},
                          {"lost", holder->lost}};
    return {textOf(proposal, sight.shares, seconds), std::move(json), std::move(notices)};
}

} // namespace

Command addPropose(CLI::App& program) {
    CLI::App* app = program.add_subcommand("propose", "A transfer function from what the data hold, and why");
    const auto o = std::make_shared<ProposeArguments>();
    o->scene.addForData(*app);
    addOutputFile(*app, "--out-tf", o->outTf, "write the proposed transfer function" + std::string(kTfFileHelp));
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
