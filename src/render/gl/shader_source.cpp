#include "render/gl/shader_source.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>
#include <string_view>

#include "base/error.h"

namespace pellucid::gl {

namespace {

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

bool take(std::string_view& text, std::string_view prefix) {
    if (text.substr(0, prefix.size()) != prefix) return false;
    text.remove_prefix(prefix.size());
    return true;
}

/// A number at the front of `text`, taken away from it.
std::optional<std::size_t> takeNumber(std::string_view& text) {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

/// What follows `#include` in a line that is one.
std::optional<std::string_view> afterInclude(std::string_view line) {
    line = trimmed(line);
    if (!take(line, "#")) return {};
    line = trimmed(line);
    if (!take(line, "include")) return {};
    return line;
}

/// "name", perhaps with a comment behind it.
std::optional<std::string> quotedName(std::string_view text) {
    text = trimmed(text);
    if (!take(text, "\"")) return {};
    const auto end = text.find('"');
    if (end == std::string_view::npos || end == 0) return {};
    const std::string_view rest = trimmed(text.substr(end + 1));
    if (!rest.empty() && rest.substr(0, 2) != "//") return {};
    return std::string(text.substr(0, end));
}

/// The line number at the front of a compiler's message, and what comes after it. The string's own number is always 0
/// here: "0:41(7):", "0:41:", "0(41) :".
std::optional<std::size_t> takePlace(std::string_view& text) {
    std::string_view rest = text;
    std::optional<std::size_t> number;
    if (take(rest, "0:")) {
        number = takeNumber(rest);
        if (number && take(rest, "(") && !(takeNumber(rest) && take(rest, ")"))) return {};
    } else if (take(rest, "0(")) {
        number = takeNumber(rest);
        if (!take(rest, ")")) return {};
    }
    if (!number) return {};
    rest = trimmed(rest);
    if (!take(rest, ":")) return {};
    text = rest;
    return number;
}

struct Expansion {
    const ShaderLookup& lookup;
    ShaderSource& out;
    std::set<std::string> seen;

    void append(const std::string& line, const std::string& file, int number) {
        out.text += line + '\n';
        out.lines.push_back({file, number});
    }

    void expand(const std::string& name, const std::string& from, int fromLine) {
        if (!seen.insert(name).second) return;
        const auto source = lookup(name);
        if (!source) {
            const std::string where = fromLine > 0 ? from + ":" + std::to_string(fromLine) : name;
            throw Error("no shader file \"" + name + "\"", where, "check the name below shaders/");
        }
        std::istringstream in(*source);
        std::string line;
        for (int number = 1; std::getline(in, line); ++number) {
            if (!line.empty() && line.back() == '\r') line.pop_back();
            const auto rest = afterInclude(line);
            if (!rest) {
                append(line, name, number);
                continue;
            }
            const auto file = quotedName(*rest);
            if (!file) throw Error("malformed include", name + ":" + std::to_string(number), "write #include \"file\"");
            expand(*file, name, number);
        }
    }
};

} // namespace

std::optional<std::string> embeddedShaderSource(const std::string& name) {
    const auto& all = embeddedShaders();
    const auto found = std::ranges::find(all, name, &EmbeddedShader::name);
    if (found == all.end()) return {};
    return std::string(found->source);
}

ShaderSource expandShader(const std::string& name, const std::vector<std::string>& defines,
                          const ShaderLookup& lookup) {
    ShaderSource source;
    Expansion expansion{lookup, source, {}};
    expansion.append("#version 430 core", name, 0);
    for (const std::string& define : defines) expansion.append("#define " + define, name, 0);
    expansion.expand(name, name, 0);
    return source;
}

std::string mapShaderLog(const std::string& log, const ShaderSource& source) {
    std::istringstream in(log);
    std::string line, mapped;
    while (std::getline(in, line)) {
        std::string_view rest = line;
        const std::string severity = take(rest, "ERROR: ") ? "ERROR: " : take(rest, "WARNING: ") ? "WARNING: " : "";
        const auto number = takePlace(rest);
        if (number && *number >= 1 && *number <= source.lines.size()) {
            const auto& origin = source.lines[*number - 1];
            line = severity + origin.file + ":" + std::to_string(origin.line) + ":" + std::string(rest);
        }
        mapped += line + '\n';
    }
    while (!mapped.empty() && mapped.back() == '\n') mapped.pop_back();
    return mapped;
}

} // namespace pellucid::gl
