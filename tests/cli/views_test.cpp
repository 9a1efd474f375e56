// `views` and `optimize --view best`: the best view, found from the command line.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"

using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

/// 20³ bytes, a MetaImage: a box of 200 in the middle, an opaque plate of 100 on the side of low x.
void writeScene(const Workshop& w) {
    std::string bytes;
    for (int k = 0; k < 20; ++k)
        for (int j = 0; j < 20; ++j)
            for (int i = 0; i < 20; ++i) {
                const auto inside = [](int v, int lo, int hi) { return v >= lo && v < hi; };
                const bool box = inside(i, 8, 12) && inside(j, 8, 12) && inside(k, 8, 12);
                const bool plate = inside(i, 3, 6) && inside(j, 1, 19) && inside(k, 1, 19);
                bytes += static_cast<char>(box ? 200 : plate ? 100 : 0);
            }
    w.write("scene.raw", bytes);
    w.write("scene.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 20 20 20\nElementType = MET_UCHAR\n"
                         "ElementSpacing = 1 1 1\nElementDataFile = scene.raw\n");
    // Both with vertical sides, α = 0.9: three voxels of the plate leave a thousandth of the light.
    w.write("scene.tf.json", R"({"format":"pellucid-tf","version":1,"range":[0,200],"points":[
        {"x":0.3,"opacity":0,"color":"#00ff00"},{"x":0.31,"opacity":0.9,"color":"#00ff00"},
        {"x":0.69,"opacity":0.9,"color":"#00ff00"},{"x":0.7,"opacity":0,"color":"#00ff00"},
        {"x":0.8,"opacity":0,"color":"#ff0000"},{"x":0.81,"opacity":0.9,"color":"#ff0000"},
        {"x":1,"opacity":0.9,"color":"#ff0000"}],
        "features":[{"name":"plate","range":[0.3,0.7],"color":"#00ff00"},
                    {"name":"box","range":[0.8,1],"color":"#ff0000"}]})");
}

const Words kScene{"scene.mhd", "--tf", "scene.tf.json"};
const Words kFromPlate{"--view", "-90,0"}; ///< the eye at low x, before the plate

} // namespace

TEST_CASE("views finds the free side of what is hidden", "[cli][views]") {
    const Workshop w;
    writeScene(w);
    const json j = w.json(Words{"views"} + kScene + kFromPlate +
                          Words{"--feature", "box", "--count", "64", "--out-camera", "best.camera.json"});
    CHECK(j["command"] == "views");
    CHECK(j["metric"] == "vws");
    CHECK(j["feature"] == "box");
    CHECK(j["coarsening"] == 1);
    REQUIRE(j["views"].size() == 64);
    for (const json& v : j["views"]) {
        const double az = v["azimuth"].get<double>() * M_PI / 180, el = v["elevation"].get<double>() * M_PI / 180;
        CHECK(v["direction"][0].get<double>() == Approx(std::sin(az) * std::cos(el)).margin(1e-9));
        CHECK(v["direction"][2].get<double>() == Approx(std::sin(el)).margin(1e-9));
        CHECK(v["value"].get<double>() >= 0);
    }
    CHECK(j["present"]["view"]["azimuth"].get<double>() == Approx(-90));
    CHECK(j["present"]["value"].get<double>() < 0.01);
    CHECK(j["best"]["value"].get<double>() > 10 * j["present"]["value"].get<double>());
    for (const json& v : j["views"]) CHECK(j["best"]["value"].get<double>() > v["value"].get<double>() - 0.02);
    CHECK(j["worst"]["value"].get<double>() <= j["present"]["value"].get<double>());
    // From the other side of the plate: not within 60 degrees of where it hides the box.
    CHECK(std::abs(j["best"]["view"]["azimuth"].get<double>() + 90) > 60);

    // The camera that is written is that view, and `measure` has the same figure there.
    CHECK(json::parse(w.read("best.camera.json")) == j["best"]["camera"]);
    const json m = w.json(Words{"measure"} + kScene + Words{"--camera", "best.camera.json"});
    CHECK(m["features"][1]["vws"].get<double>() == Approx(j["best"]["value"].get<double>()).margin(1e-6));
    const json seen =
        w.json(Words{"views"} + kScene + Words{"--feature", "box", "--metric", "visibility", "--count", "16"});
    CHECK(seen["metric"] == "visibility");

    const Outcome text = w.run(Words{"views"} + kScene + kFromPlate + Words{"--feature", "box", "--count", "16"});
    CHECK(text.status == 0);
    CHECK(text.out.find("VWS of box") != std::string::npos);
    CHECK(text.out.find("best") != std::string::npos);
}

