#include "film/film.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stop_token>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "base/atomic_file.h"
#include "image_io/image_file.h"
#include "render/camera_motion.h"
#include "support/film_scene.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

FilmSettings planOf(FilmKind kind, double seconds, double fps, double degrees = 360) {
    return {kind, seconds, fps, degrees};
}

Vec3 off(const Camera& camera) { return camera.eye - camera.center; }

} // namespace

TEST_CASE("a turntable goes around the upright axis, and could be repeated", "[film]") {
    const Scene scene = sampleScene();
    const auto shots = shotsOf(planOf(FilmKind::Turntable, 2, 4), {}, scene);
    REQUIRE(shots.size() == 8);
    CHECK(glm::length(shots[0].camera.eye - scene.camera.eye) < 1e-9);
    for (std::size_t n = 0; n < shots.size(); ++n) {
        // Always as far off and as high, and 45° on in the ground plane.
        const Vec3 way = off(shots[n].camera), next = off(shots[(n + 1) % 8].camera);
        CHECK(glm::length(way) == Approx(glm::length(off(scene.camera))));
        CHECK(way.z == Approx(off(scene.camera).z));
        const double angle = std::atan2(way.x * next.y - way.y * next.x, way.x * next.x + way.y * next.y);
        CHECK(angle * 180 / M_PI == Approx(45));
        CHECK(shots[n].frame == scene.session.frame);
    }
    // The other way around, a quarter in all.
    const auto back = shotsOf(planOf(FilmKind::Turntable, 1, 2, -90), {}, scene);
    REQUIRE(back.size() == 2);
    const Vec3 first = off(back[0].camera), second = off(back[1].camera);
    CHECK(std::atan2(first.x * second.y - first.y * second.x, first.x * second.x + first.y * second.y) ==
          Approx(-M_PI / 4));
}

TEST_CASE("between two cameras the eye goes around the center, and rests at both", "[film]") {
    const Geometry g = sampleScene().volume->geometry();
    const Camera a = cameraFromView(g, 0, 0, 1, Projection::Perspective),
                 b = cameraFromView(g, 90, 0, 2, Projection::Perspective);
    CHECK(glm::length(cameraBetween(a, b, 0).eye - a.eye) < 1e-9 * glm::length(a.eye));
    CHECK(glm::length(cameraBetween(a, b, 1).eye - b.eye) < 1e-6 * glm::length(b.eye));
    const Camera middle = cameraBetween(a, b, 0.5);
    CHECK(viewAngles(middle, g).azimuth == Approx(45));
    CHECK(viewAngles(middle, g).elevation == Approx(0).margin(1e-9));
    CHECK(glm::length(off(middle)) == Approx(std::sqrt(glm::length(off(a)) * glm::length(off(b)))));
    // 3t² − 2t³: at t 0.1 it has gone 2.8 % of the way.
    CHECK(viewAngles(cameraBetween(a, b, 0.1), g).azimuth == Approx(90 * 0.028));
}

TEST_CASE("views are read from a text, and a film stops at each of them", "[film]") {
    const Scene scene = sampleScene();
    const auto views = viewsOfText(" present ;0,0; right; 90,0,2 ;", scene);
    REQUIRE(views.size() == 4);
    CHECK(views[0] == scene.camera);
    CHECK(viewAngles(views[3], scene.volume->geometry()).zoom == Approx(2));
    CHECK_THROWS_AS(viewsOfText("front", scene), UsageError);
    CHECK_THROWS_AS(viewsOfText("front; nowhere", scene), UsageError);
    CHECK_THROWS_AS(viewsOfText("front; anterior", scene), UsageError); // no patient
    const auto shots = shotsOf(planOf(FilmKind::Views, 7, 1), views, scene);
    REQUIRE(shots.size() == 7); // views at 0, 2, 4, 6
    for (std::size_t n = 0; n < views.size(); ++n)
        CHECK(glm::length(shots[2 * n].camera.eye - views[n].eye) < 1e-6 * glm::length(views[n].eye));
}

TEST_CASE("a series has a picture for each frame, and is needed for that", "[film]") {
    const Scene series = sampleScene("sample:vortex");
    const auto shots = shotsOf(planOf(FilmKind::Series, 1, 1), {}, series);
    REQUIRE(static_cast<int>(shots.size()) == series.series->size());
    CHECK(shots.back().frame == series.series->size() - 1);
    CHECK_THROWS_AS(shotsOf(planOf(FilmKind::Series, 1, 1), {}, sampleScene()), UsageError);
    CHECK_THROWS_AS(shotsOf(planOf(FilmKind::Turntable, 3600, 120), {}, sampleScene()), UsageError);
}

