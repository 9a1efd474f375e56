// `probe`, and slices by `render --slice`.
#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"

using nlohmann::json;
using pellucid::Image;
using pellucid::readImage;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

/// 8³ voxels whose value is the coordinate: i + 8·j + 64·k, halved so that it fits into 8 bits. `signs` turns the axes
/// around: the same values at the same places of the world, stored backwards.
void writeNumbered(const Workshop& w, const std::string& name, const std::array<int, 3>& signs = {1, 1, 1}) {
    const auto text = [](const char* format, int a, int b, int c) {
        std::array<char, 64> line{};
        std::snprintf(line.data(), line.size(), format, a, b, c);
        return std::string(line.data());
    };
    const auto origin = [&](std::size_t a) { return signs[a] > 0 ? 0 : 7; };
    std::string bytes =
        "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 8 8 8\n"
        "space directions: " +
        text("(%d,%d,%d) ", signs[0], 0, 0) + text("(%d,%d,%d) ", 0, signs[1], 0) + text("(%d,%d,%d)", 0, 0, signs[2]) +
        "\nspace origin: " + text("(%d,%d,%d)", origin(0), origin(1), origin(2)) + "\nencoding: raw\n\n";
    for (int n = 0; n < 512; ++n) {
        std::array<int, 3> v{n % 8, n / 8 % 8, n / 64};
        for (std::size_t a = 0; a < 3; ++a)
            if (signs[a] < 0) v[a] = 7 - v[a];
        bytes += static_cast<char>((v[0] + 8 * v[1] + 64 * v[2]) / 2);
    }
    w.write(name, bytes);
}

/// Grey levels 0 … 255 of a slice with a pixel per voxel.
Image sliced(const Workshop& w, const Words& options) {
    const Outcome outcome = w.run(Words{"render", "--size", "8x8", "--out", "s.png", "--tf", "tents:3"} + options);
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return readImage(w.path("s.png").string());
}

int level(const Image& image, int x, int y) { return static_cast<int>(std::lround(255 * image.pixel(x, y)[0])); }

/// α = 0.1 in the lower half of the intensities, 0.2 in the upper.
const char* const kTwoFeatures = R"({"format":"pellucid-tf","version":1,"range":[0,1],
  "points":[{"x":0,"opacity":0.1,"color":"#ff0000"},{"x":0.5,"opacity":0.1,"color":"#ff0000"},
            {"x":0.5,"opacity":0.2,"color":"#0000ff"},{"x":1,"opacity":0.2,"color":"#0000ff"}],
  "features":[{"name":"front","range":[0,0.5],"color":"#ff0000"},{"name":"back","range":[0.5,1],"color":"#0000ff"}]})";
const char* const kAlongY =
    R"({"projection":"orthographic","eye":[3.5,-100,3.5],"center":[3.5,3.5,3.5],"up":[0,0,1],"height":8})";

} // namespace

