#include "command_line.h"

#include <cctype>

namespace pellucid::cli {

namespace {

std::string& kept() {
    static std::string s_line;
    return s_line;
}

/// Characters that mean nothing to a shell, anywhere in a word.
bool isPlain(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string("_@%+=:,./-").find(c) != std::string::npos;
}

} // namespace

std::string shellQuoted(const std::string& word) {
    bool plain = !word.empty();
    std::string quoted = "'";
    for (const char c : word) {
        plain = plain && isPlain(c);
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return plain ? word : quoted + "'";
}

std::string commandLineOf(std::span<const std::string> arguments) {
    std::string line = "pellucid-cli";
    for (const std::string& word : arguments) line += " " + shellQuoted(word);
    return line;
}

void keepCommandLine(std::span<const std::string> arguments) { kept() = commandLineOf(arguments); }
const std::string& commandLine() { return kept(); }

} // namespace pellucid::cli
