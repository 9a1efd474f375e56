// `study`: the commands for experiments with people.
#include "commands.h"

namespace pellucid::cli {

std::vector<Command> addStudy(CLI::App& program) {
    CLI::App* study = program.add_subcommand("study", "Experiments: how clear people find features in pictures");
    study->require_subcommand(1);
    return {addStudyPrepare(*study), addStudyRun(*study), addStudyAnalyze(*study)};
}

} // namespace pellucid::cli
