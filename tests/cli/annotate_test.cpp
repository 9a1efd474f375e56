// Annotations on the command line: --annotate, views by name, what `info` says of directions.
#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"

using nlohmann::json;
using pellucid::Image;
using pellucid::readImage;
using pellucid::test::Outcome;
using pellucid::test::Workshop;

namespace {

using Words = std::vector<std::string>;

/// 8³ voxels of 1 mm: 128 where i ≥ 4, 0 elsewhere; `space` says where i leads.
void writeHalf(const Workshop& w, const std::string& name, const std::string& space) {
    std::string bytes = "NRRD0004\ntype: uint8\ndimension: 3\nspace: " + space +
                        "\nsizes: 8 8 8\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n"
                        "encoding: raw\n\n";
    for (int n = 0; n < 512; ++n) bytes += static_cast<char>(n % 8 >= 4 ? 128 : 0);
    w.write(name, bytes);
}

Image rendered(const Workshop& w, const Words& more) {
    Words words{"render",  "--engine", "cpu",   "--size", "96x72", "--tf",
                "tents:1", "--range",  "0,255", "--out",  "p.png"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = w.run(words);
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return readImage(w.path("p.png").string());
}

/// Light in the left and in the right half of a picture.
std::pair<double, double> halves(const Image& image) {
    std::pair<double, double> sums{0, 0};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            (x < image.width / 2 ? sums.first : sums.second) += image.pixel(x, y)[0] + image.pixel(x, y)[1];
    return sums;
}

} // namespace

TEST_CASE("left is where the file says", "[cli][annotate]") {
    const Workshop w;
    // In LPS the bright half, of high i, is the patient's left: at the right from the front, at the left from behind.
    // In RAS it is the patient's right.
    writeHalf(w, "lps.nrrd", "left-posterior-superior");
    writeHalf(w, "ras.nrrd", "right-anterior-superior");
    const auto brightRight = [&](const std::string& file, const std::string& view) {
        const auto [left, right] = halves(rendered(w, {file, "--view", view}));
        INFO(file << " " << view << ": " << left << " " << right);
        CHECK((left > 4 * right || right > 4 * left));
        return right > left;
    };
    CHECK(brightRight("lps.nrrd", "anterior"));
    CHECK_FALSE(brightRight("lps.nrrd", "posterior"));
    CHECK(brightRight("lps.nrrd", "inferior"));
    CHECK_FALSE(brightRight("lps.nrrd", "superior"));
    CHECK_FALSE(brightRight("ras.nrrd", "anterior"));
    CHECK_FALSE(brightRight("ras.nrrd", "inferior"));
}

TEST_CASE("views by name are those of their angles", "[cli][annotate]") {
    const Workshop w;
    writeHalf(w, "lps.nrrd", "left-posterior-superior");
    const auto same = [&](const std::string& file, const std::string& name, const std::string& angles) {
        INFO(name);
        CHECK(rendered(w, {file, "--view", name}).rgba == rendered(w, {file, "--view", angles}).rgba);
    };
    same("lps.nrrd", "front", "0,0");
    same("lps.nrrd", "left", "90,0");
    same("lps.nrrd", "right,1.5", "-90,0,1.5");
    same("lps.nrrd", "superior", "180,90");
    same("sample:shells", "left", "-90,0");
    same("sample:shells", "top", "0,90");
    const Outcome noPatient =
        w.run({"measure", "sample:shells", "--size", "8", "--engine", "reference", "--view", "anterior"});
    CHECK(noPatient.status == 2);
    CHECK(noPatient.err.find("front") != std::string::npos);
    for (const char* wrong : {"sideways", "left,0", "left,x", "left,1,2"}) {
        const Outcome outcome = w.run({"measure", "sample:shells", "--view", wrong});
        INFO(wrong);
        CHECK(outcome.status == 2);
        CHECK(outcome.err.find("--view") != std::string::npos);
    }
}

TEST_CASE("annotations change a picture only where they are", "[cli][annotate]") {
    const Workshop w;
    writeHalf(w, "lps.nrrd", "left-posterior-superior");
    const auto render = [&](const Words& more) {
        Words words{"render", "lps.nrrd", "--view", "20,10", "--size", "400x300", "--engine", "cpu", "--out", "p.png"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = w.run(words);
        INFO(outcome.err);
        REQUIRE(outcome.status == 0);
        return readImage(w.path("p.png").string());
    };
    const Image plain = render({});
    const auto changed = [&](const Image& image) {
        std::vector<std::pair<int, int>> pixels;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                if (!std::equal(image.pixel(x, y), image.pixel(x, y) + 4, plain.pixel(x, y))) pixels.emplace_back(x, y);
        return pixels;
    };
    // The scale bar is in the lower right corner, the cube in the lower left one, the title at the top left.
    const auto scale = changed(render({"--annotate", "scale"}));
    CHECK(scale.size() > 50);
    for (const auto& [x, y] : scale) CHECK((x > 200 && y > 250));
    const auto cube = changed(render({"--annotate", "cube"}));
    CHECK(cube.size() > 300);
    for (const auto& [x, y] : cube) CHECK((x < 80 && y > 220));
    const auto both = changed(render({"--annotate", "cube,scale"}));
    CHECK(both.size() == scale.size() + cube.size());
    const auto title = changed(render({"--annotate", "title"}));
    CHECK(title.size() > 50);
    for (const auto& [x, y] : title) CHECK((x < 200 && y < 40));
    CHECK(changed(render({"--annotate", "all"})).size() > both.size() + title.size());
    CHECK(changed(render({"--background", "transparent", "--annotate", "letters"})).size() > 100);
    for (const char* wrong : {"", "cubes", "cube,", ",cube", "cube scale"}) {
        const Outcome outcome = w.run({"render", "lps.nrrd", "--out", "q.png", "--annotate", wrong});
        INFO(wrong);
        CHECK(outcome.status == 2);
        CHECK(outcome.err.find("--annotate") != std::string::npos);
        CHECK_FALSE(w.has("q.png"));
    }
}

TEST_CASE("info says how the volume lies in the world", "[cli][annotate]") {
    const Workshop w;
    writeHalf(w, "ras.nrrd", "right-anterior-superior");
    const json j = w.json({"info", "ras.nrrd"});
    CHECK(j["frame"] == "patient");
    CHECK(j["unit"] == "mm");
    CHECK(j["directions"] == json::parse("[[-1.0,0.0,0.0],[0.0,-1.0,0.0],[0.0,0.0,1.0]]"));
    CHECK(w.run({"info", "ras.nrrd"}).out.find("L→R, P→A, I→S") != std::string::npos);
    CHECK(w.json({"info", "sample:shells", "--size", "8"})["frame"] == "file");
    w.write("cells.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nspacings: 2 2 4\n"
                          "units: \"um\" \"um\" \"um\"\nencoding: raw\n\n01234567");
    CHECK(w.json({"info", "cells.nrrd"})["unit"] == "µm");
    CHECK_THAT(w.run({"info", "cells.nrrd"}).out, Catch::Contains("2 x 2 x 4 µm"));
    CHECK(w.json({"info", "sample:shells", "--size", "8"})["unit"] == "units");
}