TEST_CASE("probe tells the shares of slabs of known opacity", "[cli][probe]") {
    const Workshop w;
    // 8³ bytes, 0 in the four planes in front and 1 in the four behind: along y the intensity is below ½ for four
    // voxels (half of the step between centres is on either side), so the shares are 1 − 0.9⁴ and 0.9⁴·(1 − 0.8⁴).
    std::string bytes;
    for (int n = 0; n < 512; ++n) bytes += static_cast<char>(n / 8 % 8 < 4 ? 0 : 1);
    w.write("slabs.raw", bytes);
    w.write("two.tf.json", kTwoFeatures);
    w.write("front.camera.json", kAlongY);
    const Words common{"slabs.raw", "--raw", "8,8,8,u8", "--tf", "two.tf.json", "--camera", "front.camera.json"};
    const json p = w.json(Words{"probe"} + common + Words{"4,3", "--size", "8x8"});
    CHECK(p["command"] == "probe");
    CHECK(p["pixel"] == json({4, 3}));
    CHECK(p["hit"] == true);
    REQUIRE(p["features"].size() == 2);
    const double front = 1 - std::pow(0.9, 4), back = std::pow(0.9, 4) * (1 - std::pow(0.8, 4));
    CHECK(p["features"][0]["name"] == "front");
    CHECK(p["features"][0]["share"] == Approx(front).margin(1e-9));
    CHECK(p["features"][1]["share"] == Approx(back).margin(1e-9));
    CHECK(p["rest"] == 0);
    CHECK(p["alpha"] == Approx(front + back).margin(1e-9));
    CHECK(p["feature"] == "back"); // 0.344 and 0.387
    CHECK(p["value"].get<double>() >= 0.5);
    CHECK(p["position"][1] == Approx(3.5).margin(0.1)); // where it begins, half-way between the planes 3 and 4
    CHECK(p["entry"][1] == Approx(-0.5));
    CHECK(p["exit"][1] == Approx(7.5));
    // Pixel 4 of 8 is half a unit to the right of the middle, 3.5; row 3 half a unit above it.
    CHECK(p["position"][0] == Approx(4));
    CHECK(p["position"][2] == Approx(4));
    CHECK(p["samples"].front()["opacity"] == 0);
    CHECK(p["samples"].back()["t"] == Approx(8));
    CHECK(p["samples"].back()["opacity"] == Approx(front + back).margin(1e-9));
    REQUIRE(p["runs"].size() == 2);
    CHECK(p["runs"][0]["feature"] == "front");
    CHECK(p["runs"][0]["to"] == Approx(4));
    CHECK(p["runs"][1]["optical_depth"] == Approx(-4 * std::log(0.8)));

    // Without its front half, and as the only feature that is drawn, the back is seen whole.
    for (const Words& more : {Words{"--clip", "y:0.5:1"}, Words{"--feature", "back"}})
        CHECK(w.json(Words{"probe"} + common + Words{"4,3", "--size", "8x8"} + more)["features"][1]["share"] ==
              Approx(1 - std::pow(0.8, 4)).margin(1e-9));
    const Outcome text = w.run(Words{"probe"} + common + Words{"4,3", "--size", "8x8"});
    CHECK(text.out.find("34.4 %") != std::string::npos); // 1 − 0.9⁴ = 0.3439
}

TEST_CASE("probe of a pixel has the alpha of the picture", "[cli][probe]") {
    const Workshop w;
    const Words scene{"sample:shells", "--sample-size", "24", "--tf", "tents:3", "--view", "40,25", "--size", "48x40"};
    REQUIRE(
        w.run(Words{"render", "--engine", "cpu", "--background", "transparent", "--step", "0.125", "--out", "p.exr"} +
              scene)
            .status == 0);
    const Image image = readImage(w.path("p.exr").string());
    for (const auto& [x, y] : {std::pair{24, 20}, std::pair{15, 12}, std::pair{30, 25}, std::pair{0, 0}}) {
        const json p = w.json(Words{"probe"} + scene + Words{std::to_string(x) + "," + std::to_string(y)});
        double sum = p["rest"];
        for (const json& f : p["features"]) sum += f["share"].get<double>();
        CHECK(std::abs(sum - static_cast<double>(image.pixel(x, y)[3])) < 1.0 / 255);
    }
}

TEST_CASE("a probe beside the volume, and pixels that are none", "[cli][probe]") {
    const Workshop w;
    const Words shells{"sample:shells", "--sample-size", "16", "--tf", "tents:3"};
    const json beside = w.json(Words{"probe"} + shells + Words{"0,0", "--view", "0,0,0.3"});
    CHECK(beside["hit"] == false);
    CHECK(beside["alpha"] == 0);
    CHECK_FALSE(beside.contains("samples"));
    CHECK_FALSE(beside.contains("feature"));
    for (const char* bad : {"512,0", "0,512", "1", "1,2,3", "a,b", "1.5,2"}) {
        const Outcome outcome = w.run(Words{"probe"} + shells + Words{bad});
        INFO(bad);
        CHECK(outcome.status == 2);
        CHECK(outcome.err.find("X,Y") != std::string::npos);
    }
    CHECK(w.run(Words{"probe"} + shells).status == 2);
}

