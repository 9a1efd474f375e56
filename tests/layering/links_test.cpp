// Links of the documents lead somewhere: to a file of the repository, and to a heading in it.
#include <catch2/catch.hpp>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path kTop = PELLUCID_SOURCE_DIR;

/// What stands outside of blocks of code: lines that are indented by four after an empty one, or between fences.
std::vector<std::string> proseOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    bool isFenced = false, wasEmpty = true, isCode = false;
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("```")) isFenced = !isFenced;
        const bool isIndented = line.starts_with("    ");
        isCode = isIndented && (wasEmpty || isCode);
        wasEmpty = line.empty();
        if (!isFenced && !isCode) lines.push_back(line);
    }
    return lines;
}

/// The anchor of a heading, as web pages of repositories make it: small letters, digits, "-" and "_" of its words.
std::string anchorOf(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto letter = static_cast<unsigned char>(c);
        if (c == ' ')
            anchor += '-';
        else if (std::isalnum(letter) || c == '-' || c == '_' || letter >= 0x80)
            anchor += static_cast<char>(std::tolower(letter));
    }
    return anchor;
}

std::set<std::string> anchorsOf(const std::vector<std::string>& lines) {
    std::set<std::string> anchors;
    for (const std::string& line : lines) {
        const std::size_t level = line.find_first_not_of('#');
        if (level == 0 || level == std::string::npos || line[level] != ' ') continue;
        const std::string anchor = anchorOf(line.substr(level + 1));
        std::string free = anchor; // the second of a name is "name-1"
        for (int n = 1; !anchors.insert(free).second; ++n) free = anchor + "-" + std::to_string(n);
    }
    return anchors;
}

struct Page {
    std::vector<std::string> lines;
    std::set<std::string> anchors;
};

Page pageOf(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    Page page{proseOf(text.str()), {}};
    page.anchors = anchorsOf(page.lines);
    return page;
}

std::vector<std::string> linksOf(const std::vector<std::string>& lines) {
    static const std::regex kLink(R"(\]\(([^)\s]+)\))");
    std::vector<std::string> links;
    for (const std::string& line : lines)
        for (std::sregex_iterator at(line.begin(), line.end(), kLink), end; at != end; ++at)
            links.push_back(at->str(1));
    return links;
}

} // namespace

TEST_CASE("links and headings are read as web pages show them", "[layering][links]") {
    CHECK(anchorOf("Transfer functions: `*.tf.json`") == "transfer-functions-tfjson");
    CHECK(anchorsOf({"# A b", "## A b", "text", "#no"}) == std::set<std::string>{"a-b", "a-b-1"});
    CHECK(proseOf("a\n\n    code\n    more\nb\n    goes on\n```\nfenced\n```\nc\n").size() ==
          6); // a, "", b, goes on, ```, c
    CHECK(linksOf({"see [x](y.md#z), ![p](q.png)"}) == std::vector<std::string>{"y.md#z", "q.png"});
}

TEST_CASE("links of the documents lead somewhere", "[layering][links]") {
    std::map<fs::path, Page> pages;
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(kTop))
        if (entry.path().extension() == ".md") paths.push_back(entry.path());
    for (const char* folder : {"docs", "src", "app", "data", "examples", "benchmarks", "packaging"})
        for (const auto& entry : fs::recursive_directory_iterator(kTop / folder))
            if (entry.path().extension() == ".md") paths.push_back(entry.path());
    for (const fs::path& path : paths) pages[fs::weakly_canonical(path)] = pageOf(path);
    int seen = 0;
    for (const auto& [path, page] : pages)
        for (const std::string& link : linksOf(page.lines)) {
            if (link.find(':') != std::string::npos) continue; // of the web
            ++seen;
            INFO(fs::relative(path, kTop) << ": " << link);
            const std::size_t hash = link.find('#');
            const std::string file = link.substr(0, hash);
            const fs::path target = file.empty() ? path : fs::weakly_canonical(path.parent_path() / file);
            REQUIRE(fs::exists(target));
            if (hash == std::string::npos || target.extension() != ".md") continue;
            if (!pages.contains(target)) pages[target] = pageOf(target);
            CHECK(pages[target].anchors.contains(link.substr(hash + 1)));
        }
    CHECK(seen > 150);
}
