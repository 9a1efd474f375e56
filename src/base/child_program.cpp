#include "base/child_program.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"

extern char** environ;

namespace pellucid {

namespace {

/// Standard error goes to a file without a name: a pipe would have to be read while the program runs.
struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using Scratch = std::unique_ptr<std::FILE, Closer>;

std::string readBack(std::FILE* file) {
    std::rewind(file);
    std::string text;
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), file)) > 0;) text.append(buffer.data(), n);
    while (text.ends_with('\n')) text.pop_back();
    return text;
}

/// What happens in the new process before the program begins.
class Preparation {
public:
    Preparation() {
        posix_spawn_file_actions_init(&m_actions);
        posix_spawnattr_init(&m_attributes);
    }
    ~Preparation() {
        posix_spawn_file_actions_destroy(&m_actions);
        posix_spawnattr_destroy(&m_attributes);
    }
    Preparation(const Preparation&) = delete;
    Preparation& operator=(const Preparation&) = delete;

    void prepare(const ChildRun& run, std::FILE* error) {
        if (!run.folder.empty()) posix_spawn_file_actions_addchdir_np(&m_actions, run.folder.c_str());
        posix_spawn_file_actions_addopen(&m_actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        if (run.talks) {
            posix_spawn_file_actions_adddup2(&m_actions, STDERR_FILENO, STDOUT_FILENO); // ours is for the answer
        } else {
            const char* const out = run.out.empty() ? "/dev/null" : run.out.c_str();
            posix_spawn_file_actions_addopen(&m_actions, STDOUT_FILENO, out, O_WRONLY | O_CREAT | O_TRUNC, 0666);
            posix_spawn_file_actions_adddup2(&m_actions, fileno(error), STDERR_FILENO);
        }
        // This program blocks the signals that it waits for; the new one begins as a shell would begin it.
        sigset_t none;
        sigemptyset(&none);
        posix_spawnattr_setsigmask(&m_attributes, &none);
        posix_spawnattr_setflags(&m_attributes, POSIX_SPAWN_SETSIGMASK);
    }
    const posix_spawn_file_actions_t* actions() const { return &m_actions; }
    const posix_spawnattr_t* attributes() const { return &m_attributes; }

private:
    posix_spawn_file_actions_t m_actions{};
    posix_spawnattr_t m_attributes{};
};

pid_t start(const ChildRun& run, std::FILE* error) {
    Preparation preparation;
    preparation.prepare(run, error);
    std::vector<std::string> words{run.program.string()};
    words.insert(words.end(), run.words.begin(), run.words.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    pid_t child = -1;
    const int failure = posix_spawn(&child, run.program.c_str(), preparation.actions(), preparation.attributes(),
                                    pointers.data(), environ);
    if (failure != 0)
        throw Error("cannot start the program (" + std::generic_category().message(failure) + ")", run.program.string(),
                    "check its permissions" + (run.folder.empty() ? "" : " and the folder " + run.folder.string()));
    return child;
}

} // namespace

ChildEnd runChild(const ChildRun& run, const std::stop_token& stop) {
    const Scratch error(std::tmpfile());
    if (!error)
        throw Error(std::string("cannot make a temporary file (") + std::strerror(errno) + ")", "", "check the space");
    if (stop.stop_requested()) throw Cancelled{};
    const pid_t child = start(run, error.get());
    int status = 0;
    {
        // It is not yet waited for, so the number cannot be another's by now.
        const std::stop_callback stopIt(stop, [child, by = run.stopBy] { kill(child, by); });
        siginfo_t ended{};
        while (waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
        }
    }
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (stop.stop_requested()) throw Cancelled{};
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), readBack(error.get())};
}

} // namespace pellucid
