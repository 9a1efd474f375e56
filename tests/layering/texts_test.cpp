// docs/texts.md lists what people can read in the window and on the command line, for reading it aloud; and no figure
// has a scientific name where nobody asked for one (docs/guide.md, "Glossary").
#include <catch2/catch.hpp>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path kRepository = PELLUCID_SOURCE_DIR;

/// A string of the sources; literals that stand next to each other are one.
struct Literal {
    std::string file;   ///< relative to the top
    std::string text;   ///< as it is written, escapes included
    std::string before; ///< the code before it, of this statement
};

std::string readWhole(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// Reads one source file: strings, between comments, characters and directives.
class LiteralReader {
public:
    LiteralReader(std::string file, std::string source) : m_file(std::move(file)), m_source(std::move(source)) {}

    std::vector<Literal> read() {
        while (m_at < m_source.size()) step();
        return std::move(m_all);
    }

private:
    bool sees(const char* what) const {
        return m_source.compare(m_at, std::char_traits<char>::length(what), what) == 0;
    }

    void skipPast(const char* end) {
        const std::size_t found = m_source.find(end, m_at);
        m_at = found == std::string::npos ? m_source.size() : found + std::char_traits<char>::length(end);
    }

    bool lineHasOnlySpaceBefore() const {
        std::size_t i = m_at;
        while (i > 0 && (m_source[i - 1] == ' ' || m_source[i - 1] == '\t')) --i;
        return i == 0 || m_source[i - 1] == '\n';
    }

    void step() {
        if (sees("//") || (sees("#") && lineHasOnlySpaceBefore())) return skipPast("\n");
        if (sees("/*")) return skipPast("*/");
        if (sees("R\"(")) return readRaw();
        const char c = m_source[m_at];
        // 1'000'000 has no characters between its marks, U'"' has.
        if (c == '\'' && m_at > 0 && std::isxdigit(static_cast<unsigned char>(m_source[m_at - 1]))) return pass(c);
        if (c == '\'' || c == '"') return readQuoted(c);
        pass(c);
    }

    void pass(char c) {
        ++m_at;
        if (!std::isspace(static_cast<unsigned char>(c))) m_joins = false;
        m_before = c == ';' ? std::string() : m_before + c;
    }

    void readRaw() {
        const std::size_t from = m_at + 3;
        skipPast(")\"");
        keep(m_source.substr(from, m_at - 2 - from));
    }

    void readQuoted(char mark) {
        const std::size_t from = ++m_at;
        while (m_at < m_source.size() && m_source[m_at] != mark) m_at += m_source[m_at] == '\\' ? 2 : 1;
        const std::string text = m_source.substr(from, m_at - from);
        ++m_at;
        if (mark == '"') keep(text);
    }

    void keep(const std::string& text) {
        if (m_joins)
            m_all.back().text += text;
        else
            m_all.push_back({m_file, text, m_before});
        m_joins = true;
    }

    std::string m_file, m_source, m_before;
    std::size_t m_at = 0;
    bool m_joins = false;
    std::vector<Literal> m_all;
};

/// The names of the calls, and the members of a table, that a literal stands in; the innermost first.
std::vector<std::string> placesOf(const std::string& before) {
    std::vector<std::string> places;
    static const std::regex member(R"(\.(\w+)\s*=[^,]*$)"), assigned(R"((\w+)\s*=\s*[^=,]*$)");
    std::smatch match;
    if (std::regex_search(before, match, member) || std::regex_search(before, match, assigned))
        places.push_back(match[1]);
    int depth = 0;
    for (std::size_t i = before.size(); i-- > 0;) {
        if (before[i] == ')') ++depth;
        if (before[i] != '(' || depth-- > 0) continue;
        depth = 0;
        std::size_t from = i;
        while (from > 0 && (std::isalnum(static_cast<unsigned char>(before[from - 1])) || before[from - 1] == '_'))
            --from;
        places.push_back(before.substr(from, i - from));
    }
    return places;
}

bool isIn(const Literal& literal, const std::regex& names) {
    for (const std::string& place : placesOf(literal.before))
        if (std::regex_match(place, names)) return true;
    return false;
}

/// What the window translates, and elsewhere what has two words.
bool isForPeople(const Literal& literal) {
    static const std::regex phrase(R"([A-Za-z]{2,}[,;:.%]? +[A-Za-z(%])"), translated("tr|translate|QT_TR_NOOP");
    if (literal.text.find_first_not_of(" \\n") == std::string::npos) return false;
    return isIn(literal, translated) || std::regex_search(literal.text, phrase);
}

/// Shown on request, where scientific names and formulas belong.
bool isTip(const Literal& literal) {
    static const std::regex tips("\\w*[tT](ool|)[tT]ip|help|add(_\\w+|[A-Z]\\w*)");
    return isIn(literal, tips);
}

/// Of a column of a table on the command line, which others read by these names.
bool isHead(const Literal& literal) {
    static const std::regex tables("[tT]able");
    return literal.file.rfind("app/cli/", 0) == 0 &&
           (isIn(literal, tables) || literal.before.find("std::string head = ") != std::string::npos);
}

/// In the order of their files.
std::vector<Literal> textsForPeople() {
    std::vector<fs::path> files;
    for (const char* folder : {"app", "src"})
        for (const auto& entry : fs::recursive_directory_iterator(kRepository / folder)) {
            const std::string suffix = entry.path().extension().string();
            if (suffix == ".h" || suffix == ".cpp") files.push_back(entry.path());
        }
    std::sort(files.begin(), files.end());
    std::vector<Literal> all;
    for (const fs::path& file : files)
        for (Literal& literal : LiteralReader(fs::relative(file, kRepository).generic_string(), readWhole(file)).read())
            if (isForPeople(literal)) all.push_back(std::move(literal));
    return all;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

std::string listOf(const std::vector<Literal>& literals) {
    std::string list = "# Texts\n\nWhat people can read in the window and on the command line, file by file. *(tip)*: "
                       "in a tooltip or behind `--help`. Made by the\ntests; `PELLUCID_REFRESH_DOCS=1 test_layering "
                       "'[texts]'` writes it anew.\n";
    std::string file;
    for (const Literal& literal : literals) {
        if (literal.file != file) list += "\n## " + literal.file + "\n\n";
        file = literal.file;
        const std::string text = replaced(replaced(literal.text, "\\n", " ¶ "), "\\\"", "\"");
        list += std::string("- ") + (isTip(literal) ? "*(tip)* " : "") + "`" + replaced(text, "`", "´") + "`\n";
    }
    return list;
}

} // namespace

TEST_CASE("strings are found in code as the compiler finds them", "[texts]") {
    const auto literals =
        LiteralReader("a.cpp", "#include \"not this\"\n"
                               "// nor \"this\"\n"
                               "f(tr(\"One \\\"text\\\" \"\n    \"in two pieces\"), 'x', '\"', 1'000);\n"
                               "g.setToolTip(tr(\"A tip\")); h({.help = \"Helps with it\"});\n"
                               "const auto s = R\"(raw \"text\")\";")
            .read();
    REQUIRE(literals.size() == 4);
    CHECK(literals[0].text == "One \\\"text\\\" in two pieces");
    CHECK(isForPeople(literals[0]));
    CHECK_FALSE(isTip(literals[0]));
    CHECK(literals[1].text == "A tip");
    CHECK(isTip(literals[1]));
    CHECK(isTip(literals[2]));
    CHECK(literals[3].text == "raw \"text\"");
    CHECK_FALSE(isForPeople({"a.cpp", "disks", "f("}));
}

TEST_CASE("docs/texts.md has every text", "[texts]") {
    const fs::path path = kRepository / "docs/texts.md";
    const std::string list = listOf(textsForPeople());
    if (std::getenv("PELLUCID_REFRESH_DOCS") != nullptr) std::ofstream(path, std::ios::binary) << list;
    INFO("PELLUCID_REFRESH_DOCS=1 test_layering '[texts]' writes it anew");
    CHECK((readWhole(path) == list)); // in brackets: nobody wants to read both
}

TEST_CASE("figures have plain names outside tooltips", "[texts]") {
    static const std::regex scientific(R"(\bVWS\b|\bF = |\balpha\b(?!=)|(^|[^-])\biterations?\b)");
    // What compares with the thesis, the reports with their tables, and the names themselves. What stands in panels,
    // and what in their tooltips, a window tells (tests/gui/views_test.cpp).
    static const std::regex science("app/cli/(reproduce|study)\\b.*|src/report/.*|app/gui/(panels/.*|widgets/terms.cpp|"
                                    "controllers/study_controller.cpp|window/status_line.cpp)");
    for (const Literal& literal : textsForPeople()) {
        if (isTip(literal) || isHead(literal) || std::regex_match(literal.file, science)) continue;
        INFO(literal.file << ": " << literal.text);
        CHECK_FALSE(std::regex_search(literal.text, scientific));
    }
}
