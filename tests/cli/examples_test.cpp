// The examples of the documents: every command of README, guide and how-to pages that stands behind a `$` in an
// indented block, run in the order of the document in a folder of its own, and what is shown below it.
//
// What is shown is what a terminal shows, standard error included, line by line:
// - Times (a number and s, ms or µs) are not compared.
// - Other numbers are the same; those with decimals may differ by one in the last digit, for processors round
//   differently.
// - A line `…` stands for one line or more; an example has one at most.
// - A command below which nothing is shown has to succeed. Every command has to, but for those that show an error.
//
// scripts/refresh-docs.sh writes what the program prints now into the documents, by the same rules: lines that are the
// same stay, and so do times where the words around them are.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <regex>
#include <sstream>

#include <catch2/catch.hpp>
#include <sys/wait.h>

#include "cli_runner.h"
#include "command_line.h"
#include "printed_lines.h"

using pellucid::cli::shellQuoted;
using pellucid::test::kTime;
using pellucid::test::Lines;
using pellucid::test::linesOf;
using pellucid::test::sameLine;
using pellucid::test::textOf;
using pellucid::test::timeless;
using pellucid::test::Workshop;

namespace fs = std::filesystem;

namespace {

const std::string kIndent = "    ", kPrompt = kIndent + "$ ", kLeftOut = "…";

struct Example {
    std::string command;    ///< of several lines where it goes on behind a backslash
    std::size_t begin, end; ///< lines of the document that are its output, from 0
    Lines shown;            ///< these, without indentation
};

std::vector<Example> examplesOf(const Lines& document) {
    std::vector<Example> examples;
    for (std::size_t i = 0; i < document.size();) {
        if (!document[i].starts_with(kPrompt)) {
            ++i;
            continue;
        }
        Example example;
        example.command = document[i].substr(kPrompt.size());
        while (example.command.ends_with("\\") && i + 1 < document.size()) example.command += "\n" + document[++i];
        example.begin = example.end = ++i;
        while (i < document.size() && document[i].starts_with(kIndent) && !document[i].starts_with(kPrompt)) {
            example.shown.push_back(document[i].substr(kIndent.size()));
            example.end = ++i;
        }
        examples.push_back(std::move(example));
    }
    return examples;
}

/// `line` with the times of the first of `shown` that has the same words.
std::string withTimesOf(const Lines& shown, const std::string& line) {
    static const std::regex kNumber("[0-9][0-9.e-]*");
    const auto words = [](const std::string& text) { return std::regex_replace(timeless(text), kNumber, "#"); };
    for (const std::string& one : shown) {
        if (words(one) != words(line)) continue;
        std::string result;
        std::sregex_iterator old(one.begin(), one.end(), kTime);
        std::size_t from = 0;
        for (std::sregex_iterator i(line.begin(), line.end(), kTime), end; i != end; ++i, ++old) {
            result += line.substr(from, static_cast<std::size_t>(i->position()) - from) + old->str();
            from = static_cast<std::size_t>(i->position() + i->length());
        }
        return result + line.substr(from);
    }
    return line;
}

bool sameLines(const Lines& shown, const Lines& printed) {
    const auto leftOut = std::find(shown.begin(), shown.end(), kLeftOut);
    if (leftOut == shown.end()) return std::equal(shown.begin(), shown.end(), printed.begin(), printed.end(), sameLine);
    const auto before = leftOut - shown.begin(), after = shown.end() - leftOut - 1;
    return static_cast<std::ptrdiff_t>(printed.size()) > before + after &&
           std::equal(shown.begin(), leftOut, printed.begin(), sameLine) &&
           std::equal(leftOut + 1, shown.end(), printed.end() - after, sameLine);
}

/// What a document shows of it: as much on both sides of what is left out as before.
Lines shortened(const Lines& printed, const Lines& shown) {
    const auto leftOut = std::find(shown.begin(), shown.end(), kLeftOut);
    if (leftOut == shown.end()) return printed;
    const auto before = leftOut - shown.begin(), after = shown.end() - leftOut - 1;
    if (static_cast<std::ptrdiff_t>(printed.size()) <= before + after) return printed;
    Lines lines(printed.begin(), printed.begin() + before);
    lines.push_back(kLeftOut);
    lines.insert(lines.end(), printed.end() - after, printed.end());
    return lines;
}

/// A folder in which the commands of a document work: with the program where README builds it, and the data of the
/// repository.
class Desk {
public:
    Desk() {
        fs::create_directories(m_folder.path("build/release"));
        fs::create_directory_symlink(fs::path(PELLUCID_CLI).parent_path(), m_folder.path("build/release/bin"));
        fs::create_directory_symlink(PELLUCID_SOURCE_DIR "/data", m_folder.path("data"));
    }

    struct Printed {
        int status = -1;
        Lines lines;
    };
    Printed run(const std::string& command) const {
        // Software draws no faster than the cpu, so that it is the engine everywhere.
        const std::string script = "cd " + shellQuoted(m_folder.path("").string()) +
                                   " && export PATH=" + shellQuoted(fs::path(PELLUCID_CLI).parent_path().string()) +
                                   ":\"$PATH\" HOME=\"$PWD\" PELLUCID_GL_PLATFORM=osmesa\n" + command + "\n";
        m_scripts.write("example.sh", script);
        FILE* pipe = popen(("bash " + shellQuoted(m_scripts.path("example.sh").string()) + " 2>&1").c_str(), "r");
        REQUIRE(pipe != nullptr);
        std::string text;
        std::array<char, 4096> buffer{};
        while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) text += buffer.data();
        const int status = pclose(pipe);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, linesOf(text)};
    }

