// Ctrl-C: exit status 130 from the middle of work that would take minutes, and nothing half-written.
#include <algorithm>
#include <csignal>

#include <catch2/catch.hpp>

#include "cli_runner.h"

using pellucid::test::Outcome;
using pellucid::test::Running;
using pellucid::test::Workshop;

namespace {

/// Interrupts when `phase` is on stderr.
Outcome interrupted(const Workshop& w, std::vector<std::string> arguments, const std::string& phase,
                    int signal = SIGINT) {
    arguments.emplace_back("--progress");
    Running running(w, arguments);
    REQUIRE(running.waitForError(phase));
    running.signal(signal);
    return running.finish();
}

} // namespace

TEST_CASE("Ctrl-C ends a measurement with status 130 and no answer", "[cli][interrupt]") {
    const Workshop w;
    // The reference engine marches sixteen steps per voxel from each of 229³ voxels: minutes.
    const Outcome o = interrupted(w, {"measure", "sample:shells", "--size", "229", "--engine", "reference", "--json"},
                                  "visibility 0 %");
    CHECK(o.status == 130);
    CHECK(o.out.empty());
    CHECK(o.err.find("error") == std::string::npos);
}

TEST_CASE("Ctrl-C ends a benchmark in the middle of a row", "[cli][interrupt]") {
    const Workshop w;
    const Outcome o = interrupted(
        w, {"bench", "sample:shells", "--size", "229", "--engine", "reference", "--only", "sweep", "--threads", "2"},
        "sample:shells, default 0 %");
    CHECK(o.status == 130);
    CHECK(o.out.empty());
}

TEST_CASE("Ctrl-C leaves no output file", "[cli][interrupt]") {
    const Workshop w;
    w.write("old.png", "an older picture");
    CHECK(interrupted(w,
                      {"render", "sample:shells", "--out", "old.png", "--size", "8000x8000", "--step", "0.01",
                       "--engine", "cpu"},
                      "rendering 0 %")
              .status == 130);
    CHECK(interrupted(w, {"generate", "knee", "--out", "knee.nrrd"}, "generating 0 %").status == 130);
    CHECK(interrupted(w, {"fields", "sample:knee", "--engine", "reference", "--out", "fields"}, "loading 0 %").status ==
          130);
    CHECK(w.list() == std::vector<std::string>{"old.png"});
    CHECK(w.read("old.png") == "an older picture");
}

TEST_CASE("Ctrl-C while a file is being written leaves all of it or nothing", "[cli][interrupt]") {
    const Workshop w;
    const Outcome o = interrupted(w, {"generate", "shells", "--size", "160", "--out", "s.nrrd"}, "writing 0 %");
    // The writer may have come to its end before the signal; then the file is whole.
    CHECK((o.status == 0 || o.status == 130));
    if (!w.list().empty()) {
        CHECK(w.list() == std::vector<std::string>{"s.nrrd"});
        CHECK(w.run({"info", "s.nrrd"}).status == 0);
    }
}

TEST_CASE("Ctrl-C reaches a process whose shell has it ignored", "[cli][interrupt]") {
    const Workshop w;
    // As in a background job of a script.
    const auto before = std::signal(SIGINT, SIG_IGN);
    const Outcome o =
        interrupted(w, {"measure", "sample:shells", "--size", "229", "--engine", "reference"}, "visibility 0 %");
    std::signal(SIGINT, before);
    CHECK(o.status == 130);
}

TEST_CASE("SIGTERM ends with status 143", "[cli][interrupt]") {
    const Workshop w;
    const Outcome o = interrupted(w, {"measure", "sample:shells", "--size", "229", "--engine", "reference"},
                                  "visibility 0 %", SIGTERM);
    CHECK(o.status == 143);
    CHECK(o.out.empty());
}