TEST_CASE("views judges by targets, and writes its map as a table and as a picture", "[cli][views]") {
    const Workshop w;
    writeScene(w);
    const Words call = Words{"views"} + kScene + Words{"--target", "1,1", "--count", "32"};
    const json j = w.json(call + Words{"--map", "map.csv"});
    CHECK(j["metric"] == "objective");
    CHECK(j["target"] == json({0.5, 0.5}));
    double least = 1;
    for (const json& v : j["views"]) least = std::min(least, v["value"].get<double>());
    CHECK(j["best"]["value"].get<double>() <= least + 0.02); // less is better; the map is a draft
    CHECK(j["worst"]["value"].get<double>() >= j["present"]["value"].get<double>());

    std::istringstream table(w.read("map.csv"));
    std::string line;
    std::getline(table, line);
    CHECK(line == "azimuth,elevation,x,y,z,value");
    std::size_t lines = 0;
    while (std::getline(table, line)) {
        CHECK(std::count(line.begin(), line.end(), ',') == 5);
        CHECK(std::stod(line.substr(line.rfind(',') + 1)) ==
              Approx(j["views"][lines]["value"].get<double>()).margin(1e-6));
        ++lines;
    }
    CHECK(lines == 32);

    CHECK(w.json(call + Words{"--map", "map.png"})["views"] == j["views"]);
    const pellucid::Image picture = pellucid::readImage(w.path("map.png").string());
    CHECK(picture.width == 512);
    CHECK(picture.height == 256);
    // Bright where it is good: the pixel of the best direction is brighter than that of the worst.
    const auto brightness = [&](const json& view) {
        const int x = static_cast<int>((view["azimuth"].get<double>() + 180) / 360 * 512),
                  y = static_cast<int>((90 - view["elevation"].get<double>()) / 180 * 256);
        const float* p = picture.pixel(std::clamp(x, 0, 511), std::clamp(y, 0, 255));
        return p[0] + p[1] + p[2];
    };
    const auto byValue = [](const json& a, const json& b) {
        return a["value"].get<double>() < b["value"].get<double>();
    };
    const auto [best, worst] = std::minmax_element(j["views"].begin(), j["views"].end(), byValue);
    CHECK(brightness(*best) > brightness(*worst) + 0.5f);
}

TEST_CASE("views and space take targets in the words of optimize", "[cli][views][space]") {
    const Workshop w;
    const Words shells{"sample:shells", "--sample-size", "16", "--tf", "tents:3"};
    // Peaks of tents:3 lie at 1/6, 1/2 and 5/6, as 1 to 3 to 5.
    const std::vector<std::pair<std::string, std::vector<double>>> cases{{"equal", {1. / 3, 1. / 3, 1. / 3}},
                                                                         {"diagonal", {1. / 9, 3. / 9, 5. / 9}},
                                                                         {"inside-out", {5. / 9, 3. / 9, 1. / 9}},
                                                                         {"only:f2", {0, 1, 0}},
                                                                         {"1,2,1", {0.25, 0.5, 0.25}}};
    for (const auto& [words, shares] : cases) {
        INFO(words);
        const Words target{"--target", words};
        for (const json& answer : {w.json(Words{"views"} + shells + target + Words{"--count", "16"}),
                                   w.json(Words{"space"} + shells + target + Words{"--samples", "2"}),
                                   w.json(Words{"optimize"} + shells + target + Words{"--max-iterations", "0"})}) {
            REQUIRE(answer["target"].size() == 3);
            for (std::size_t f = 0; f < 3; ++f) CHECK(answer["target"][f].get<double>() == Approx(shares[f]));
        }
    }
    for (const std::string command : {"views", "space"})
        for (const auto& [words, part] :
             {std::pair<std::string, std::string>{"sideways", "give numbers, equal, diagonal, inside-out or only:NAME"},
              {"only:f9", "known: 'f1', 'f2', 'f3'"},
              {"1,2", "2 targets for 3 features"},
              {"-1,1,1", "--target"}}) {
            const Outcome outcome = w.run(Words{command} + shells + Words{"--target", words});
            INFO(command << " " << words << ": " << outcome.err);
            CHECK(outcome.status == 2);
            CHECK(outcome.err.find(part) != std::string::npos);
        }
}

