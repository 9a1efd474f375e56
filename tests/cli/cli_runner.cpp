#include "cli_runner.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pellucid::test {

namespace fs = std::filesystem;

namespace {

std::string readAll(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

fs::path newFolder() {
    std::string name = (fs::temp_directory_path() / "pellucid-cli-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    return name;
}

} // namespace

Workshop::Workshop() : m_folder(newFolder()) {}
Workshop::~Workshop() {
    std::error_code ec;
    fs::remove_all(m_folder, ec);
}

Outcome Workshop::run(const std::vector<std::string>& arguments) const { return Running(*this, arguments).finish(); }

Outcome Workshop::runWithFilesUpTo(std::size_t mostBytes, const std::vector<std::string>& arguments) const {
    return Running(*this, arguments, mostBytes).finish();
}

namespace {

nlohmann::json answerOf(const Workshop& w, std::vector<std::string> arguments, bool mayHaveNotes) {
    arguments.emplace_back("--json");
    const Outcome outcome = w.run(arguments);
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    if (!mayHaveNotes) REQUIRE(outcome.err.empty());
    return nlohmann::json::parse(outcome.out);
}

} // namespace

nlohmann::json Workshop::json(std::vector<std::string> arguments) const {
    return answerOf(*this, std::move(arguments), false);
}

nlohmann::json Workshop::jsonAndNotes(std::vector<std::string> arguments) const {
    return answerOf(*this, std::move(arguments), true);
}

void Workshop::write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
}
std::string Workshop::read(const std::string& name) const { return readAll(path(name)); }

std::vector<std::string> Workshop::list() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(m_folder)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

Running::Running(const Workshop& workshop, const std::vector<std::string>& arguments,
                 std::optional<std::size_t> mostFileBytes)
    : m_capture(newFolder()) {
    std::vector<std::string> words{PELLUCID_CLI};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string folder = workshop.path("").string();
    const std::string out = (m_capture / "out").string(), err = (m_capture / "err").string();

    m_pid = fork();
    if (m_pid < 0) throw std::runtime_error("fork failed");
    if (m_pid > 0) return;
    const auto redirect = [](const std::string& path, int target) {
        const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        return file >= 0 && dup2(file, target) >= 0;
    };
    if (mostFileBytes) {
        const rlimit limit{*mostFileBytes, *mostFileBytes};
        if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(126);
    }
    if (chdir(folder.c_str()) != 0 || !redirect(out, STDOUT_FILENO) || !redirect(err, STDERR_FILENO)) _exit(126);
    execv(argv[0], argv.data());
    _exit(127);
}

Running::~Running() {
    if (!m_ended) {
        kill(m_pid, SIGKILL);
        reap(true);
    }
    std::error_code ec;
    fs::remove_all(m_capture, ec);
}

bool Running::reap(bool wait) {
    if (!m_ended) m_ended = waitpid(m_pid, &m_waitStatus, wait ? 0 : WNOHANG) == m_pid;
    return m_ended;
}

bool Running::waitForError(const std::string& text) {
    for (;;) {
        const bool ended = reap(false);
        if (readAll(m_capture / "err").find(text) != std::string::npos) return true;
        if (ended) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

void Running::signal(int number) const {
    if (!m_ended) kill(m_pid, number);
}

Outcome Running::finish() {
    reap(true);
    const int status = WIFEXITED(m_waitStatus) ? WEXITSTATUS(m_waitStatus) : -WTERMSIG(m_waitStatus);
    return {status, readAll(m_capture / "out"), readAll(m_capture / "err")};
}

} // namespace pellucid::test
