#include "command_line.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

#include "base/stored_path.h"

namespace pellucid::cli {

namespace {

std::string g_program = "pellucid-cli";
std::vector<std::string> g_words;
std::string g_line; // as commandLineOf() writes it

/// Of options that no picture hangs on: those with a value, and those without.
constexpr std::array<std::string_view, 4> kWithValue{"--out", "--layers", "--threads", "--memory"};
constexpr std::array<std::string_view, 4> kFlags{"--json", "--progress", "--no-metadata", "--caption"};

/// Relative, also behind an "=": y=/data/scan.nrrd, --tf=/data/a.tf.json.
std::string withoutRoot(const std::string& word) {
    const std::size_t path = word.starts_with('/') ? 0 : word.find("=/");
    if (path == std::string::npos) return word;
    const std::size_t begin = path == 0 && word.starts_with('/') ? 0 : path + 1;
    return word.substr(0, begin) + relativeTo({}, word.substr(begin));
}

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
    std::string line = g_program;
    for (const std::string& word : arguments) line += " " + shellQuoted(word);
    return line;
}

void keepCommandLine(const std::string& program, std::span<const std::string> arguments) {
    g_program = program;
    g_words.assign(arguments.begin(), arguments.end());
    g_line = commandLineOf(arguments);
}
const std::string& programName() { return g_program; }
const std::string& commandLine() { return g_line; }

std::string pictureCommand(const std::string& option, const std::string& out) {
    std::vector<std::string> words;
    bool isValue = false; // of an option that is left out
    for (const std::string& word : g_words) {
        if (std::exchange(isValue, false)) continue;
        if (std::ranges::find(kFlags, word) != kFlags.end()) continue;
        isValue = std::ranges::find(kWithValue, word) != kWithValue.end();
        const bool hasValue = std::ranges::any_of(
            kWithValue, [&](std::string_view left) { return word.starts_with(std::string(left) + "="); });
        if (!isValue && !hasValue) words.push_back(withoutRoot(word));
    }
    words.insert(words.end(), {option, out});
    return commandLineOf(words);
}

} // namespace pellucid::cli