TEST_CASE("optimize searches view and opacities together", "[cli][views]") {
    const Workshop w;
    writeScene(w);
    const Words targets{"--target", "1,1"};
    const json j = w.json(
        Words{"optimize"} + kScene + targets +
        Words{"--view", "best", "--exact-shares", "--out-tf", "found.tf.json", "--out-camera", "found.camera.json"});
    CHECK(j["converged"] == true);
    CHECK(j["view"].contains("azimuth"));
    CHECK(j["view"].contains("elevation"));
    CHECK(json::parse(w.read("found.camera.json")) == j["camera"]);
    // What is written is what was found: `measure` sees the shares there.
    const json m = w.json({"measure", "scene.mhd", "--tf", "found.tf.json", "--camera", "found.camera.json"});
    for (const json& f : m["features"]) CHECK(f["vws"].get<double>() == Approx(0.5).margin(0.05));
    const Outcome text = w.run(Words{"optimize"} + kScene + targets + Words{"--view", "best"});
    CHECK(text.status == 0);
    CHECK(text.out.find("\nview ") != std::string::npos);
    // Elsewhere the camera is the one that was asked for.
    const json plain =
        w.json(Words{"optimize"} + kScene + targets + Words{"--view", "40,10", "--out-camera", "plain.camera.json"});
    CHECK_FALSE(plain.contains("view"));
    CHECK(json::parse(w.read("plain.camera.json"))["projection"] == "perspective");
}

TEST_CASE("what views cannot do is said in words", "[cli][views]") {
    const Workshop w;
    writeScene(w);
    const auto refused = [&](const Words& words, const std::string& what) {
        const Outcome o = w.run(words);
        INFO(o.err);
        CHECK(o.status == 2);
        CHECK(o.out.empty());
        CHECK(o.err.find(what) != std::string::npos);
    };
    refused(Words{"views"} + kScene, "--target or --feature");
    refused(Words{"views"} + kScene + Words{"--feature", "box", "--target", "1,1"}, "leave one out");
    refused(Words{"views"} + kScene + Words{"--feature", "lid"}, "known: 'plate', 'box'");
    refused(Words{"views"} + kScene + Words{"--target", "1,1,1"}, "3 targets for 2 features");
    refused(Words{"views"} + kScene + Words{"--feature", "box", "--count", "4"}, "--count");
    refused(Words{"views"} + kScene + Words{"--feature", "box", "--metric", "f"}, "vws or visibility");
    refused(Words{"views"} + kScene + Words{"--feature", "box", "--map", "map.txt"}, "--map");
    refused(Words{"measure"} + kScene + Words{"--view", "best"}, "pellucid-cli views");
    refused(Words{"optimize"} + kScene + Words{"--target", "1,1", "--view", "best", "--camera", "c.json"},
            "--camera and --view");
}

TEST_CASE("a picture of nothing is told as such", "[cli]") {
    // What the clipping leaves has no feature: no ray meets one, and there is no cover to compute.
    const Workshop w;
    const json j = w.json({"optimize", "sample:disks", "--sample-size", "16", "--tf", "tents:3", "--target", "1,1,1",
                           "--clip", "y:0:0.02"});
    CHECK(j["coverage"] == 0);
    CHECK(j["covers"] == json({0, 0, 0}));
    CHECK(j["converged"] == false);
    const Outcome outcome = w.run({"optimize", "sample:disks", "--sample-size", "16", "--tf", "tents:3", "--target",
                                   "1,1,1", "--clip", "y:0:0.02"});
    CHECK(outcome.out.find("Faint: The picture is 0 % opaque") != std::string::npos);
}
