#include "volume/process/reader_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/stopwatch.h"

extern char** environ;

namespace pellucid {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Without a word for so long it is ended: it tells of every file that it has read.
constexpr double kMostSilentSeconds = 120;
constexpr std::size_t kMostLine = 64u << 20;
/// What the voxels are called in the reader: the number of its file.
constexpr int kVoxelsThere = 3;

fs::path& chosenProgram() {
    static fs::path program;
    return program;
}

fs::path readerProgram(const std::string& name) {
    if (!chosenProgram().empty()) return chosenProgram();
    std::error_code ec;
    const fs::path folder = fs::read_symlink("/proc/self/exe", ec).parent_path();
    const fs::path beside = folder / name;
    return fs::exists(beside, ec) ? beside : folder / PELLUCID_LIBRARIES_FROM_PROGRAMS / name;
}

/// The number of an open file.
class OpenFile {
public:
    OpenFile() = default;
    explicit OpenFile(int number) : m_number(number) {}
    ~OpenFile() {
        if (m_number >= 0) ::close(m_number);
    }
    OpenFile(OpenFile&& other) noexcept : m_number(std::exchange(other.m_number, -1)) {}
    OpenFile& operator=(OpenFile&& other) noexcept {
        std::swap(m_number, other.m_number);
        return *this;
    }
    int number() const { return m_number; }

private:
    int m_number = -1;
};

[[noreturn]] void failToStart(const fs::path& program, const std::string& why) {
    throw FileError("the program that reads this format cannot be started (" + why + ")", program.string(),
                    "close other programs, or install Pellucid again");
}

/// Two ends of a pipe, closed in programs that are started meanwhile.
struct Pipe {
    OpenFile out, in; ///< to be read from, to be written to
    explicit Pipe(const fs::path& program) {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) failToStart(program, std::generic_category().message(errno));
        out = OpenFile(ends[0]);
        in = OpenFile(ends[1]);
    }
};

/// One pellucid-reader at work. It ends with this.
class Reader {
public:
    Reader(const ReaderRequest& request, const JobControl& job)
        : m_program(readerProgram(request.program)), m_path(request.path), m_job(job) {
        m_voxels = OpenFile(::memfd_create("pellucid voxels", MFD_CLOEXEC | MFD_ALLOW_SEALING));
        if (m_voxels.number() < 0) failToStart(m_program, std::generic_category().message(errno));
        Pipe to(m_program), from(m_program);
        start(to.out.number(), from.in.number());
        m_to = std::move(to.in);
        m_from = std::move(from.out);
    }
    ~Reader() {
        if (m_process > 0) end();
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    void say(const std::string& line) {
        const std::string text = line + "\n";
        for (std::size_t done = 0; done < text.size();) {
            // It may be gone: then the answer tells, and no signal ends this program.
            const ssize_t count = writeQuietly(text.data() + done, text.size() - done);
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) return;
            done += static_cast<std::size_t>(count);
        }
    }

    /// The next message that is no progress. Throws what the reader says is wrong, and Cancelled.
    json hear() {
        for (;;) {
            const std::string line = nextLine();
            json message = json::parse(line, nullptr, false);
            if (!message.is_object()) failSuddenly("it does not say anything that can be understood");
            if (message.contains("error")) throwErrorIn(message);
            if (!message.contains("progress")) return message;
            if (message["progress"].is_number()) m_job.report(std::clamp(message["progress"].get<double>(), 0.0, 1.0));
        }
    }

    /// Room for the voxels, which the reader is told of.
    void makeRoom(std::uint64_t bytes) {
        if (::ftruncate(m_voxels.number(), static_cast<off_t>(bytes)) != 0)
            throw FileError("there is no memory for the voxels (" + std::generic_category().message(errno) + ")",
                            m_path, "close other programs", Remedy::AllowMoreMemory);
        say("{}");
    }

    /// The voxels, as a file that is there as long as this is. Nobody can change them any more.
    std::string voxels() {
        end();
        ::fcntl(m_voxels.number(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE);
        return "/proc/self/fd/" + std::to_string(m_voxels.number());
    }

private:
    void start(int in, int out) {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0); // libraries talk
        posix_spawn_file_actions_adddup2(&actions, m_voxels.number(), kVoxelsThere);
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        sigset_t none;
        sigemptyset(&none);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
        const std::string program = m_program.string();
        std::string name = m_program.filename().string();
        char* const words[] = {name.data(), nullptr};
        const int failure = posix_spawn(&m_process, program.c_str(), &actions, &attributes, words, environ);
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
        if (failure == 0) return;
        m_process = -1;
        failToStart(m_program, std::generic_category().message(failure));
    }