TEST_CASE("pictures of a film lie in a folder, each as it would be drawn alone", "[film]") {
    const TempFolder folder;
    FilmTask task{sampleScene()};
    task.scene.session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    task.shots = shotsOf(planOf(FilmKind::Turntable, 1, 4), {}, task.scene);
    task.width = 48;
    task.height = 32;
    task.path = folder.path("turn");
    double last = 0;
    const JobControl job{{}, [&](double fraction) {
                             CHECK(fraction >= last);
                             last = fraction;
                         }};
    const FilmResult film = makeFilm(task, job);
    CHECK(film.pictures == 4);
    CHECK(last == 1);
    for (int n = 0; n < 4; ++n) {
        const Image image = readImage(pictureFileOf(task.path, n));
        CHECK(image.width == 48);
        CHECK(image.height == 32);
    }
    // A quarter on, the picture is another one.
    CHECK_FALSE(readImage(pictureFileOf(task.path, 0)).rgba == readImage(pictureFileOf(task.path, 1)).rgba);
}

TEST_CASE("a film is one file, whole or absent", "[film]") {
    const TempFolder folder, programs;
    FilmTask task{sampleScene()};
    task.shots = shotsOf(planOf(FilmKind::Turntable, 1, 5), {}, task.scene);
    task.width = 33;
    task.height = 21;
    task.framesPerSecond = 5;
    task.path = folder.path("turn.mp4");
    const std::string before = std::getenv("PATH");
    const auto withPath = [&](const std::string& path, const std::function<void()>& does) {
        setenv("PATH", path.c_str(), 1);
        does();
        setenv("PATH", before.c_str(), 1);
    };
    withPath("/nowhere", [&] { CHECK_THROWS_AS(makeFilm(task), Error); });
    // In the place of ffmpeg a program whose film is the list of what lies around it, five lines of 11 bytes and one of
    // 9, as one box of MP4 with a head of 8: 72 bytes, 110 in octal.
    const std::string program = programs.write(
        "ffmpeg",
        "#!/bin/sh\nwhile [ $# -gt 1 ]; do shift; done\n{ printf '\\000\\000\\000\\110free'; ls; } > \"$1\"\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    withPath(programs.path("") + ":/usr/bin:/bin", [&] {
        std::stop_source stopped;
        stopped.request_stop();
        CHECK_THROWS_AS(makeFilm(task, {stopped.get_token(), {}}), Cancelled);
        CHECK(folder.fileCount() == 0);
        CHECK(makeFilm(task).pictures == 5);
    });
    CHECK(folder.fileCount() == 1); // nothing else stays behind
    CHECK(readText(task.path).substr(8) == "000000.png\n000001.png\n000002.png\n000003.png\n000004.png\nfilm.mp4\n");
}

TEST_CASE("a name that ends as a film which is not written is no folder, either", "[film]") {
    const TempFolder folder;
    FilmTask task{filmScene()};
    task.shots = shotsOf(planOf(FilmKind::Turntable, 1, 1), {}, task.scene);
    task.width = task.height = 8;
    for (const char* name :
         {"a.avi", "a.mov", "a.mkv", "a.wmv", "a.m4v", "a.ogv", "a.flv", "a.mpg", "a.mpeg", "a.MOV"}) {
        INFO(name);
        task.path = folder.path(name);
        CHECK_THROWS_AS(checkFilm(task), UsageError);
        CHECK_THROWS_AS(makeFilm(task), UsageError);
        CHECK_FALSE(std::filesystem::exists(task.path));
    }
    // Dots alone say nothing; and who means a folder can say so.
    for (const char* name : {"turn.v2", "knee.2024-05-01", "a.avi/"}) {
        INFO(name);
        task.path = folder.path(name);
        CHECK_NOTHROW(makeFilm(task));
        CHECK(std::filesystem::exists(pictureFileOf(task.path, 0)));
    }
}

TEST_CASE("keyframes are pictures from the first key to the last", "[film]") {
    const Scene scene = filmScene();
    const Geometry& g = scene.volume->geometry();
    const auto shots = shotsOf(twoKeys(scene, 2), 5, g);
    REQUIRE(shots.size() == 11); // at 0, 0.2 … 2 s
    CHECK(*shots.back().time == Approx(2));
    CHECK(shots.back().camera == twoKeys(scene, 2)[1].state.camera);
    CHECK_THROWS_AS(shotsOf(Keyframes{}, 5, g), UsageError);
    CHECK_THROWS_AS(shotsOf(twoKeys(scene, 3600), 120, g), UsageError); // 432 001 pictures
}
