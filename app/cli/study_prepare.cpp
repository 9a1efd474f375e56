// `study prepare`: the pictures of a study, and the figures of what it asks about.
#include "commands.h"
#include "options/setting_options.h"
#include "output_files.h"
#include "session/session.h"
#include "study/preparation.h"

namespace pellucid::cli {

namespace {

struct StudyPrepareArguments {
    std::string study, out;
    SettingOptions<MeasureSettings> engine;
};

std::string tableOf(const Study& study) {
    Table table({"stimulus", "feature", "phase", "VWS", "visibility", "2DFS", "engine"});
    for (const Stimulus& s : study.stimuli)
        table.add({s.id, s.feature, s.training ? "training" : "trial", fixedText(*s.vws, 4),
                   fixedText(*s.visibility, 4), fixedText(*s.fs, 4), s.engine});
    return table.text();
}

Json jsonOf(const Study& study) {
    Json stimuli = Json::array();
    for (const Stimulus& s : study.stimuli)
        stimuli.push_back({{"id", s.id},
                           {"feature", s.feature},
                           {"training", s.training},
                           {"vws", *s.vws},
                           {"visibility", *s.visibility},
                           {"fs", *s.fs},
                           {"engine", s.engine},
                           {"picture", s.picture}});
    return stimuli;
}

Answer run(const StudyPrepareArguments& o, Progress& progress) {
    const Stopwatch total;
    const Study study = readStudy(o.study);
    const std::optional<EngineChoice> engine =
        o.engine.has("engine") ? std::optional(o.engine.values().engine) : std::nullopt;
    const PreparedStudy prepared = prepareStudy(study, o.out, engine, progress.phase("pictures"));
    const double seconds = total.seconds();
    Json json{{"command", "study prepare"},
              {"study", o.study},
              {"folder", o.out},
              {"size", {study.width, study.height}},
              {"trials", study.countOfTrials() + study.repeats},
              {"stimuli", jsonOf(prepared.study)},
              {"seconds", {{"total", seconds}}}};
    return {tableOf(prepared.study) + "wrote " + preparedStudyFile(o.out) + " and " +
                std::to_string(prepared.study.stimuli.size()) + " pictures of " + std::to_string(study.width) + " x " +
                std::to_string(study.height) + " pixels, " + secondsText(seconds) + "\n",
            std::move(json), prepared.notices};
}

} // namespace

Command addStudyPrepare(CLI::App& study) {
    CLI::App* app = study.add_subcommand("prepare", "Draw all pictures of a study and measure them");
    const auto o = std::make_shared<StudyPrepareArguments>();
    app->add_option("STUDY", o->study, "a study, *.study.json")->required()->type_name("");
    addOutputFolder(*app, "--out", o->out, "folder for study.json, the pictures and later the answers")->required();
    o->engine.add(*app, "Engine", {"engine"});
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
