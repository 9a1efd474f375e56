#include "film/movie_file.h"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <unistd.h>

#include "base/atomic_file.h"
#include "base/child_program.h"
#include "base/error.h"
#include "base/file_watch.h"
#include "base/round_numbers.h"
#include "base/text.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

constexpr const char* kProgram = "ffmpeg";

/// Empty where it is not installed.
std::string findProgram() {
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::string file = (fs::path(folder.empty() ? "." : folder) / kProgram).string();
        if (access(file.c_str(), X_OK) == 0 && !fs::is_directory(file)) return file;
    }
    return {};
}

/// In single quotes, as ffmpeg reads them.
std::string quoted(const std::string& text) {
    std::string all = "'";
    for (const char c : text) all += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return all + "'";
}

} // namespace

ScratchFolder::ScratchFolder(const std::string& path) {
    const fs::path parent = fs::path(path).parent_path();
    std::string name = ((parent.empty() ? fs::path(".") : parent) / ".pellucid-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
        throw FileError("no folder can be created beside the file", path, "check permissions and space");
    m_folder = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code none;
    fs::remove_all(m_folder, none);
}

bool isMovie(const std::string& path) { return lowerCase(fs::path(path).extension().string()) == ".mp4"; }

bool hasMovieWriter() { return !findProgram().empty(); }

void writeMovie(const std::vector<std::string>& pictures, double framesPerSecond, const std::string& path,
                const std::stop_token& stop) {
    if (pictures.empty()) return;
    tellOfWriting(path);
    const ScratchFolder scratch(path);
    const std::string pictureList = scratch.file("pictures.txt"), film = scratch.file("film.mp4");
    std::string list = "ffconcat version 1.0\n";
    const std::string duration = "duration " + plainText(1 / framesPerSecond) + "\n";
    for (const std::string& picture : pictures)
        list += "file " + quoted(fs::absolute(picture).string()) + "\n" + duration;
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
    const std::string said = joined(splitWords(end.error.substr(0, 300)), " "); // on one line
    throw Error("ffmpeg failed" + (said.empty() ? std::string() : ": " + said), path,
                "check that ffmpeg has libx264; pictures alone need no ffmpeg");
}

} // namespace pellucid
