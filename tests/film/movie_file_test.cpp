// Films played back: what ffmpeg decodes of them, picture by picture, beside what was drawn.
#include "film/movie_file.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <catch2/catch.hpp>
#include <sys/resource.h>

#include "base/atomic_file.h"
#include "base/child_program.h"
#include "film/film.h"
#include "image_io/image_file.h"
#include "render/ssim.h"
#include "support/film_scene.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;
namespace fs = std::filesystem;

namespace {

constexpr int kWidth = 160, kHeight = 120;

FilmTask turntable(const Scene& scene, const std::string& path, double seconds = 1, double fps = 12) {
    FilmTask task{scene};
    task.shots = shotsOf({FilmKind::Turntable, seconds, fps, 360}, {}, scene);
    task.width = kWidth;
    task.height = kHeight;
    task.framesPerSecond = fps;
    task.path = path;
    return task;
}

std::vector<Image> picturesOf(const FilmTask& task, const TempFolder& folder) {
    FilmTask drawn = task;
    drawn.path = folder.path("drawn");
    const int count = makeFilm(drawn).pictures;
    std::vector<Image> pictures;
    for (int n = 0; n < count; ++n) pictures.push_back(readImage(pictureFileOf(drawn.path, n)));
    fs::remove_all(drawn.path);
    return pictures;
}

/// All pictures of a film as a player shows them: none left out, none twice.
std::vector<Image> played(const std::string& film, const TempFolder& folder) {
    const fs::path into = folder.path("played");
    fs::create_directories(into);
    // -f apng: ffmpeg takes what ends in .png for one picture.
    std::vector<std::string> words{"-nostdin", "-loglevel", "error"};
    if (film.ends_with("png")) words.insert(words.end(), {"-f", "apng"});
    words.insert(words.end(), {"-i", film, "-fps_mode", "passthrough", "-sws_flags", "accurate_rnd+full_chroma_int",
                               "-pix_fmt", "rgb24", "p%04d.png"});
    const ChildEnd end = runChild({.program = "/usr/bin/ffmpeg", .words = words, .folder = into}, {});
    INFO(end.error);
    REQUIRE(end.status == 0);
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(into)) files.push_back(entry.path());
    std::ranges::sort(files);
    std::vector<Image> pictures;
    for (const fs::path& file : files) pictures.push_back(readImage(file.string()));
    fs::remove_all(into);
    return pictures;
}

double meanLuminance(const Image& image) {
    double sum = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        sum += 0.2126 * image.rgba[i] + 0.7152 * image.rgba[i + 1] + 0.0722 * image.rgba[i + 2];
    return sum / (image.width * image.height);
}

/// The mean of one channel over the picture.
double meanOf(const Image& image, std::size_t channel) {
    double sum = 0;
    for (std::size_t i = channel; i < image.rgba.size(); i += 4) sum += image.rgba[i];
    return sum / (image.width * image.height);
}

bool hasPlayer() { return hasMovieWriter() && fs::exists("/usr/bin/ffmpeg"); }

} // namespace

TEST_CASE("what a film is written as follows from its name", "[film]") {
    CHECK(filmFileOf("a.MP4") == FilmFile::Mp4);
    CHECK(filmFileOf("a.webm") == FilmFile::WebM);
    CHECK(filmFileOf("a.gif") == FilmFile::Gif);
    CHECK(filmFileOf("a.apng") == FilmFile::AnimatedPng);
    CHECK(filmFileOf("a.png") == FilmFile::AnimatedPng);
    CHECK(filmFileOf("folder") == FilmFile::Pictures);
    CHECK(filmFileOf("a.film/turn") == FilmFile::Pictures);
    CHECK((isMovie("a.mp4") && !isMovie("a.webm")));
}

TEST_CASE("without ffmpeg there are animated PNG files, and that is said", "[film]") {
    const TempFolder folder;
    const Scene scene = filmScene();
    const std::string before = std::getenv("PATH");
    setenv("PATH", "/nowhere", 1);
    for (const char* name : {"a.gif", "a.mp4", "a.webm"}) {
        try {
            makeFilm(turntable(scene, folder.path(name)));
            FAIL("it was written");
        } catch (const Error& e) {
            CHECK(e.whatToDo().find(".apng") != std::string::npos);
        }
    }
    CHECK(makeFilm(turntable(scene, folder.path("a.apng"))).pictures == 12);
    setenv("PATH", before.c_str(), 1);
    CHECK(folder.fileCount() == 1);
}