    void end() {
        ::kill(m_process, SIGKILL);
        waitForEnd();
    }
    /// How it ended.
    int waitForEnd() {
        int status = 0;
        while (::waitpid(m_process, &status, 0) < 0 && errno == EINTR) {
        }
        m_process = -1;
        return status;
    }

    ssize_t writeQuietly(const char* text, std::size_t bytes) {
        sigset_t pipe, before;
        sigemptyset(&pipe);
        sigaddset(&pipe, SIGPIPE);
        pthread_sigmask(SIG_BLOCK, &pipe, &before);
        const ssize_t count = ::write(m_to.number(), text, bytes);
        const int problem = errno;
        if (count < 0 && problem == EPIPE && sigismember(&before, SIGPIPE) == 0) {
            const timespec now{0, 0};
            ::sigtimedwait(&pipe, nullptr, &now);
        }
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
        errno = problem;
        return count;
    }

    /// Throws where the reader has ended, or is ended because it says nothing.
    std::string nextLine() {
        const Stopwatch silence;
        for (;;) {
            if (const std::size_t end = m_heard.find('\n'); end != std::string::npos) {
                std::string line = m_heard.substr(0, end);
                m_heard.erase(0, end + 1);
                return line;
            }
            if (m_heard.size() > kMostLine) failSuddenly("it says too much");
            if (silence.seconds() > kMostSilentSeconds) failSuddenly("it takes too long");
            m_job.throwIfStopped();
            pollfd waiting{m_from.number(), POLLIN, 0};
            if (::poll(&waiting, 1, 50) <= 0) continue;
            std::array<char, 65536> buffer{};
            const ssize_t count = ::read(m_from.number(), buffer.data(), buffer.size());
            if (count > 0) m_heard.append(buffer.data(), static_cast<std::size_t>(count));
            if (count == 0) failAtItsEnd();
        }
    }

    [[noreturn]] void failSuddenly(const std::string& why) const {
        throw FileError("the program that reads this format was ended: " + why, m_path,
                        "the file is damaged, or not what it says it is: copy it again");
    }
    [[noreturn]] void failAtItsEnd() {
        const int status = waitForEnd(); // it has closed its end, and is about to be gone
        if (WIFEXITED(status) && WEXITSTATUS(status) == 127) failToStart(m_program, "a library is missing");
        if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) failSuddenly("the file takes too long to read");
        throw FileError("the program that reads this format crashed on it" +
                            (WIFSIGNALED(status) ? " (signal " + std::to_string(WTERMSIG(status)) + ")"
                                                 : " (status " + std::to_string(WEXITSTATUS(status)) + ")"),
                        m_path, "the file is damaged: copy it again, or convert it with another program");
    }

    const fs::path m_program;
    const std::string m_path;
    const JobControl& m_job;
    OpenFile m_voxels, m_to, m_from;
    pid_t m_process = -1;
    std::string m_heard;
};

ReaderRequest withTask(ReaderRequest request, ReaderRequest::Task task) {
    request.task = task;
    return request;
}

} // namespace

void setReaderProgram(const fs::path& program) { chosenProgram() = program; }

FileContents describeInProcess(const ReaderRequest& request, const JobControl& job) {
    Reader reader(request, job);
    reader.say(jsonOf(withTask(request, ReaderRequest::Task::Describe)).dump());
    return contentsIn(reader.hear());
}

std::vector<std::string> listInProcess(const ReaderRequest& request, const JobControl& job) {
    Reader reader(request, job);
    reader.say(jsonOf(withTask(request, ReaderRequest::Task::List)).dump());
    return filesIn(reader.hear());
}

Volume readInProcess(const VolumeSource& source, const ReaderRequest& request, const JobControl& job) {
    const JobControl reading = job.part(0, 2), taking = job.part(1, 2);
    Reader reader(request, reading);
    reader.say(jsonOf(withTask(request, ReaderRequest::Task::Read)).dump());
    ReaderLayout answer = layoutIn(reader.hear());
    const std::uint64_t bytes = bytesOf(answer.layout, source.path);
    requireMemory("opening it", source.path, bytes);
    reader.makeRoom(bytes);
    reader.hear();
    answer.layout.dataPath = reader.voxels();
    VolumeSource taken = source;
    taken.step = 0; // the one that was read
    if (!taken.array.empty()) taken.array = answer.layout.array;
    if (!taken.missing) taken.missing = answer.missing;
    return readSamples(taken, answer.layout, taking);
}

} // namespace pellucid
