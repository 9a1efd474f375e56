#include "render/gl/shader_source.h"

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include "volume/error.h"

namespace pellucid::gl {

namespace {

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
        static const std::regex include(R"re(\s*#\s*include\b(.*))re");
        static const std::regex quoted(R"re(\s*"([^"]+)"\s*(//.*)?)re");
        std::istringstream in(*source);
        std::string line;
        for (int number = 1; std::getline(in, line); ++number) {
            if (!line.empty() && line.back() == '\r') line.pop_back();
            std::smatch match, file;
            if (!std::regex_match(line, match, include)) {
                append(line, name, number);
                continue;
            }
            const std::string rest = match[1];
            if (!std::regex_match(rest, file, quoted))
                throw Error("malformed include", name + ":" + std::to_string(number), "write #include \"file\"");
            expand(file[1], name, number);
        }
    }
};

} // namespace

std::optional<std::string> embeddedShaderSource(const std::string& name) {
    const auto& all = embeddedShaders();
    const auto found = std::find_if(all.begin(), all.end(), [&](const EmbeddedShader& s) { return name == s.name; });
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
    // The string's number, always 0 here, then the line: "0:41(7):", "0:41:", "0(41) :", perhaps after "ERROR: ".
    static const std::regex place(R"re(^(\s*(?:ERROR: |WARNING: )?)0(?::(\d+)(?:\(\d+\))?|\((\d+)\))\s*:?)re");
    std::istringstream in(log);
    std::string line, mapped;
    while (std::getline(in, line)) {
        std::smatch match;
        if (std::regex_search(line, match, place)) {
            const std::size_t number = std::stoul(match[2].matched ? match[2].str() : match[3].str());
            if (number >= 1 && number <= source.lines.size()) {
                const auto& origin = source.lines[number - 1];
                line = match[1].str() + origin.file + ":" + std::to_string(origin.line) + ":" + match.suffix().str();
            }
        }
        mapped += line + '\n';
    }
    while (!mapped.empty() && mapped.back() == '\n') mapped.pop_back();
    return mapped;
}

} // namespace pellucid::gl
