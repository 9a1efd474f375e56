// pellucid-gpu-check: whether OpenGL works for Pellucid on the machine that it is copied to, and how fast
// (docs/gpu-check.md).
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <gnu/libc-version.h>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "bench/bench.h"
#include "child.h"
#include "gl_tests.h"
#include "render/gl/headless_context.h"
#include "rows.h"

namespace pellucid::gpu_check {

namespace {

constexpr const char* kProgram = "pellucid-gpu-check";
constexpr int kQuickSize = 64;                                            ///< voxels along the longest side
constexpr double kGlSeconds = 60, kTestSeconds = 300, kRowsSeconds = 900; ///< what a part may take

struct Options {
    bool testsOnly = false, benchOnly = false, quick = false, list = false;
    int size = 0;
    // How this program starts itself.
    std::string part, name;
    std::vector<double> memcpyGbPerS;
    EngineChoice engine = EngineChoice::Gl;
};

void tell(const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); }

std::string secondsText(double seconds) {
    std::string text(32, '\0');
    text.resize(static_cast<std::size_t>(std::snprintf(text.data(), text.size(), seconds < 1 ? "%.2f ms" : "%.2f s",
                                                       seconds < 1 ? 1e3 * seconds : seconds)));
    return text;
}

/// The model that /proc/cpuinfo names; empty where it names none.
std::string processorModel() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name") && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    return {};
}

/// Throws Error where there is no context.
Json jsonOfGl() {
    const gl::HeadlessContext context;
    const GlInfo& info = context.info();
    Json limits = Json::object();
    for (const auto& [name, value] : info.limits) limits[name] = value;
    return {{"vendor", info.vendor},     {"renderer", info.renderer}, {"version", info.version},
            {"platform", info.platform}, {"software", info.software}, {"limits", limits}};
}

/// The part of the work that this process was started for.
void runThisPart(const Options& o) {
    if (o.part == "gl")
        answerPart({{"gl", jsonOfGl()}});
    else if (o.part == "test") {
        setenv("PELLUCID_REQUIRE_GL", "1", 1); // a driver that has worked before must not be gone now
        answerPart(runGlTest(o.name));
    } else if (o.part == "rows")
        answerPart(measureRows({o.engine, o.name, o.size, o.quick, o.memcpyGbPerS}));
    else
        throw UsageError("there is no part '" + o.part + "'", "--part", "leave it out");
}

class Check {
public:
    explicit Check(const Options& options) : m_options(options) {}

    /// All of it; the exit status.
    int run() {
        probe();
        if (!m_options.benchOnly) tests();
        if (!m_options.testsOnly) rows();
        const bool ok = m_gl.is_object() && m_failed == 0 && m_broken == 0;
        Json json{{"command", "gpu-check"}, {"version", PELLUCID_VERSION}, {"machine", machine()}, {"gl", m_gl}};
        if (!m_glProblem.empty()) json["gl_problem"] = m_glProblem;
        json["tests"] = m_tests;
        json["memcpy"] = m_memcpy;
        json["rows"] = m_rows;
        json["notices"] = m_notices;
        json["summary"] = {{"ok", ok},           {"tests", m_tests.size()},     {"passed", m_passed},
                           {"failed", m_failed}, {"skipped", m_skipped},        {"rows", m_rows.size()},
                           {"broken", m_broken}, {"seconds", m_watch.seconds()}};
        const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
        if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
            throw Error("cannot write the answer", "standard output", "check where it goes, and the space there");
        tell(std::string(ok ? "All well: " : "NOT well: ") + std::to_string(m_passed) + " tests passed, " +
             std::to_string(m_failed) + " failed, " + std::to_string(m_skipped) + " skipped; " +
             std::to_string(m_rows.size()) + " rows; " + secondsText(m_watch.seconds()));
        return ok ? 0 : 1;
    }

private:
    static Json machine() {
        return {{"processor", processorModel()},
                {"threads", benchThreads().back()},
                {"glibc", gnu_get_libc_version()},
                {"built_with_glibc", std::to_string(__GLIBC__) + "." + std::to_string(__GLIBC_MINOR__)}};
    }

    void probe() {
        const PartResult result = runPart({"--part", "gl"}, kGlSeconds);
        if (result.answer && result.answer->contains("gl")) m_gl = (*result.answer)["gl"];
        if (m_gl.is_object()) {
            tell(m_gl["renderer"].get<std::string>() + ", OpenGL " + m_gl["version"].get<std::string>() + ", " +
                 m_gl["platform"].get<std::string>() + (m_gl["software"].get<bool>() ? " (no GPU)" : ""));
            return;
        }
        m_glProblem = result.problem;
        tell("No OpenGL: " + m_glProblem);
    }

    void tests() {
        if (!m_gl.is_object()) return;
        std::vector<GlTest> all = glTests();
        if (m_options.quick) std::erase_if(all, [](const GlTest& test) { return test.slow; });
        for (std::size_t n = 0; n < all.size(); ++n) {
            const PartResult result = runPart({"--part", "test", "--name", all[n].name}, kTestSeconds);
            const Json failures = result.problem.empty() ? (*result.answer)["failures"] : Json::array({result.problem});
            const bool passed = failures.empty(), skipped = passed && !result.skipped.empty();
            ++(!passed ? m_failed : skipped ? m_skipped : m_passed);
            Json test{{"name", all[n].name}, {"passed", passed}, {"seconds", result.seconds}, {"failures", failures}};
            if (skipped) test["skipped"] = result.skipped;
            m_tests.push_back(std::move(test));
            tell("test " + std::to_string(n + 1) + "/" + std::to_string(all.size()) + "  " +
                 (!passed   ? "FAILED  "
                  : skipped ? "skipped "
                            : "passed  ") +
                 all[n].name + "  (" + secondsText(result.seconds) + ")");
            for (const Json& failure : failures) tell("    " + failure.get<std::string>());
        }
    }

