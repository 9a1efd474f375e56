// The words that the program was started with, for those who tell how to do it again.
#pragma once

#include <span>
#include <string>

namespace pellucid::cli {

/// One word as a POSIX shell reads it back: as it is, or in single quotes.
std::string shellQuoted(const std::string& word);
/// "pellucid-cli WORD…", as one types it.
std::string commandLineOf(std::span<const std::string> arguments);

/// main() keeps the name of the program and its arguments here.
void keepCommandLine(const std::string& program, std::span<const std::string> arguments);
/// "pellucid-cli", until another one is kept.
const std::string& programName();
const std::string& commandLine();
/// The same for a picture that others get: without what the picture does not hang on, such as threads and the names of
/// outputs, in whose place stands `out` behind `option`; and with names of files as seen from the present folder, where
/// they begin at the root of the file system.
std::string pictureCommand(const std::string& option, const std::string& out);

} // namespace pellucid::cli