TEST_CASE("a film whose last bytes cannot be written is told, and absent", "[film]") {
    if (!hasPlayer()) {
        WARN("skipped: no ffmpeg");
        return;
    }
    const TempFolder folder;
    const Scene scene = filmScene("sample:shells", 24);
    FilmTask task = turntable(scene, folder.path("pictures"), 0.5);
    makeFilm(task);
    std::vector<std::string> pictures;
    for (int n = 0; n < 6; ++n) pictures.push_back(pictureFileOf(task.path, n));
    const auto before = std::signal(SIGXFSZ, SIG_IGN); // as the programs do
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    for (const char* name : {"film.mp4", "film.webm", "film.gif"}) {
        INFO(name);
        const std::string path = folder.path(name);
        writeMovie(pictures, 12, path, {});
        const std::uintmax_t size = fs::file_size(path);
        fs::remove(path);
        for (const std::uintmax_t missing : {std::uintmax_t{1}, size / 3}) {
            const rlimit less{static_cast<rlim_t>(size - missing), limit.rlim_max};
            setrlimit(RLIMIT_FSIZE, &less);
            std::string told;
            try {
                writeMovie(pictures, 12, path, {});
            } catch (const Error& e) {
                told = e.what();
            }
            setrlimit(RLIMIT_FSIZE, &limit);
            CHECK(told.find(name) != std::string::npos);
            CHECK_FALSE(fs::exists(path));
        }
    }
    std::signal(SIGXFSZ, before);
    CHECK(folder.fileCount() == 1); // the pictures
}

TEST_CASE("films play back as they were drawn", "[film]") {
    if (!hasPlayer()) {
        WARN("skipped: no ffmpeg");
        return;
    }
    const TempFolder folder;
    const Scene scene = filmScene("sample:shells", 24);
    FilmTask keyed = turntable(scene, {});
    keyed.keys = twoKeys(scene, 1);
    keyed.shots = shotsOf(keyed.keys, 12, scene.volume->geometry());
    const struct {
        FilmTask task;
        std::size_t pictures;
    } films[] = {{turntable(scene, {}), 12}, {keyed, 13}};
    for (const auto& [plan, count] : films) {
        const std::vector<Image> drawn = picturesOf(plan, folder);
        REQUIRE(drawn.size() == count);
        for (const char* name : {"film.mp4", "film.webm", "film.gif", "film.apng"}) {
            FilmTask task = plan;
            task.path = folder.path(name);
            makeFilm(task);
            const std::vector<Image> seen = played(task.path, folder);
            INFO(name);
            REQUIRE(seen.size() == count);
            double least = 1, flicker = 0, tint = 0;
            for (std::size_t n = 0; n < count; ++n) {
                least = std::min(least, ssim(seen[n], drawn[n]));
                for (std::size_t channel = 0; channel < 3; ++channel)
                    tint = std::max(tint, std::abs(meanOf(seen[n], channel) - meanOf(drawn[n], channel)));
                if (n == 0) continue;
                const double seenStep = meanLuminance(seen[n]) - meanLuminance(seen[n - 1]);
                const double drawnStep = meanLuminance(drawn[n]) - meanLuminance(drawn[n - 1]);
                flicker = std::max(flicker, std::abs(seenStep - drawnStep));
            }
            CAPTURE(least, flicker, tint);
            CHECK(least >= 0.98);
            CHECK(flicker < 2.0 / 255); // brightness goes from picture to picture as it was drawn
            CHECK(tint < 3.0 / 255);    // and colours are not those of another matrix or range
            if (task.path.ends_with(".apng"))
                for (std::size_t n = 0; n < count; ++n) CHECK(seen[n].rgba == drawn[n].rgba); // lossless
        }
    }
}

TEST_CASE("at any rate each picture is shown once", "[film]") {
    if (!hasPlayer()) {
        WARN("skipped: no ffmpeg");
        return;
    }
    const TempFolder folder;
    const Scene scene = filmScene();
    for (const double fps : {30.0, 23.976, 7.5}) { // none of them a multiple of 1/25 s
        const FilmTask task = turntable(scene, folder.path("film.mp4"), 20 / fps, fps);
        makeFilm(task);
        CHECK(played(task.path, folder).size() == 20);
    }
}

TEST_CASE("the same film has the same bytes", "[film]") {
    const TempFolder folder;
    const Scene scene = filmScene();
    for (const char* suffix : {".apng", ".mp4", ".webm", ".gif"}) {
        const std::string first = folder.path(std::string("first") + suffix),
                          second = folder.path(std::string("second") + suffix);
        if (needsMovieWriter(filmFileOf(first)) && !hasMovieWriter()) continue;
        makeFilm(turntable(scene, first));
        makeFilm(turntable(scene, second));
        INFO(suffix);
        CHECK(readText(first) == readText(second));
    }
}