    void rows() {
        std::string memcpyText;
        for (const int threads : benchThreads()) {
            const double rate = memcpyGbPerS(threads, {});
            m_memcpy.push_back({{"threads", threads}, {"gb_per_s", rate}});
            memcpyText += (memcpyText.empty() ? "" : ",") + std::to_string(rate);
        }
        setThreadCount(0);
        for (const char* engine : {"gl", "cpu"})
            for (const std::string& volumes : rowVolumes()) {
                if (engine == std::string("gl") && !m_gl.is_object()) continue;
                std::vector<std::string> arguments{"--part",   "rows",    "--name", volumes,
                                                   "--engine", engine,    "--size", std::to_string(size()),
                                                   "--memcpy", memcpyText};
                if (m_options.quick) arguments.emplace_back("--quick");
                const PartResult result = runPart(arguments, kRowsSeconds);
                addRows(result, std::string(engine) + " " + volumes);
            }
    }

    void addRows(const PartResult& result, const std::string& what) {
        if (!result.problem.empty()) {
            ++m_broken;
            m_notices.push_back("the rows of " + what + " are missing: " + result.problem);
            tell("rows  " + m_notices.back().get<std::string>());
            return;
        }
        for (const Json& row : (*result.answer)["rows"]) {
            std::string line = "row  " + row["engine"].get<std::string>() + "  " + row["volume"].get<std::string>() +
                               "  " + row.value("tf", std::string()) + "  " + row["name"].get<std::string>();
            for (const char* key : {"candidates", "features", "size", "lit", "threads"})
                if (row.contains(key)) line += std::string("  ") + key + " " + row[key].dump();
            tell(line + "  " + secondsText(row["seconds"].get<double>()));
            m_rows.push_back(row);
        }
        for (const Json& notice : (*result.answer)["notices"]) {
            ++m_broken; // a row that the engine could not do
            tell("rows  " + notice.get<std::string>());
            m_notices.push_back(notice);
        }
    }

    int size() const { return m_options.size > 0 ? m_options.size : m_options.quick ? kQuickSize : 0; }

    const Options& m_options;
    Stopwatch m_watch;
    Json m_gl = nullptr; ///< an object where there is a context
    std::string m_glProblem;
    Json m_tests = Json::array(), m_memcpy = Json::array(), m_rows = Json::array(), m_notices = Json::array();
    int m_passed = 0, m_failed = 0, m_skipped = 0, m_broken = 0;
};

int run(int argc, char** argv) {
    CLI::App program("Checks OpenGL on this machine for Pellucid: runs its GL tests, and measures how fast its GL and "
                     "CPU engines are on built-in volumes. Needs glibc and a driver's libEGL.so.1, no files. JSON goes "
                     "to standard output, progress to standard error.",
                     kProgram);
    Options o;
    program.set_version_flag("--version", std::string(kProgram) + " " + PELLUCID_VERSION, "print the version");
    bool json = true;
    program.add_flag("--json", json, "JSON on standard output (always done)");
    auto* testsOnly = program.add_flag("--tests-only", o.testsOnly, "only the tests");
    program.add_flag("--bench-only", o.benchOnly, "only the rows of the benchmark")->excludes(testsOnly);
    program.add_flag("--quick", o.quick, "leave slow tests out, measure each row once, on volumes of 64 voxels");
    program
        .add_option("--size", o.size,
                    "voxels along the longest side of the volumes measured (default: knee 379, cubes 128 and 256)")
        ->type_name("N")
        ->check(CLI::Range(8, 1024));
    program.add_flag("--list", o.list, "print the names of tests and of what is measured, and stop");
    program.add_option("--part", o.part)->group("");
    program.add_option("--name", o.name)->group("");
    program.add_option("--memcpy", o.memcpyGbPerS)->delimiter(',')->group("");
    std::string engine = "gl";
    program.add_option("--engine", engine)->group("");
    program.footer("Exit status: 0 all well, 1 there is no OpenGL, a test failed or a row is missing, 2 wrong usage.\n"
                   "Each test runs in a process of its own, so that one that a driver crashes in costs no other.");
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) return program.exit(e); // help and version
        std::fprintf(stderr, "%s: %s, see %s --help\n", kProgram, e.what(), kProgram);
        return 2;
    }
    if (!o.part.empty()) {
        o.engine = fromName<EngineChoice>(engine);
        try {
            runThisPart(o);
        } catch (const Error& e) {
            answerPart({{"problem", e.what()}});
        }
        return 0;
    }
    if (o.list) {
        for (const GlTest& test : glTests()) std::printf("test %s%s\n", test.name.c_str(), test.slow ? " (slow)" : "");
        for (const std::string& volumes : rowVolumes()) std::printf("rows %s\n", volumes.c_str());
        return 0;
    }
    return Check(o).run();
}

} // namespace

} // namespace pellucid::gpu_check

int main(int argc, char** argv) {
    try {
        return pellucid::gpu_check::run(argc, argv);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "pellucid-gpu-check: %s\n", e.what());
        return dynamic_cast<const pellucid::UsageError*>(&e) != nullptr ? 2 : 1;
    }
}
