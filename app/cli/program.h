// A program of commands: parses, dispatches, and turns what happens into the exit status: 0 done, 1 the work failed,
// 2 wrong usage, 130 stopped by Ctrl-C.
#pragma once

#include <string>
#include <vector>

#include "commands.h"

namespace pellucid::cli {

struct Program {
    std::string name;    ///< "pellucid-cli"
    std::string purpose; ///< a sentence for --help
    std::vector<Command> (*addCommands)(CLI::App& program) = nullptr;
    bool shows = true; ///< false: of several that do the same, another one shows progress
};

/// What a call comes to. Nothing of it has been printed.
struct Outcome {
    int status = 0;
    std::string answer;               ///< for stdout
    std::string error;                ///< one line, without the program's name; empty: none
    std::vector<std::string> notices; ///< remarks for stderr
};

/// Before any thread is started: takes over signals.
void beginProgram();
Outcome run(const Program& program, const std::vector<std::string>& arguments);
/// Prints it. The exit status, also where stdout takes nothing more.
int tell(const Program& program, const Outcome& outcome);

} // namespace pellucid::cli
