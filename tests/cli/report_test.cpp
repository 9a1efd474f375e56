// optimize --report and --curves: one page about what was done, curves as files.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "command_line.h"

using nlohmann::json;
using pellucid::test::Outcome;
using pellucid::test::Running;
using pellucid::test::operator+;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kOptimize{"optimize", "sample:shells", "--size",   "20",  "--tf",          "tents:3",
                      "--target", "1,3,6",         "--engine", "cpu", "--exact-shares"};

/// What stands between two marks.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
    const std::size_t at = text.find(begin);
    REQUIRE(at != std::string::npos);
    const std::size_t from = at + begin.size();
    return text.substr(from, text.find(end, from) - from);
}

std::string unescaped(std::string text) {
    for (const auto& [entity, plain] : {std::pair<std::string, std::string>{"&#39;", "'"},
                                        {"&quot;", "\""},
                                        {"&lt;", "<"},
                                        {"&gt;", ">"},
                                        {"&amp;", "&"}})
        for (std::size_t at = text.find(entity); at != std::string::npos; at = text.find(entity, at + plain.size()))
            text.replace(at, entity.size(), plain);
    return text;
}

} // namespace

TEST_CASE("a report has pictures of the moves and the command that repeats it", "[cli][report]") {
    const Workshop w;
    const json plain = w.json(kOptimize);
    const json j = w.json(kOptimize + Words{"--report", "my report", "--report-size", "64x48", "--curves", "c.svg"});
    // The report changes nothing of the answer.
    CHECK(j["objective"] == plain["objective"]);
    CHECK(j["vws"] == plain["vws"]);
    CHECK(w.list() == std::vector<std::string>{"c.svg", "my report"});
    CHECK(j["report"]["file"] == "my report/report.html");
    CHECK(j["report"]["size"] == json{64, 48});
    const std::size_t moves = j["objective"].size();
    REQUIRE(moves < 40);
    REQUIRE(j["report"]["states"].size() == moves); // each has a picture
    int below = 0;
    for (std::size_t i = 0; i < moves; ++i) {
        const double ssim = j["report"]["states"][i]["ssim"].get<double>();
        CHECK(j["report"]["states"][i]["move"] == i);
        CHECK(ssim <= 1 + 1e-12);
        if (ssim < 1 - 1e-12 && j["objective"][i].get<double>() < 0.03) ++below;
    }
    CHECK(j["report"]["threshold"]["states"].get<int>() >= below);

    const std::string html = w.read("my report/report.html");
    CHECK(html.starts_with("<!DOCTYPE html>"));
    CHECK(html.ends_with("</html>\n"));
    CHECK(html.find("64x48") != std::string::npos);
    // The curves have a line for each state, after the head.
    const std::string csv = w.read("my report/curves.csv");
    CHECK(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) == moves + 1);
    CHECK(w.read("c.svg").starts_with("<?xml"));

    // Typed into a shell, the command does the same again.
    const std::string command = unescaped(between(html, "<code>", "</code>"));
    CHECK(command.starts_with("pellucid-cli optimize sample:shells --size 20 "));
    const std::string line =
        "cd '" + w.path("").string() + "' && " + PELLUCID_CLI + command.substr(std::string("pellucid-cli").size());
    FILE* pipe = popen(line.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::string out;
    std::array<char, 4096> buffer{};
    while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) out += buffer.data();
    CHECK(pclose(pipe) == 0);
    CHECK(json::parse(out)["objective"] == j["objective"]);
}

TEST_CASE("curves are written as a table or a drawing", "[cli][report]") {
    const Workshop w;
    const Outcome o = w.run(kOptimize + Words{"--curves", "c.csv", "--max-iterations", "1"});
    CHECK(o.status == 0);
    CHECK(o.out.find("wrote c.csv\n") != std::string::npos);
    const std::string csv = w.read("c.csv");
    CHECK(csv.starts_with("run,method,move,level,F,VWS f1,target f1,opacity f1,"));
    // The start: opacities of the tents, targets 0.1, 0.3, 0.6.
    const std::string start = csv.substr(csv.find('\n') + 1, csv.find('\n', csv.find('\n') + 1) - csv.find('\n') - 1);
    CHECK(std::count(start.begin(), start.end(), ',') == 4 + 9);
    CHECK(start.find(",0.1,0.5,") != std::string::npos);
    CHECK(start.ends_with(",0.6,0.5"));
}

TEST_CASE("reports are refused before the work where they cannot be written", "[cli][report]") {
    const Workshop w;
    w.write("file", "in the way");
    const auto fails = [&](const Words& words, int status, const std::string& say) {
        INFO(words.back());
        const Outcome o = w.run(kOptimize + words);
        CHECK(o.status == status);
        CHECK(o.out.empty());
        CHECK(o.err.find(say) != std::string::npos);
    };
    fails({"--report", "file"}, 1, "a file has the folder's name");
    fails({"--report", "none/deep"}, 1, "none");
    fails({"--report", ""}, 2, "--report");
    fails({"--curves", "c.txt"}, 2, ".csv or .svg");
    fails({"--report-size", "64x48"}, 2, "--report");
    fails({"--report", "r", "--report-size", "0x4"}, 2, "--report-size");
    CHECK(w.list() == std::vector<std::string>{"file"});
    CHECK(w.read("file") == "in the way");
}

TEST_CASE("Ctrl-C leaves no half of a report", "[cli][report][interrupt]") {
    const Workshop w;
    w.write("old.svg", "an older one");
    Running running(w, kOptimize + Words{"--report", "r", "--report-size", "4000x4000", "--progress"});
    REQUIRE(running.waitForError("drawing the report 0 %"));
    running.signal(SIGINT);
    CHECK(running.finish().status == 130);
    CHECK(w.list() == std::vector<std::string>{"old.svg"});
}

TEST_CASE("words are quoted for a shell", "[cli][report]") {
    using pellucid::cli::shellQuoted;
    CHECK(shellQuoted("sample:shells") == "sample:shells");
    CHECK(shellQuoted("a b") == "'a b'");
    CHECK(shellQuoted("") == "''");
    CHECK(shellQuoted("it's $HOME; rm *") == "'it'\\''s $HOME; rm *'");
    const Words words{"render", "my volume.nrrd"};
    CHECK(pellucid::cli::commandLineOf(words) == "pellucid-cli render 'my volume.nrrd'");
}
