#include "study/add_view.h"

#include <filesystem>

#include "session/session_json.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

/// "knee" of "knee.study.json"
std::string baseNameOf(const std::string& studyPath) {
    const std::string name = fs::path(studyPath).filename().string();
    return name.substr(0, name.find(".study.json"));
}

} // namespace

Study addViewToStudy(const std::string& studyPath, const Session& session, const AskedFeature& asked) {
    std::error_code ec;
    Study study = fs::exists(studyPath, ec) ? readStudy(studyPath) : Study{};
    Stimulus stimulus;
    stimulus.feature = asked.feature;
    stimulus.label = asked.label;
    stimulus.training = asked.training;
    const auto fileOf = [&](const std::string& id) {
        return (fs::path(studyPath).parent_path() / (baseNameOf(studyPath) + "-" + id + ".pellucid.json")).string();
    };
    Study ids = study; // and those of sessions that are still there of stimuli that have gone
    do {
        stimulus.id = freeStimulusId(ids);
        ids.stimuli.push_back(stimulus);
        stimulus.session = fileOf(stimulus.id);
    } while (fs::exists(stimulus.session, ec));
    Session shown = session; // what else the window had at hand is no part of a stimulus
    shown.comparison = {};
    shown.runs = {};
    writeSession(shown, stimulus.session);
    study.stimuli.push_back(std::move(stimulus));
    writeStudy(study, studyPath);
    return study;
}

} // namespace pellucid
