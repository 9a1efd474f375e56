#include "movie.h"

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <unistd.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_watch.h"
#include "base/text.h"
#include "child_program.h"
#include "command_line.h"
#include "output.h"
#include "parse.h"

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
    const std::string pictureList = scratch.file("pictures.txt"), film = scratch.file("film.mp4");
    std::string list = "ffconcat version 1.0\n";
    const std::string duration = "duration " + plainText(1 / framesPerSecond) + "\n";
    for (const std::string& picture : pictures)
        list += "file " + inSingleQuotes(fs::absolute(picture).string()) + "\n" + duration;
    writeTextAtomically(pictureList, list);
    std::vector<std::string> words;
    const auto add = [&](const std::string& options, const std::string& value) {
        for (std::string& word : splitWords(options)) words.push_back(std::move(word));
        words.push_back(value);
    };
    add("-nostdin -y -loglevel error -f concat -safe 0 -i", pictureList);
    add("-r", plainText(framesPerSecond));
    add("-vf pad=ceil(iw/2)*2:ceil(ih/2)*2 -c:v libx264 -crf 18 -pix_fmt yuv420p", film);
    // Killed where it is stopped: what it has made by then is of no use.
    const ChildEnd end = runChild({.program = findProgram(), .words = words, .stopBy = SIGKILL}, stop);
    std::error_code failed;
    if (end.status == 0 && fs::is_regular_file(film)) {
        fs::rename(film, path, failed);
        if (!failed) return;
    }
    const std::string said = oneLine(end.error.substr(0, 300));
    throw Error("ffmpeg failed" + (said.empty() ? std::string() : ": " + said), path,
                "the pictures are there; make the film by hand, or check that ffmpeg has libx264");
}

} // namespace pellucid::cli
