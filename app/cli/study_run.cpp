// `study run`: opens the window that shows a study to one participant.
#include <cstdlib>
#include <filesystem>

#include <unistd.h>

#include "base/child_program.h"
#include "commands.h"
#include "interrupt.h"
#include "parse.h"
#include "study/participation.h"
#include "study_simulate.h"

namespace pellucid::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* kWindow = "pellucid";

struct StudyRunArguments {
    std::string folder;
    std::optional<std::string> participant;
    SimulateOptions simulate;
};

std::string parseParticipant(const std::string& text, const std::string& option) {
    if (!isStudyId(text))
        throw UsageError("'" + text + "' cannot name a participant", option, "use up to 40 letters, digits, - and _");
    return text;
}

/// The window's program, which is installed beside this one.
std::string windowProgram() {
    std::error_code ec;
    const fs::path own = fs::read_symlink("/proc/self/exe", ec);
    const std::string program = ((ec ? fs::path(".") : own.parent_path()) / kWindow).string();
    if (access(program.c_str(), X_OK) != 0 || fs::is_directory(program, ec))
        throw Error("the window program is not installed", program, "install or build pellucid, which shows the study");
    return program;
}

void requireDisplay() {
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"})
        if (const char* value = std::getenv(name); value != nullptr && *value != '\0') return;
    throw Error("there is no display to show the study on", "DISPLAY and WAYLAND_DISPLAY are not set",
                "run it on a desktop");
}

Answer run(const StudyRunArguments& o, Progress& progress) {
    o.simulate.check();
    refuse({{o.simulate.isWanted() && o.participant, "simulated participants have ids of their own", "--participant",
             "leave it out"}});
    if (o.simulate.isWanted()) return o.simulate.run(o.folder, progress);
    const Study study = readPreparedStudy(o.folder);
    const std::string id = o.participant.value_or(newParticipantId(o.folder));
    const std::string program = windowProgram();
    requireDisplay();
    const ChildEnd end = runChild(
        {.program = program, .words = {"--study", o.folder, "--participant", id}, .talks = true}, interruptToken());
    const std::string file = participantFile(o.folder, id);
    std::error_code ec;
    const std::size_t answers = fs::exists(file, ec) ? readParticipant(file).answers.size() : 0;
    const std::size_t trials = planOf(study, id).size();
    Json json{{"command", "study run"}, {"folder", o.folder}, {"participant", id},
              {"answers", answers},     {"trials", trials},   {"file", answers > 0 ? Json(file) : Json()}};
    std::string text =
        "participant " + id + ": " + std::to_string(answers) + " of " + std::to_string(trials) + " trials answered\n";
    if (answers > 0) text += "answers are in " + file + "\n";
    if (answers > 0 && answers < trials) text += "to go on: study run " + o.folder + " --participant " + id + "\n";
    Answer answer{std::move(text), std::move(json)};
    if (end.status != 0) answer.failure = Error("the window ended with an error", program, "see what it says above");
    return answer;
}

} // namespace

Command addStudyRun(CLI::App& study) {
    CLI::App* app = study.add_subcommand("run", "Show a prepared study to a participant");
    const auto o = std::make_shared<StudyRunArguments>();
    app->add_option("DIR", o->folder, "the folder that a study was prepared into")->required()->type_name("");
    addValue(*app, "--participant", "ID", o->participant, parseParticipant,
             "who takes part, without a name; one who has begun goes on (default: a new one)");
    o->simulate.add(*app);
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
