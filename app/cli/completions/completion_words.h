// What shells can complete: the program's own commands, options and values, from the tables that --help is made of.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pellucid::cli {

/// What may stand in a place of a command line.
struct CompletionValues {
    std::string name;               ///< as --help has it: "FILE"; of a flag empty
    std::vector<std::string> words; ///< what is offered; one that ends with ':' or '=' goes on
    bool files = false, folders = false;
};

struct CompletionOption {
    std::vector<std::string> names; ///< "--threads", "-h"
    std::string about;              ///< the first words of its help
    CompletionValues values;
    bool takesValue = false;
};

struct CompletionCommand {
    std::string name; ///< "measure", or "study run"
    std::string about;
    std::vector<CompletionOption> options;
    std::vector<CompletionValues> arguments; ///< what stands without an option, in order
    std::vector<CompletionCommand> commands; ///< of its own; then it has no options but --help
};

/// The program itself, with its commands.
CompletionCommand completionWords(const CLI::App& program);

} // namespace pellucid::cli
