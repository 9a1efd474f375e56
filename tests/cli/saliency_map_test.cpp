// `measure --2dfs` and `saliency-map`: what catches the eye in a picture.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "cli_runner.h"
#include "image_io/image_file.h"
#include "saliency/image_saliency.h"

using nlohmann::json;
using namespace pellucid;
using test::Outcome;
using test::Words;
using test::operator+;
using test::Workshop;

namespace {

const Words kShellsOpened{"sample:shells", "--sample-size", "24", "--tf", "tents:3:0.1", "--engine", "cpu"};

std::vector<double> sharesIn(const json& answer) {
    std::vector<double> shares;
    for (const json& feature : answer["features"]) shares.push_back(feature["fs"]);
    return shares;
}

} // namespace

TEST_CASE("measure tells the 2D feature saliency of the picture that render draws", "[cli][picture]") {
    const Workshop w;
    const json answer = w.json(Words{"measure"} + kShellsOpened + Words{"--2dfs", "--size", "96x72"});
    const std::vector<double> shares = sharesIn(answer);
    REQUIRE(shares.size() == 3);
    CHECK(shares[0] + shares[1] + shares[2] == Approx(1).margin(1e-9));
    CHECK(*std::ranges::min_element(shares) > 0);
    CHECK(answer["picture"] == json{{"size", {96, 72}}, {"lit", false}, {"engine", "cpu"}});
    CHECK(answer["seconds"].contains("fs"));

    SECTION("light, background and size matter, figures of the volume do not change") {
        for (const Words& more : {Words{"--shading"}, Words{"--background", "1,1,1"}, Words{"--mode", "mip"}}) {
            INFO(more[0]);
            const json other = w.json(Words{"measure"} + kShellsOpened + Words{"--2dfs", "--size", "96x72"} + more);
            CHECK(sharesIn(other) != shares);
            CHECK(other["features"][0]["vws"] == answer["features"][0]["vws"]);
            CHECK(other["picture"]["lit"] == (more[0] == "--shading"));
        }
    }
    SECTION("a hidden feature has none, and one that is drawn alone has all") {
        const json hidden =
            w.json(Words{"measure"} + kShellsOpened + Words{"--2dfs", "--size", "96x72", "--hide", "f2"});
        CHECK(sharesIn(hidden)[1] == 0);
        const json alone =
            w.json(Words{"measure"} + kShellsOpened + Words{"--2dfs", "--size", "96x72", "--feature", "f2"});
        CHECK(sharesIn(alone) == std::vector<double>{0, 1, 0});
    }
    SECTION("pictures and maps are written, and add up") {
        const json written =
            w.json(Words{"measure"} + kShellsOpened + Words{"--2dfs", "--size", "96x72", "--maps", "m"});
        CHECK(written["picture"]["files"].size() == 3 + 3 * 5);
        const auto sum = [&](const std::string& name) {
            const Image image = readImage(w.path("m/" + name + ".exr").string());
            REQUIRE(image.width == 96);
            double total = 0;
            for (std::size_t i = 0; i < image.rgba.size(); i += 4) total += static_cast<double>(image.rgba[i]);
            return total;
        };
        const double all = sum("feature1_total") + sum("feature2_total") + sum("feature3_total");
        CHECK(sum("feature2_total") / all == Approx(shares[1]).margin(1e-5));
        CHECK(sum("feature2_total") == Approx(sum("feature2_shared") + sum("feature2_rest")).margin(1e-3));
        CHECK(sum("saliency") ==
              Approx(sum("rest") + sum("feature1_shared") + sum("feature2_shared") + sum("feature3_shared"))
                  .margin(1e-3));
        CHECK(readImage(w.path("m/feature3.png").string()).height == 72);
        CHECK(w.run(Words{"measure"} + kShellsOpened + Words{"--maps", "n"}).status == 2);
    }
    SECTION("the table has a column and says what picture it is of") {
        const Outcome text = w.run(Words{"measure"} + kShellsOpened + Words{"--2dfs", "--size", "96x72", "--shading"});
        CHECK(text.out.find("2DFS\n") != std::string::npos);
        CHECK(text.out.find("2DFS of 96 x 72 pixels, lit, drawn by cpu\n") != std::string::npos);
    }
}

TEST_CASE("options of a picture are refused where no picture is looked at", "[cli][picture]") {
    const Workshop w;
    for (const Words& more : {Words{"--size", "96x72"}, Words{"--shading"}, Words{"--background", "1,1,1"}}) {
        const Outcome outcome = w.run(Words{"measure"} + kShellsOpened + more);
        CHECK(outcome.status == 2);
        CHECK(outcome.err == "pellucid-cli: error: no picture is looked at, " + more[0] +
                                 ", add --2dfs or --shares, or leave it out\n");
    }
    // A number is still the sample's.
    CHECK(w.json({"measure", "sample:shells", "--size", "16", "--tf", "tents:3"})["volume"]["dims"] ==
          json{16, 16, 16});
}

TEST_CASE("saliency-map writes the map of any picture", "[cli][picture]") {
    const Workshop w;
    // A white spot of 8 × 8 pixels about (75.5, 27.5) on grey.
    Image image(128, 96);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const bool spot = x >= 72 && x < 80 && y >= 24 && y < 32;
            std::fill_n(image.pixel(x, y), 3, spot ? 1.0f : 0.4f);
            image.pixel(x, y)[3] = 1;
        }
    writeImage(image, w.path("p.png").string());
    const json answer = w.json({"saliency-map", "p.png", "--out", "s.exr"});
    CHECK(answer["size"] == json{128, 96});
    // Level 4, on which the map is made, has pixels of 16.
    CHECK(std::abs(answer["at"][0].get<int>() - 75.5) < 16);
    CHECK(std::abs(answer["at"][1].get<int>() - 27.5) < 16);
    const Image exr = readImage(w.path("s.exr").string());
    const Plane expected = saliencyMap(readImage(w.path("p.png").string()));
    REQUIRE(exr.rgba.size() == 4 * expected.values.size());
    bool same = true;
    for (std::size_t i = 0; i < expected.values.size(); ++i) same = same && exr.rgba[4 * i] == expected.values[i];
    CHECK(same);
    CHECK(w.json({"saliency-map", "p.png", "--out", "s.png"})["largest"] == answer["largest"]);
    const Image png = readImage(w.path("s.png").string());
    double most = 0;
    for (std::size_t i = 0; i < expected.values.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(png.rgba[4 * i]) - static_cast<double>(expected.values[i])));
    CHECK(most <= 0.5 / 65535 + 1e-6);

    SECTION("what cannot be done is said") {
        CHECK(w.run({"saliency-map", "p.png", "--out", "s.jpg"}).status == 2);
        CHECK(w.run({"saliency-map", "p.png"}).status == 2);
        CHECK(w.run({"saliency-map", "--out", "s.png"}).status == 2);
        const Outcome onItself = w.run({"saliency-map", "p.png", "--out", "p.png"});
        CHECK(onItself.status == 2);
        const Outcome none = w.run({"saliency-map", "none.png", "--out", "t.png"});
        CHECK(none.status == 1);
        CHECK(none.err.find("none.png") != std::string::npos);
        w.write("broken.png", "not a picture");
        CHECK(w.run({"saliency-map", "broken.png", "--out", "t.png"}).status == 1);
        CHECK_FALSE(w.has("t.png"));
    }
}