private:
    Workshop m_folder, m_scripts;
};

std::string joined(const Lines& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

/// Runs the examples of a document.
void runExamples(const std::string& name) {
    const bool refreshes = std::getenv("PELLUCID_REFRESH_DOCS") != nullptr;
    const fs::path path = fs::path(PELLUCID_SOURCE_DIR) / name;
    Lines document = linesOf(textOf(path));
    const std::vector<Example> examples = examplesOf(document);
    const Desk desk;
    int ran = 0;
    std::ptrdiff_t shift = 0; // of lines behind what was refreshed
    for (const Example& example : examples) {
        ++ran;
        const Desk::Printed printed = desk.run(example.command);
        INFO(name << ", line " << example.begin << ": " << example.command);
        INFO("printed:\n" << joined(printed.lines));
        const bool failsAsShown = !example.shown.empty() && example.shown.back().starts_with("pellucid-cli: error: ");
        CHECK((printed.status == 0) != failsAsShown);
        CHECK(std::count(example.shown.begin(), example.shown.end(), kLeftOut) <= 1);
        if (example.shown.empty() || sameLines(example.shown, printed.lines)) continue;
        if (!refreshes || (printed.status == 0) == failsAsShown || printed.lines.empty()) {
            FAIL_CHECK("this is not what the document shows; scripts/refresh-docs.sh brings it up to date");
            continue;
        }
        Lines fresh = shortened(printed.lines, example.shown);
        for (std::string& line : fresh) line = kIndent + withTimesOf(example.shown, line);
        const auto begin = document.begin() + static_cast<std::ptrdiff_t>(example.begin) + shift;
        const auto at = document.erase(begin, begin + static_cast<std::ptrdiff_t>(example.shown.size()));
        document.insert(at, fresh.begin(), fresh.end());
        shift += static_cast<std::ptrdiff_t>(fresh.size()) - static_cast<std::ptrdiff_t>(example.shown.size());
        std::cout << "refreshed " << name << ": " << example.command << "\n";
    }
    CHECK(ran > 0); // else there is nothing to test here any more
    if (refreshes) std::ofstream(path) << joined(document);
}

} // namespace

TEST_CASE("examples are compared by their rules", "[cli][examples]") {
    CHECK(sameLine("engine cpu: search 2.10 s, total 12.3 ms", "engine cpu: search 812.0 ms, total 4 µs"));
    CHECK_FALSE(sameLine("engine cpu: search 2.10 s", "engine gl: search 2.10 s"));
    CHECK(sameLine("F 0.0254889", "F 0.025489")); // 0.0254890
    CHECK(sameLine("f1  0.1234  0.9999", "f1  0.1235  1.0000"));
    CHECK_FALSE(sameLine("f1  0.1234", "f1  0.1236"));
    CHECK_FALSE(sameLine("f1  0.1234", "f1  0.1234  0.5"));
    CHECK_FALSE(sameLine("8 iterations", "9 iterations"));
    CHECK_FALSE(sameLine("5 moves and 3 seeds", "5 moves and 4 seeds")); // "s" of a word is no unit

    const Lines printed{"head", "a", "b", "foot"};
    CHECK(sameLines({"head", "…", "foot"}, printed));
    CHECK(sameLines({"head", "…"}, printed));
    CHECK(sameLines({"…", "b", "foot"}, printed));
    CHECK_FALSE(sameLines({"head", "…", "a", "b", "foot"}, printed)); // stands for one line at least
    CHECK_FALSE(sameLines({"head", "…", "a", "foot"}, printed));
    CHECK_FALSE(sameLines({"head", "a", "foot"}, printed));
    CHECK(shortened(printed, {"old", "…", "foot"}) == Lines{"head", "…", "foot"});
    CHECK(shortened(printed, {"old"}) == printed);

    CHECK(withTimesOf({"x 1 s", "search 2.10 s, F 0.5"}, "search 812.0 ms, F 0.25") == "search 2.10 s, F 0.25");
    CHECK(withTimesOf({"search 2.10 s"}, "reading 812.0 ms") == "reading 812.0 ms");

    const std::vector<Example> examples = examplesOf(linesOf(
        "Text\n\n    $ first --with \\\n        more\n    one\n    two\n    $ render nucleon.mhd\n\n    no example\n"));
    REQUIRE(examples.size() == 2);
    CHECK(examples[0].command == "first --with \\\n        more");
    CHECK(examples[0].shown == Lines{"one", "two"});
    CHECK(examples[1].shown.empty());
}

TEST_CASE("README's examples are true", "[cli][examples][documents]") { runExamples("README.md"); }
TEST_CASE("the guide's examples are true", "[cli][examples][documents]") { runExamples("docs/guide.md"); }
TEST_CASE("the examples of how-to pages are true", "[cli][examples][documents]") {
    for (const char* page : {"ct", "microscopy", "simulation"}) runExamples(std::string("docs/how-to/") + page + ".md");
}
