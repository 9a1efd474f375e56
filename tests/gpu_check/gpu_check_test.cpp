// pellucid-gpu-check as it is run elsewhere: what it needs, what it answers, and what a bad driver costs.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "support/temp_folder.h"

using nlohmann::json;
using pellucid::test::TempFolder;

namespace {

struct Outcome {
    int status = -1;
    std::string out;
};

/// Runs a line of shell; its stderr goes nowhere.
Outcome shell(const std::string& line) {
    Outcome outcome;
    FILE* const pipe = popen((line + " 2>/dev/null").c_str(), "r");
    REQUIRE(pipe != nullptr);
    char buffer[4096];
    for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.out.append(buffer, n);
    const int status = pclose(pipe);
    if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
    return outcome;
}

const std::string kProgram = std::string("'") + PELLUCID_GPU_CHECK + "'";

bool glIsRequired() {
    const char* required = std::getenv("PELLUCID_REQUIRE_GL");
    return required != nullptr && std::string(required) == "1";
}

} // namespace

TEST_CASE("the GPU's check needs no library but those of glibc 2.34, and little space", "[gpu_check]") {
#ifdef PELLUCID_SANITIZED
    std::cout << "SKIPPED: the sanitizers' libraries are needed too\n";
#else
    const std::set<std::string> allowed{"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0",
                                        "ld-linux-x86-64.so.2"};
    std::istringstream needed(shell("readelf -d " + kProgram + " | sed -n 's/.*(NEEDED).*\\[\\(.*\\)\\]/\\1/p'").out);
    std::size_t count = 0;
    for (std::string library; needed >> library; ++count) {
        INFO(library);
        CHECK(allowed.count(library) == 1);
    }
    CHECK(count > 0);
#if __GLIBC__ == 2 && __GLIBC_MINOR__ <= 36 && defined(__x86_64__) // a newer one may bring newer names
    std::istringstream versions(
        shell("readelf -V " + kProgram + " | sed -n 's/.*Name: GLIBC_2\\.\\([0-9]*\\).*/\\1/p'").out);
    count = 0;
    for (int minor = 0; versions >> minor; ++count) CHECK(minor <= 34);
    CHECK(count > 0);
#endif
    CHECK(std::filesystem::file_size(PELLUCID_GPU_CHECK) <= 20'000'000); // stripped or not
#endif
}

TEST_CASE("the GPU's check runs its tests and rows, and answers in JSON", "[gpu_check]") {
    // As on a machine that has nothing of ours: no environment, another folder.
    const TempFolder folder;
    const Outcome outcome = shell("cd '" + folder.path("") + "' && env -i " + kProgram + " --quick --size 24");
    INFO(outcome.out);
    const json j = json::parse(outcome.out);
    CHECK(j["command"] == "gpu-check");
    CHECK(j["version"] == PELLUCID_VERSION);
    CHECK(j["summary"]["rows"] == j["rows"].size());
    std::set<std::string> engines, names;
    for (const json& row : j["rows"]) {
        engines.insert(row["engine"]);
        names.insert(row["name"]);
        CHECK(row["seconds"].get<double>() > 0);
        CHECK(row["memcpy_share"].get<double>() >= 0);
    }
    CHECK(names == std::set<std::string>{"setup", "saliency", "sweep", "jacobian", "optimize", "refine", "render"});
    CHECK(folder.fileCount() == 0);
    if (j["gl"].is_null()) {
        CHECK(outcome.status == 1);
        CHECK(j["gl_problem"].get<std::string>().find("no OpenGL 4.3") != std::string::npos);
        if (glIsRequired()) FAIL("OpenGL is required: " << j["gl_problem"]);
        std::cout << "SKIPPED: " << j["gl_problem"] << '\n';
        return;
    }
    CHECK(outcome.status == 0);
    CHECK(engines == std::set<std::string>{"cpu", "gl"});
    CHECK_FALSE(j["gl"]["renderer"].get<std::string>().empty());
    CHECK(j["gl"]["limits"]["max_3d_texture_size"].get<int>() >= 2048); // what OpenGL 4.3 demands
    CHECK(j["tests"].size() > 20);
    for (const json& test : j["tests"]) {
        INFO(test.dump());
        CHECK(test["passed"] == true);
        CHECK(test["failures"].empty());
        CHECK(test["seconds"].get<double>() > 0);
    }
    CHECK(j["summary"]["ok"] == true);
    CHECK(j["summary"]["passed"].get<int>() + j["summary"]["skipped"].get<int>() == j["summary"]["tests"].get<int>());
}

TEST_CASE("a driver that crashes costs what asks for it, and nothing else", "[gpu_check]") {
    const TempFolder folder;
    const std::string vendor = folder.path("vendor.json");
    std::ofstream(vendor) << json{{"file_format_version", "1.0.0"},
                                  {"ICD", {{"library_path", PELLUCID_CRASHING_DRIVER}}}};
    const Outcome outcome =
        shell("__EGL_VENDOR_LIBRARY_FILENAMES='" + vendor + "' " + kProgram + " --bench-only --quick --size 16");
    INFO(outcome.out);
    const json j = json::parse(outcome.out);
    CHECK(outcome.status == 1);
    if (!j["gl"].is_null() || j["gl_problem"].get<std::string>().find("libEGL.so.1 is missing") != std::string::npos) {
        std::cout << "SKIPPED: there is no libEGL that takes its drivers from a list\n";
        return;
    }
    CHECK(j["gl_problem"].get<std::string>().find("ended by signal") != std::string::npos);
    CHECK(j["summary"]["ok"] == false);
    CHECK(j["tests"].empty());
    REQUIRE(j["rows"].size() > 10);
    for (const json& row : j["rows"]) CHECK(row["engine"] == "cpu");
}

TEST_CASE("the GPU's check says what it is, and what is wrong with its arguments", "[gpu_check]") {
    CHECK(shell(kProgram + " --version").out == std::string("pellucid-gpu-check ") + PELLUCID_VERSION + "\n");
    CHECK(shell(kProgram + " --help").status == 0);
    const Outcome list = shell(kProgram + " --list");
    CHECK(list.status == 0);
    CHECK(list.out.find("test every permutation of every shader compiles\n") != std::string::npos);
    CHECK(list.out.find("nucleon") == std::string::npos); // needs a file
    CHECK(list.out.find("rows knee/tents:3\n") != std::string::npos);
    for (const char* wrong : {" --nothing", " --size 3", " --tests-only --bench-only"}) {
        const Outcome outcome = shell(kProgram + wrong);
        CHECK(outcome.status == 2);
        CHECK(outcome.out.empty());
    }
    // A test that there is not is no test that has passed.
    const Outcome none = shell(kProgram + " --part test --name 'no such test'");
    CHECK(none.out.find("\"passed\":false") != std::string::npos);
}