TEST_CASE("a slice shows the values of its voxels", "[cli][slice]") {
    const Workshop w;
    writeNumbered(w, "n.nrrd");
    const Words grey{"n.nrrd", "--tf-strength", "0", "--window", "0,255"};
    // Voxel k has its centre at the fraction (k + ½)/8. The patient's left and back are where i and j are high: axial
    // slices show (x, y), coronal ones (x, 7 − y) of i and k, sagittal ones (x, 7 − y) of j and k.
    const auto value = [](int i, int j, int k) { return (i + 8 * j + 64 * k) / 2; };
    const Image axial = sliced(w, grey + Words{"--slice", "z:0.4375"}), // k = 3
        coronal = sliced(w, grey + Words{"--slice", "y:0.1875"}),       // j = 1
        sagittal = sliced(w, grey + Words{"--slice", "x:0.9375"});      // i = 7
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            CHECK(level(axial, x, y) == value(x, y, 3));
            CHECK(level(coronal, x, y) == value(x, 1, 7 - y));
            CHECK(level(sagittal, x, y) == value(7, x, 7 - y));
        }
    // Half-way between the planes 3 and 4 the values are, too; the nearest voxel has no half values.
    CHECK(level(sliced(w, grey + Words{"--slice", "z:0.5"}), 2, 2) == (value(2, 2, 3) + value(2, 2, 4)) / 2);
    CHECK(level(sliced(w, grey + Words{"--slice", "z:0.5", "--nearest"}), 2, 2) == value(2, 2, 4));
    const json told =
        w.json(Words{"render", "--size", "8x8", "--out", "t.png", "--slice", "z:0.4375", "--tf", "tents:3"} + grey);
    CHECK(told["slice"]["name"] == "axial");
    CHECK(told["slice"]["voxel"] == 3);
    CHECK(told["slice"]["window"] == json({0, 255}));
}

TEST_CASE("slices do not depend on the order in which a file stores its voxels", "[cli][slice]") {
    const Workshop w;
    writeNumbered(w, "plain.nrrd");
    writeNumbered(w, "flipped.nrrd", {-1, -1, -1});
    writeNumbered(w, "half.nrrd", {1, -1, 1});
    for (const std::string axis : {"x", "y", "z"}) {
        // Fractions count along the index axis: 0.3125 of one that is stored backwards is 0.6875 of the
        // other.
        const Image plain = sliced(w, {"plain.nrrd", "--slice", axis + ":0.3125"});
        CHECK(plain.rgba == sliced(w, {"flipped.nrrd", "--slice", axis + ":0.6875"}).rgba);
        CHECK(plain.rgba == sliced(w, {"half.nrrd", "--slice", axis + (axis == "y" ? ":0.6875" : ":0.3125")}).rgba);
        CHECK(plain.rgba != sliced(w, {"plain.nrrd", "--slice", axis + ":0.6875"}).rgba);
    }
}

TEST_CASE("colours, clips and backgrounds of slices", "[cli][slice]") {
    const Workshop w;
    writeNumbered(w, "n.nrrd");
    const Image colored = sliced(w, {"n.nrrd", "--slice", "z:0.5", "--tf-strength", "1"});
    double most = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            most = std::max(most, static_cast<double>(std::abs(colored.pixel(x, y)[0] - colored.pixel(x, y)[2])));
    CHECK(most > 0.3);
    // What is clipped away shows the background.
    const Image half =
        sliced(w, {"n.nrrd", "--slice", "z:0.9", "--clip", "x:0:0.5", "--background", "1,1,1", "--tf-strength", "0"});
    CHECK(level(half, 3, 3) < 250);
    CHECK(level(half, 4, 3) == 255);

    for (const Words& bad :
         {Words{"--slice", "w:0.5"}, Words{"--slice", "x:1.5"}, Words{"--slice", "0.5"}, Words{"--window", "0,1"},
          Words{"--tf-strength", "0.5"}, Words{"--nearest"}, Words{"--slice", "x:0.5", "--tf-strength", "2"},
          Words{"--slice", "x:0.5", "--annotate", "all"}}) {
        INFO(bad.back());
        CHECK(w.run(Words{"render", "n.nrrd", "--out", "b.png"} + bad).status == 2);
        CHECK_FALSE(w.has("b.png"));
    }
}
