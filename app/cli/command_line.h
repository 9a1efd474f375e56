// The words that the program was started with, for those who tell how to do it again.
#pragma once

#include <span>
#include <string>

namespace pellucid::cli {

/// One word as a POSIX shell reads it back: as it is, or in single quotes.
std::string shellQuoted(const std::string& word);
/// "pellucid-cli WORD…", as one types it.
std::string commandLineOf(std::span<const std::string> arguments);

/// main() keeps its arguments here.
void keepCommandLine(std::span<const std::string> arguments);
const std::string& commandLine();

} // namespace pellucid::cli
