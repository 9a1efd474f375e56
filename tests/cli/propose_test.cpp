// `propose`: the automatic start as text, as JSON and as a file that the other commands take.
#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "support/ball_on_board.h"

using nlohmann::json;
using pellucid::test::Outcome;
using pellucid::test::Workshop;

namespace {

/// 16³ bytes: `inner` in the middle 8³, else `outer`.
std::string cube(unsigned char outer, unsigned char inner) {
    std::string bytes;
    for (int k = 0; k < 16; ++k)
        for (int j = 0; j < 16; ++j)
            for (int i = 0; i < 16; ++i) {
                const bool inside = i >= 4 && i < 12 && j >= 4 && j < 12 && k >= 4 && k < 12;
                bytes += static_cast<char>(inside ? inner : outer);
            }
    return bytes;
}

} // namespace

TEST_CASE("propose tells kind, window, background, features and why", "[cli][propose]") {
    const Workshop w;
    const json j = w.json({"propose", "sample:disks", "--size", "32", "--out-tf", "start.tf.json"});
    CHECK(j["command"] == "propose");
    CHECK(j["kind"] == "labels");
    CHECK_FALSE(j.contains("unit"));
    CHECK(j["window"] == json({0.0, 252.0}));
    CHECK(j["outside"] == 0.0);
    CHECK(j["background"] == json({0.0, 21.0}));
    REQUIRE(j["features"].size() == 3);
    // The disks are 42, 126, 210; borders half-way.
    CHECK(j["features"][0]["range"] == json({21.0, 84.0}));
    CHECK(j["features"][1]["range"] == json({84.0, 168.0}));
    CHECK(j["features"][2]["range"] == json({168.0, 252.0}));
    for (const json& f : j["features"]) {
        CHECK(f["name"] == "value " + std::to_string(f["mode"].get<int>()));
        CHECK(f["share"].get<double>() > 0);
        CHECK(f["inside"].get<double>() >= 0);
        CHECK(f["opacity"].get<double>() > 0);
        CHECK(f["color"].get<std::string>().size() == 7);
    }
    CHECK(j["why"].size() >= 2);
    CHECK(j["tf"]["range"] == json({0.0, 252.0}));
    CHECK(json::parse(w.read("start.tf.json")) == j["tf"]);

    const Outcome text = w.run({"propose", "sample:disks", "--size", "32"});
    CHECK(text.status == 0);
    CHECK(text.out.find("labels") != std::string::npos);
    CHECK(text.out.find("value 126") != std::string::npos);
}

TEST_CASE("what propose writes is a transfer function that shows the matter and not the background", "[cli][propose]") {
    const Workshop w;
    w.write("cube.raw", cube(10, 200));
    const std::vector<std::string> volume{"cube.raw", "--raw", "16,16,16,u8"};
    const auto with = [&](std::vector<std::string> words, const std::vector<std::string>& options) {
        words.insert(words.end(), volume.begin(), volume.end());
        words.insert(words.end(), options.begin(), options.end());
        return words;
    };
    const json j = w.json(with({"propose"}, {"--out-tf", "cube.tf.json"}));
    CHECK(j["kind"] == "binary");
    CHECK(j["background"] == json({10.0, 105.0}));
    const json measured = w.json(with({"measure"}, {"--tf", "cube.tf.json", "--engine", "cpu"}));
    REQUIRE(measured["features"].size() == 1);
    CHECK(measured["features"][0]["name"] == "value 200");
    CHECK(measured["features"][0]["visibility"].get<double>() == Approx(1).margin(1e-6));
    CHECK(measured["features"][0]["opacity"].get<double>() == Approx(j["features"][0]["opacity"].get<double>()));

    // A window that was asked for is the proposal's.
    CHECK(w.json(with({"propose"}, {"--range", "0,255"}))["window"] == json({0.0, 255.0}));
}

TEST_CASE("propose has an answer where there is nothing to see", "[cli][propose]") {
    const Workshop w;
    w.write("constant.raw", cube(7, 7));
    // The reader's note that all voxels are alike goes to stderr.
    const json constant = json::parse(w.run({"propose", "constant.raw", "--raw", "16,16,16,u8", "--json"}).out);
    CHECK(constant["kind"] == "constant");
    CHECK_FALSE(constant.contains("background"));
    REQUIRE(constant["features"].size() == 1);
    CHECK(constant["features"][0]["name"] == "value 7");

    const float nan = std::nanf("");
    std::string bytes;
    for (int i = 0; i < 64; ++i) bytes.append(reinterpret_cast<const char*>(&nan), sizeof nan);
    w.write("nan.raw", bytes);
    const json empty = json::parse(w.run({"propose", "nan.raw", "--raw", "4,4,4,f32", "--json"}).out);
    CHECK(empty["kind"] == "empty");
    CHECK(empty["features"].size() == 1);
}

TEST_CASE("propose in Hounsfield units says so", "[cli][propose]") {
    const Workshop w;
    const json j = w.json({"propose", "sample:knee", "--size", "64"});
    CHECK(j["kind"] == "ct");
    CHECK(j["unit"] == "HU");
    CHECK(j["features"][0]["name"] == "skin and fat");
    CHECK(j["features"].back()["range"][1] == j["window"][1]);
}

TEST_CASE("propose names the view that a volume opens on, and what leaves a board out", "[cli][propose]") {
    const Workshop w;
    w.write("onboard.raw", pellucid::test::ballOnBoard());
    const std::vector<std::string> volume{"onboard.raw", "--raw", "40,40,40,u8"};
    const auto with = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
        words.insert(words.begin() + 1, volume.begin(), volume.end());
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    const json j = w.json(with({"propose"}, {}));
    std::vector<std::string> options;
    REQUIRE(j["holder"]["clip"].size() >= 1);
    for (const json& clip : j["holder"]["clip"]) {
        options.emplace_back("--clip");
        options.push_back(clip);
    }
    CHECK(j["holder"]["lost"].get<double>() < 0.05);
    CHECK(j["why"].dump().find("board") != std::string::npos);
    CHECK(j["camera"]["eye"][1].get<double>() > 0); // not from the board's side

    // Every command looks from there, says so, and takes the clip box. What --holder says needs no note.
    const json measured = w.json(with({"measure"}, {"--engine", "cpu", "--holder", "0"}));
    CHECK(measured["camera"] == j["camera"]);
    const json drawn =
        w.json(with({"render"}, {"--out", "a.png", "--size", "64x64", "--engine", "cpu", "--holder", "1"}));
    CHECK(drawn["camera"] == j["camera"]);
    CHECK(drawn["view"] == j["view"]);
    w.json(with({"render"}, [&] {
        std::vector<std::string> more{"--out", "b.png", "--size", "64x64", "--engine", "cpu", "--holder", "1"};
        more.insert(more.end(), options.begin(), options.end());
        return more;
    }()));
    CHECK(w.read("a.png") != w.read("b.png"));
    // Under a transfer function of one's own it is the view of the box, whatever that shows.
    const json tents = w.json(with({"measure"}, {"--engine", "cpu", "--tf", "tents:3"}));
    CHECK(tents["view"]["azimuth"].get<double>() == Approx(30));
    CHECK(tents["camera"] == w.json(with({"measure"}, {"--engine", "cpu", "--tf", "ramp:5"}))["camera"]);
    CHECK_FALSE(w.json({"propose", "sample:disks", "--size", "32"}).contains("holder"));
}
