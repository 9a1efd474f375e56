#include "child.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/stopwatch.h"

namespace pellucid::gpu_check {

namespace {

constexpr const char* kAnswer = "pellucid-gpu-check answers: ";
constexpr const char* kSkipped = "SKIPPED: ";

/// Reads until the other end is closed or the time is over; true where it was closed.
bool readAll(int from, double limitSeconds, std::string& text) {
    const Stopwatch watch;
    for (;;) {
        const double left = limitSeconds - watch.seconds();
        if (left <= 0) return false;
        pollfd waiting{from, POLLIN, 0};
        const int ready = poll(&waiting, 1, static_cast<int>(std::min(left, 3600.0) * 1000) + 1);
        if (ready < 0 && errno != EINTR) return false;
        if (ready <= 0) continue;
        std::array<char, 4096> buffer{};
        const ssize_t count = read(from, buffer.data(), buffer.size());
        if (count == 0) return true;
        if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

/// The rest of the last line that starts with `start`.
std::optional<std::string> lineAfter(const std::string& text, const std::string& start) {
    for (std::size_t at = text.rfind(start); at != std::string::npos; at = text.rfind(start, at - 1)) {
        if (at == 0 || text[at - 1] == '\n')
            return text.substr(at + start.size(), text.find('\n', at) - at - start.size());
    }
    return {};
}

[[noreturn]] void become(const std::vector<std::string>& arguments, int out) {
    // Whoever ends the parent (a time limit, a closed terminal) ends its part too.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(out, STDOUT_FILENO);
    close(out);
    std::vector<std::string> words{"pellucid-gpu-check"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execv("/proc/self/exe", argv.data());
    _exit(127);
}

std::string endOf(int status) {
    if (WIFSIGNALED(status))
        return "ended by signal " + std::to_string(WTERMSIG(status)) + " (" + strsignal(WTERMSIG(status)) + ")";
    return "ended with status " + std::to_string(WEXITSTATUS(status)) + " and no answer";
}

} // namespace

PartResult runPart(const std::vector<std::string>& arguments, double limitSeconds) {
    const Stopwatch watch;
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw Error("no pipe", std::strerror(errno), "close other programs");
    std::fflush(nullptr); // nothing that waits to be written may be written twice
    const pid_t child = fork();
    if (child < 0) throw Error("no process can be started", std::strerror(errno), "close other programs");
    if (child == 0) {
        close(ends[0]);
        become(arguments, ends[1]);
    }
    close(ends[1]);
    std::string text;
    const bool ended = readAll(ends[0], limitSeconds, text);
    close(ends[0]);
    if (!ended) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }

    PartResult result;
    if (const auto line = lineAfter(text, kAnswer)) {
        Json answer = Json::parse(*line, nullptr, false);
        if (!answer.is_discarded()) result.answer = std::move(answer);
    }
    result.skipped = lineAfter(text, kSkipped).value_or("");
    if (result.answer)
        result.problem = result.answer->value("problem", std::string());
    else
        result.problem =
            ended ? endOf(status)
                  : "took longer than " + std::to_string(static_cast<int>(limitSeconds)) + " s and was ended";
    result.seconds = watch.seconds();
    return result;
}

void answerPart(const Json& answer) {
    const std::string line = answer.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::printf("\n%s%s\n", kAnswer, line.c_str());
    std::fflush(stdout);
}

} // namespace pellucid::gpu_check
