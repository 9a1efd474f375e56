#include "film/movie_file.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include <unistd.h>

#include "base/atomic_file.h"
#include "base/child_program.h"
#include "base/error.h"
#include "base/file_watch.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "image_io/animated_png.h"

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

/// The pictures under names that count, which ffmpeg reads as a sequence.
void linkPictures(const std::vector<std::string>& pictures, const ScratchFolder& scratch) {
    int number = 0;
    for (const std::string& picture : pictures) {
        std::array<char, 32> name{};
        std::snprintf(name.data(), name.size(), "%06d.png", number++);
        const fs::path link = scratch.file(name.data()), file = fs::absolute(picture);
        std::error_code failed;
        fs::create_symlink(file, link, failed);
        if (failed) fs::copy_file(file, link, failed); // where there are no links
        if (failed) throw FileError("it cannot be read: " + failed.message(), picture, "check permissions and space");
    }
}

class FfmpegWords {
public:
    FfmpegWords& add(const char* options) {
        for (std::string& word : splitWords(options)) words.push_back(std::move(word));
        return *this;
    }
    FfmpegWords& add(const char* options, const std::string& value) {
        add(options);
        words.push_back(value);
        return *this;
    }
    std::vector<std::string> words;
};

FfmpegWords reading(double framesPerSecond) {
    FfmpegWords words;
    // As many threads everywhere: their number changes what some encoders write.
    words.add("-nostdin -y -loglevel error -framerate", plainText(framesPerSecond)).add("-i %06d.png");
    return words;
}

/// From sRGB to what nearly all players take films for.
void addVideoColors(FfmpegWords& words) {
    words
        .add("-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,"
                    "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int,format=yuv420p")
        .add("-colorspace bt709 -color_primaries bt709 -color_trc bt709 -color_range tv");
}

/// What ffmpeg is asked for, one call after the other; the last one writes `film`.
std::vector<FfmpegWords> callsFor(FilmFile file, double framesPerSecond, const std::string& film) {
    std::vector<FfmpegWords> calls;
    FfmpegWords words = reading(framesPerSecond);
    if (file == FilmFile::Gif) {
        calls.push_back(words);
        calls.back().add("-vf palettegen=stats_mode=full -frames:v 1 -fflags +bitexact palette.bmp");
        // Dots of a fixed pattern: others would swarm from picture to picture.
        words.add("-i palette.bmp -lavfi [0:v][1:v]paletteuse=dither=bayer:bayer_scale=5 -loop 0");
    } else {
        addVideoColors(words);
        words.add(file == FilmFile::WebM
                      ? "-c:v libvpx-vp9 -crf 20 -b:v 0 -deadline good -cpu-used 2 -tile-columns 1 -threads 4"
                      : "-c:v libx264 -crf 16 -threads 4 -movflags +faststart");
        words.add("-flags:v +bitexact");
    }
    words.add("-fflags +bitexact", film);
    calls.push_back(std::move(words));
    return calls;
}

/// The next `count` bytes as a number, the first one the highest.
std::uint64_t nextNumber(std::istream& in, int count) {
    std::uint64_t number = 0;
    for (int i = 0; i < count; ++i) number = number << 8 | static_cast<unsigned char>(in.get());
    return number;
}

/// The number of an element of WebM, or how long one is: the zeros before its first bit that is set say in how many
/// bytes it stands.
std::uint64_t nextOfWebM(std::istream& in, bool isLength) {
    const int first = in.get();
    int bytes = 1;
    while (bytes < 8 && (first & 0x80 >> (bytes - 1)) == 0) ++bytes;
    const auto start = static_cast<std::uint64_t>(isLength ? first & (0x7f >> (bytes - 1)) : first);
    return start << 8 * (bytes - 1) | nextNumber(in, bytes - 1);
}

