// `thumbnail`: small pictures of volumes and sessions.
#include <cmath>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"
#include "session/scene.h"
#include "session/session_json.h"

using pellucid::test::Outcome;
using pellucid::test::Workshop;

namespace {

/// Pixels of a picture that differ from its first one.
int drawnPixels(const pellucid::Image& image) {
    int drawn = 0;
    for (std::size_t p = 0; p < image.rgba.size(); p += 4)
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(image.rgba[p + c] - image.rgba[c]) > 0.02f) {
                ++drawn;
                break;
            }
    return drawn;
}

} // namespace

TEST_CASE("a thumbnail shows a volume, made coarser, in a file of any name", "[cli][thumbnail]") {
    const Workshop w;
    REQUIRE(w.run({"generate", "shells", "--size", "200", "--out", "shells.nrrd"}).status == 0);
    const auto answer = w.json({"thumbnail", "shells.nrrd", "small", "--size", "128"});
    CHECK(answer["command"] == "thumbnail");
    CHECK(answer["size"] == nlohmann::json::array({128, 128}));
    CHECK(answer["downsample"] == 3);                                       // ⌈200 / 96⌉
    CHECK(answer["volume"]["dims"] == nlohmann::json::array({67, 67, 67})); // ⌈200 / 3⌉
    CHECK(w.read("small").substr(0, 4) == "\x89PNG");
    std::filesystem::rename(w.path("small"), w.path("small.png").string());
    const pellucid::Image image = pellucid::readImage(w.path("small.png").string());
    CHECK(image.width == 128);
    CHECK(image.height == 128);
    // The shells fill more than a fifth of the square, and not its corners.
    CHECK(drawnPixels(image) > 128 * 128 / 5);
    CHECK(drawnPixels(image) < 128 * 128);
}

TEST_CASE("small volumes keep all their voxels, and larger pictures more of them", "[cli][thumbnail]") {
    const Workshop w;
    REQUIRE(w.run({"generate", "shells", "--size", "192", "--out", "shells.nrrd"}).status == 0);
    CHECK(w.json({"thumbnail", "shells.nrrd", "a", "--size", "256"})["downsample"] == 2); // 192 / 96
    CHECK(w.json({"thumbnail", "shells.nrrd", "b", "--size", "512"})["downsample"] == 1); // 192 / 192
    CHECK(w.json({"thumbnail", "sample:shells", "c"})["downsample"] == 1);
}

TEST_CASE("a session's thumbnail has the session's colours", "[cli][thumbnail]") {
    const Workshop w;
    REQUIRE(w.run({"generate", "shells", "--size", "32", "--out", "shells.nrrd"}).status == 0);
    pellucid::VolumeSource source;
    source.path = w.path("shells.nrrd").string();
    pellucid::Session session = pellucid::sessionOf(source);
    pellucid::TransferFunction red = pellucid::tents(2);
    for (pellucid::ControlPoint& point : red.points) point.color = {1, 0, 0};
    session.setTf(red);
    pellucid::writeSession(session, w.path("red.pellucid.json").string());
    REQUIRE(w.run({"thumbnail", "red.pellucid.json", "red.png", "--size", "64"}).status == 0);
    const pellucid::Image image = pellucid::readImage(w.path("red.png").string());
    CHECK(drawnPixels(image) > 64 * 64 / 6);
    for (std::size_t p = 0; p < image.rgba.size(); p += 4) {
        REQUIRE(image.rgba[p + 1] == Approx(0).margin(0.01)); // nothing but red and black
        REQUIRE(image.rgba[p + 2] == Approx(0).margin(0.01));
    }
    w.write("broken.pellucid.json", "{}");
    CHECK(w.run({"thumbnail", "broken.pellucid.json", "none"}).status == 1);
    CHECK_FALSE(w.has("none"));
}

TEST_CASE("file managers may name a file by its address", "[cli][thumbnail]") {
    const Workshop w;
    REQUIRE(w.run({"generate", "shells", "--size", "32", "--out", "a b.nrrd"}).status == 0);
    CHECK(w.run({"thumbnail", "file://" + w.path("a%20b.nrrd").string(), "out"}).status == 0);
    CHECK(w.has("out"));
}

TEST_CASE("what is no volume has no thumbnail, and nothing is left", "[cli][thumbnail]") {
    const Workshop w;
    w.write("notes.txt", "no volume");
    w.write("plain.raw", std::string(4096, 'x'));
    w.write("cut.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 64 64 64\nencoding: raw\n\nshort");
    for (const char* file : {"notes.txt", "plain.raw", "cut.nrrd", "absent.nrrd"}) {
        INFO(file);
        const Outcome said = w.run({"thumbnail", file, "out.png"});
        CHECK(said.status == 1);
        CHECK(said.err.find("pellucid-cli: error: ") == 0);
        CHECK_FALSE(w.has("out.png"));
    }
    CHECK(w.run({"thumbnail", "notes.txt"}).status == 2);
    CHECK(w.run({"thumbnail", "notes.txt", "notes.txt"}).status != 0);
    CHECK(w.read("notes.txt") == "no volume");
    CHECK(w.run({"thumbnail", "notes.txt", "out.png", "--size", "9"}).status == 2);
}
