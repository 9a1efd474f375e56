// Films that are stopped and go on: nothing is drawn twice, and the result has the bytes of one that never stopped.
#include <filesystem>
#include <stop_token>

#include <catch2/catch.hpp>

#include "base/atomic_file.h"
#include "film/film_progress.h"
#include "film/movie_file.h"
#include "image_io/animated_png.h"
#include "support/film_scene.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;
namespace fs = std::filesystem;

namespace {

FilmTask taskOf(const Scene& scene, const std::string& path) {
    FilmTask task{scene};
    task.keys = twoKeys(scene, 1);
    task.shots = shotsOf(task.keys, 8, scene.volume->geometry()); // nine pictures
    task.width = 40;
    task.height = 30;
    task.framesPerSecond = 8;
    task.path = path;
    return task;
}

/// Stops after so many pictures.
void drawUntil(const FilmTask& task, int pictures) {
    std::stop_source stop;
    int drawn = 0;
    const JobControl job{stop.get_token(), [&](double) {
                             if (++drawn == pictures) stop.request_stop();
                         }};
    CHECK_THROWS_AS(makeFilm(task, job), Cancelled);
}

/// All files of a folder, or the one file, by their names.
std::map<std::string, std::string> bytesOf(const std::string& path) {
    std::map<std::string, std::string> all;
    if (fs::is_regular_file(path)) return {{"", readText(path)}};
    for (const auto& entry : fs::directory_iterator(path))
        all[entry.path().filename().string()] = readText(entry.path().string());
    return all;
}

} // namespace

TEST_CASE("a film that is resumed is the same as one that never stopped", "[film]") {
    const Scene scene = filmScene();
    for (const char* name : {"turn", "turn.apng", "turn.mp4", "turn.webm", "turn.gif"}) {
        INFO(name);
        if (needsMovieWriter(filmFileOf(name)) && !hasMovieWriter()) continue;
        const TempFolder whole, parts;
        makeFilm(taskOf(scene, whole.path(name)));
        FilmTask task = taskOf(scene, parts.path(name));
        drawUntil(task, 3);
        // Whole pictures, and no film.
        const std::string folder = picturesFolderOf(task.path);
        for (int n = 0; n < 3; ++n) CHECK(isWholePngFile(pictureFileOf(folder, n), 40, 30));
        CHECK_FALSE(fs::exists(pictureFileOf(folder, 3)));
        CHECK_FALSE(fs::is_regular_file(task.path));
        const auto unfinished = unfinishedFilm(task);
        REQUIRE(unfinished);
        CHECK(unfinished->pictures == 3);
        CHECK(unfinished->isThisOne);
        task.resume = true;
        drawUntil(task, 6);
        const FilmResult film = makeFilm(task);
        CHECK(film.pictures == 9);
        CHECK(film.kept == 6);
        CHECK(bytesOf(task.path) == bytesOf(whole.path(name)));
        CHECK(parts.fileCount() == 1); // what it was made with has gone
        CHECK_FALSE(unfinishedFilm(task));
    }
}

TEST_CASE("pictures that are not whole are drawn again", "[film]") {
    const Scene scene = filmScene();
    const TempFolder whole, parts;
    makeFilm(taskOf(scene, whole.path("turn")));
    FilmTask task = taskOf(scene, parts.path("turn"));
    drawUntil(task, 5);
    fs::resize_file(pictureFileOf(task.path, 1), fs::file_size(pictureFileOf(task.path, 1)) - 5);
    std::string damaged = readText(pictureFileOf(task.path, 2));
    damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
    writeTextAtomically(pictureFileOf(task.path, 2), damaged);
    fs::remove(pictureFileOf(task.path, 3));
    task.resume = true;
    CHECK(makeFilm(task).kept == 2); // the first and the last
    CHECK(bytesOf(task.path) == bytesOf(whole.path("turn")));
}

TEST_CASE("another film is not taken for the one that was begun", "[film]") {
    const Scene scene = filmScene();
    const TempFolder folder;
    FilmTask task = taskOf(scene, folder.path("turn.apng"));
    drawUntil(task, 4);
    const auto isRefused = [&](FilmTask other) {
        other.resume = true;
        const auto unfinished = unfinishedFilm(other);
        CHECK_THROWS_AS(makeFilm(other), Error);
        return unfinished && !unfinished->isThisOne;
    };
    FilmTask other = task;
    other.width = 41;
    CHECK(isRefused(other));
    other = task;
    other.keys[1].state.light.on = false;
    CHECK(isRefused(other));
    other = task;
    other.scene.session.display.edit([](DisplaySettings& d) { d.background = {1, 1, 1}; });
    CHECK(isRefused(other));
    other = task;
    other.shots.pop_back();
    CHECK(isRefused(other));
    // What changes no picture is no other film.
    other = task;
    other.scene.session.optimize.edit([](OptimizeOptions& o) { o.maxIterations = 3; });
    REQUIRE(unfinishedFilm(other));
    CHECK(unfinishedFilm(other)->isThisOne);
    // The window gives the features of a file identities, the command line none.
    for (Feature& feature : other.scene.tf.features) feature.id += 7;
    for (Keyframe& key : other.keys)
        for (Feature& feature : key.state.tf.features) feature.id += 7;
    REQUIRE(unfinishedFilm(other));
    CHECK(unfinishedFilm(other)->isThisOne);
    // Begun anew, nothing of the old one stays.
    task.width = 50;
    const FilmResult film = makeFilm(task);
    CHECK(film.kept == 0);
    CHECK(folder.fileCount() == 1);
}

TEST_CASE("pictures of an older film in the folder are not taken for those of a new one", "[film]") {
    const Scene scene = filmScene();
    const TempFolder folder, whole;
    FilmTask old = taskOf(scene, folder.path("turn"));
    old.scene.session.display.edit([](DisplaySettings& d) { d.background = {1, 0, 0}; });
    makeFilm(old);
    FilmTask task = taskOf(scene, folder.path("turn"));
    drawUntil(task, 2);
    task.resume = true;
    CHECK(makeFilm(task).kept == 2);
    makeFilm(taskOf(scene, whole.path("turn")));
    CHECK(bytesOf(task.path) == bytesOf(whole.path("turn")));
}

TEST_CASE("a damaged note of progress is none", "[film]") {
    const TempFolder folder;
    CHECK_FALSE(readFilmProgress(folder.path("")));
    writeFilmProgress("0123456789abcdef", folder.path(""));
    CHECK(readFilmProgress(folder.path("")) == "0123456789abcdef");
    for (const char* bad : {"", "{", "[]", R"({"format":"pellucid-film-progress","version":1,"digest":3})",
                            R"({"format":"other","version":1})"}) {
        writeTextAtomically(folder.path(kFilmProgressFile), bad);
        CHECK_FALSE(readFilmProgress(folder.path("")));
    }
}

TEST_CASE("folders of others are left alone", "[film]") {
    const Scene scene = filmScene();
    const TempFolder folder;
    fs::create_directories(folder.path("turn.apng.pictures"));
    writeTextAtomically(folder.path("turn.apng.pictures/mine.txt"), "mine");
    CHECK_THROWS_AS(makeFilm(taskOf(scene, folder.path("turn.apng"))), FileError);
    CHECK(readText(folder.path("turn.apng.pictures/mine.txt")) == "mine");
}