/// ffmpeg does not tell where the last bytes of a film could not be written. Whether they are there, by the lengths
/// that the parts of the file give of themselves, or by what ends a GIF.
bool isWhole(FilmFile file, const std::string& path) {
    std::ifstream in(path, std::ios::binary | std::ios::ate);
    const auto end = static_cast<std::uint64_t>(in.tellg());
    if (file == FilmFile::Gif) {
        in.seekg(-2, std::ios::end);
        return nextNumber(in, 2) == ';'; // after the 0 that ends a picture
    }
    std::uint64_t at = 0;
    while (in && at < end) {
        in.seekg(static_cast<std::streamoff>(at));
        if (file == FilmFile::WebM) {
            nextOfWebM(in, false);
            const std::uint64_t length = nextOfWebM(in, true);
            at = static_cast<std::uint64_t>(in.tellg()) + length;
        } else {
            std::uint64_t length = nextNumber(in, 4);
            const std::uint64_t kind = nextNumber(in, 4);
            if (length == 1) length = nextNumber(in, 8);
            if (kind == 0 || length < 8) return false;
            at += length;
        }
    }
    return in && end > 0 && at == end;
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

FilmFile filmFileOf(const std::string& path) {
    const std::string suffix = lowerCase(fs::path(path).extension().string());
    if (suffix == ".mp4") return FilmFile::Mp4;
    if (suffix == ".webm") return FilmFile::WebM;
    if (suffix == ".gif") return FilmFile::Gif;
    return suffix == ".apng" || suffix == ".png" ? FilmFile::AnimatedPng : FilmFile::Pictures;
}

void checkFilmSuffix(const std::string& path) {
    static constexpr std::array<std::string_view, 17> kOthers{".avi", ".mov", ".qt",   ".mkv",  ".wmv", ".asf",
                                                              ".m4v", ".ogv", ".flv",  ".f4v",  ".mpg", ".mpe",
                                                              ".mpv", ".m2v", ".mpeg", ".m2ts", ".3gp"};
    const std::string suffix = lowerCase(fs::path(path).extension().string());
    if (std::ranges::find(kOthers, suffix) != kOthers.end())
        throw UsageError("films are not written as " + suffix, path,
                         "give a name that ends in .mp4, .webm, .gif or .apng, or one without a suffix for a folder of "
                         "pictures");
}

bool needsMovieWriter(FilmFile file) {
    return file == FilmFile::Mp4 || file == FilmFile::WebM || file == FilmFile::Gif;
}

bool isMovie(const std::string& path) { return filmFileOf(path) == FilmFile::Mp4; }

bool hasMovieWriter() { return !findProgram().empty(); }

void writeMovie(const std::vector<std::string>& pictures, double framesPerSecond, const std::string& path,
                const std::stop_token& stop) {
    if (pictures.empty()) return;
    const FilmFile file = filmFileOf(path);
    if (file == FilmFile::AnimatedPng) return writeAnimatedPng(pictures, framesPerSecond, path, stop);
    tellOfWriting(path);
    const ScratchFolder scratch(path);
    linkPictures(pictures, scratch);
    const std::string name = "film" + lowerCase(fs::path(path).extension().string());
    std::string said;
    bool finished = true;
    for (const FfmpegWords& call : callsFor(file, framesPerSecond, name)) {
        // Killed where it is stopped: what it has made by then is of no use.
        const ChildEnd end = runChild(
            {.program = findProgram(), .words = call.words, .folder = scratch.path(), .stopBy = SIGKILL}, stop);
        said = joined(splitWords(end.error.substr(0, 300)), " "); // on one line
        finished = end.status == 0;
        if (!finished) break;
    }
    std::error_code failed;
    const std::string film = scratch.file(name.c_str());
    if (finished && fs::is_regular_file(film)) {
        if (!isWhole(file, film))
            throw FileError("ffmpeg could not write all of the film", path,
                            "make room, or raise the limit on file sizes");
        fs::rename(film, path, failed);
        if (!failed) return;
    }
    throw Error("ffmpeg failed" + (said.empty() ? std::string() : ": " + said), path,
                "check that ffmpeg has libx264 or libvpx-vp9; a name that ends in .apng, and pictures alone, need no "
                "ffmpeg");
}

} // namespace pellucid
