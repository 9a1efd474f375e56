// `colors`, and `render --simulate-vision`: colours as viewers with a deficiency see them.
#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"
#include "tf/color_vision.h"

using namespace pellucid;
using nlohmann::json;
using pellucid::test::Words;
using pellucid::test::Workshop;
using pellucid::test::operator+;

namespace {

/// Two tents over a small volume, in these colours.
void writeTf(const Workshop& w, const std::string& first, const std::string& second) {
    json tf{{"format", "pellucid-tf"}, {"version", 1}, {"points", json::array()}, {"features", json::array()}};
    const auto add = [&](double a, double b, const std::string& color, const char* name) {
        for (const auto& [x, opacity] : {std::pair(a, 0.0), std::pair((a + b) / 2, 0.5), std::pair(b, 0.0)})
            tf["points"].push_back({{"x", x}, {"opacity", opacity}, {"color", color}});
        tf["features"].push_back({{"name", name}, {"range", {a, b}}, {"color", color}});
    };
    add(0.1, 0.4, first, "bone");
    add(0.5, 0.9, second, "vessels");
    w.write("two.tf.json", tf.dump());
}

const Words kShells{"sample:shells", "--sample-size", "16"};

} // namespace

TEST_CASE("colors tells pairs that some viewers cannot tell apart", "[cli][colors]") {
    const Workshop w;
    writeTf(w, "#cc3300", "#668000");
    const json told = w.json(Words{"colors"} + kShells + Words{"--tf", "two.tf.json"});
    REQUIRE(told["alike"].size() == 1);
    CHECK(told["alike"][0]["features"] == json::array({"bone", "vessels"}));
    CHECK(told["alike"][0]["difference"].get<double>() < 10);
    CHECK(told["features"][0]["seen"]["normal"] == "#cc3300");
    CHECK(told["features"][0]["seen"]["grey"] != "#cc3300");
    // Less is wanted than there is: none.
    const double difference = told["alike"][0]["difference"].get<double>();
    CHECK(w.json(Words{"colors"} + kShells +
                 Words{"--tf", "two.tf.json", "--difference", std::to_string(difference - 0.01)})["alike"]
              .empty());
    CHECK(w.run(Words{"colors"} + kShells + Words{"--tf", "two.tf.json"}).out.find("bone and vessels look alike to") !=
          std::string::npos);
}

TEST_CASE("colors writes a transfer function in colours that are apart", "[cli][colors]") {
    const Workshop w;
    writeTf(w, "#808080", "#828282");
    REQUIRE(w.run(Words{"colors"} + kShells + Words{"--tf", "two.tf.json", "--out-tf", "apart.tf.json"}).status == 0);
    const json told = w.json(Words{"colors"} + kShells + Words{"--tf", "apart.tf.json"});
    CHECK(told["alike"].empty());
    CHECK(told["features"].size() == 2);
    // Thirteen features are too many.
    const auto refused = w.run(Words{"colors"} + kShells + Words{"--tf", "tents:20", "--out-tf", "many.tf.json"});
    CHECK(refused.status == 1);
    CHECK(refused.err.find("no colours were found") != std::string::npos);
}

TEST_CASE("a picture is drawn as a viewer with a deficiency sees it, and says so", "[cli][colors]") {
    const Workshop w;
    const Words render = Words{"render"} + kShells + Words{"--tf", "tents:3", "--size", "32x32", "--engine", "cpu"};
    CHECK_FALSE(w.json(render + Words{"--out", "plain.tif"}).contains("simulated_vision"));
    const json said = w.json(render + Words{"--simulate-vision", "protanopia:0.6", "--out", "seen.tif"});
    CHECK(said["simulated_vision"] == json{{"kind", "protanopia"}, {"severity", 0.6}});
    w.json(render + Words{"--simulate-vision", "normal", "--out", "normal.tif"});
    Image plain = readImage(w.path("plain.tif").string());
    const Image seen = readImage(w.path("seen.tif").string()), normal = readImage(w.path("normal.tif").string());
    CHECK(normal.rgba == plain.rgba);
    simulateVision(plain, visionMatrix(VisionKind::Protanopia, 0.6));
    REQUIRE(seen.rgba.size() == plain.rgba.size());
    double farthest = 0, changed = 0;
    for (std::size_t i = 0; i < plain.rgba.size(); ++i) {
        farthest = std::max(farthest, std::abs(static_cast<double>(plain.rgba[i] - seen.rgba[i])));
        changed = std::max(changed, std::abs(static_cast<double>(normal.rgba[i] - seen.rgba[i])));
    }
    CHECK(farthest < 2.0 / 255); // both files are rounded
    CHECK(changed > 0.05);
}

TEST_CASE("what is no kind of vision is refused in words", "[cli][colors]") {
    const Workshop w;
    const Words render = Words{"render"} + kShells + Words{"--out", "a.png"};
    const auto kind = w.run(render + Words{"--simulate-vision", "blue"});
    CHECK(kind.status == 2);
    CHECK(kind.err.find("deuteranopia") != std::string::npos);
    CHECK(w.run(render + Words{"--simulate-vision", "protanopia:2"}).status == 2);
    CHECK(w.run(render + Words{"--simulate-vision", "protanopia:0.5:1"}).status == 2);
}
