#include "movie.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_watch.h"
#include "base/text.h"
#include "command_line.h"
#include "output.h"
#include "parse.h"

extern char** environ; // NOLINT: POSIX

namespace pellucid::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* kProgram = "ffmpeg";

/// Empty where it is not installed.
std::string findProgram() {
    const char* const path = std::getenv("PATH");
    for (const std::string& folder : split(path != nullptr ? path : "", ':')) {
        const std::string file = (fs::path(folder.empty() ? "." : folder) / kProgram).string();
        if (access(file.c_str(), X_OK) == 0 && !fs::is_directory(file)) return file;
    }
    return {};
}

/// A new folder beside `path`, which goes with all that is in it when this does.
class Scratch {
public:
    explicit Scratch(const fs::path& path) {
        std::string name =
            ((path.has_parent_path() ? path.parent_path() : fs::path(".")) / ".pellucid-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw FileError("no folder can be created beside the file", path.string(), "check permissions and space");
        m_folder = name;
    }
    ~Scratch() {
        std::error_code none;
        fs::remove_all(m_folder, none);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    std::string file(const char* name) const { return (m_folder / name).string(); }

private:
    fs::path m_folder;
};

/// Runs it, its messages into `log`; the exit status, −1 where it was ended by a signal. Throws Cancelled.
int runProgram(const std::vector<std::string>& arguments, const std::string& log, const std::stop_token& stop) {
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none); // ours blocks what ends it
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    pid_t child = 0;
    const int failed = posix_spawn(&child, arguments.front().c_str(), &files, &attributes, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    if (failed != 0) throw Error("ffmpeg cannot be started", arguments.front(), "check its installation");
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (stop.stop_requested()) {
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            throw Cancelled{};
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace

void checkMovieSuffix(const std::string& path) {
    if (fs::path(path).extension() != ".mp4")
        throw UsageError("'" + path + "' does not end in .mp4", "--mp4", "give a name such as film.mp4");
}

void requireMovieWriter() {
    if (findProgram().empty())
        throw Error("ffmpeg is not installed", "--mp4",
                    "install it, or leave the option out: the pictures of all frames are written without it, too");
}

void writeMovie(const std::vector<std::string>& pictures, double framesPerSecond, const std::string& path,
                const std::stop_token& stop) {
    if (pictures.empty()) return;
    tellOfWriting(path);
    const Scratch scratch(path);
    const std::string pictureList = scratch.file("pictures.txt"), log = scratch.file("log.txt"),
                      film = scratch.file("film.mp4");
    std::string list = "ffconcat version 1.0\n";
    const std::string duration = "duration " + plainText(1 / framesPerSecond) + "\n";
    for (const std::string& picture : pictures)
        list += "file " + inSingleQuotes(fs::absolute(picture).string()) + "\n" + duration;
    writeTextAtomically(pictureList, list);
    std::vector<std::string> words{findProgram()};
    const auto add = [&](const std::string& options, const std::string& value) {
        for (std::string& word : splitWords(options)) words.push_back(std::move(word));
        words.push_back(value);
    };
    add("-nostdin -y -loglevel error -f concat -safe 0 -i", pictureList);
    add("-r", plainText(framesPerSecond));
    add("-vf pad=ceil(iw/2)*2:ceil(ih/2)*2 -c:v libx264 -crf 18 -pix_fmt yuv420p", film);
    const int status = runProgram(words, log, stop);
    std::error_code failed;
    if (status == 0 && fs::is_regular_file(film)) {
        fs::rename(film, path, failed);
        if (!failed) return;
    }
    std::string said = fs::exists(log) ? readText(log) : "";
    said = oneLine(said.substr(0, 300));
    throw Error("ffmpeg failed" + (said.empty() ? std::string() : ": " + said), path,
                "the pictures are there; make the film by hand, or check that ffmpeg has libx264");
}

} // namespace pellucid::cli
