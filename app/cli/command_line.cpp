#include "command_line.h"

#include <algorithm>
#include <cctype>

namespace pellucid::cli {

namespace {

std::string g_line; // as commandLineOf() writes it

/// Characters that mean nothing to a shell, anywhere in a word.
bool isPlain(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string("_@%+=:,./-").find(c) != std::string::npos;
}

/// As a POSIX shell reads it.
std::string inSingleQuotes(const std::string& word) {
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

} // namespace

std::string shellQuoted(const std::string& word) {
    const bool isPlainWord = !word.empty() && std::all_of(word.begin(), word.end(), isPlain);
    return isPlainWord ? word : inSingleQuotes(word);
}

std::string commandLineOf(std::span<const std::string> arguments) {
    std::string line = "pellucid-cli";
    for (const std::string& word : arguments) line += " " + shellQuoted(word);
    return line;
}

void keepCommandLine(std::span<const std::string> arguments) { g_line = commandLineOf(arguments); }
const std::string& commandLine() { return g_line; }

} // namespace pellucid::cli
