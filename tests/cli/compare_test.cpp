// `compare`: pictures, transfer functions, views and frames.
#include <catch2/catch.hpp>

#include <fstream>

#include "base/round_numbers.h"
#include "cli_runner.h"
#include "image_io/image_file.h"
#include "session/comparison.h"
#include "session/session_json.h"
#include "tf/transfer_function.h"

using nlohmann::json;
using namespace pellucid;
using test::operator+;
using test::Outcome;
using test::Words;
using test::Workshop;

namespace {

const Words kView{"sample:shells", "--sample-size", "24", "--size", "64x48", "--engine", "cpu"};

Image half(float left, float right) {
    Image image(32, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) {
            std::fill_n(image.pixel(x, y), 3, x < 16 ? left : right);
            image.pixel(x, y)[3] = 1;
        }
    return image;
}

} // namespace

TEST_CASE("two pictures are compared pixel by pixel", "[cli][compare]") {
    const Workshop w;
    writeImage(half(0, 0), w.path("a.png").string());
    writeImage(half(0, 1), w.path("b.png").string());
    const json same = w.json({"compare", "a.png", "a.png"});
    CHECK(same["ssim"] == 1);
    CHECK(same["delta_e"] == json{{"mean", 0}, {"largest", 0}, {"noticed", 0}});
    CHECK_FALSE(same.contains("features"));
    // Half of the pixels go from black to white, which is ΔE = 100.
    const json j = w.json({"compare", "a.png", "b.png", "--difference", "d.png", "--side-by-side", "s.png"});
    CHECK(j["delta_e"]["mean"].get<double>() == Approx(50).margin(1e-3));
    CHECK(j["delta_e"]["largest"].get<double>() == Approx(100).margin(1e-3));
    CHECK(j["delta_e"]["noticed"] == 0.5);
    CHECK(j["ssim"].get<double>() < 0.7);
    CHECK(j["files"] == json{"d.png", "s.png"});
    const Image difference = readImage(w.path("d.png").string());
    CHECK(difference.pixel(3, 3)[0] == 0);
    CHECK(difference.pixel(20, 3)[0] == Approx(1).margin(1e-3));
    const Image both = readImage(w.path("s.png").string());
    CHECK(both.width == 64);
    CHECK(both.pixel(20, 0)[0] == 0);
    CHECK(both.pixel(52, 0)[0] == 1);
}

TEST_CASE("two transfer functions are compared by their pictures and figures", "[cli][compare]") {
    const Workshop w;
    const json j = w.json(Words{"compare", "tents:3:0.1", "tents:3:0.8"} + kView +
                          Words{"--difference", "d.exr", "--figures", "figures.csv"});
    REQUIRE(j["features"].size() == 3);
    for (const auto& [side, peak] : {std::pair{"a", "0.1"}, std::pair{"b", "0.8"}}) {
        const json alone = w.json(Words{"measure"} + kView + Words{"--2dfs", "--tf", std::string("tents:3:") + peak});
        for (std::size_t f = 0; f < 3; ++f)
            for (const char* figure : {"vws", "visibility", "fs", "opacity"})
                CHECK(j["features"][f][side][figure] == alone["features"][f][figure]);
    }
    CHECK(j["delta_e"]["mean"].get<double>() > 1);
    std::ifstream table(w.path("figures.csv"));
    std::string head, first;
    std::getline(table, head);
    std::getline(table, first);
    CHECK(head == "feature,figure,a,b,difference");
    CHECK(first.starts_with("f1,vws," + exactText(j["features"][0]["a"]["vws"].get<double>()) + ","));
    // What is compared are the pictures that render draws; but for 8 bits.
    w.json(Words{"render"} + kView + Words{"--tf", "tents:3:0.1", "--out", "a.png"});
    w.json(Words{"render"} + kView + Words{"--tf", "tents:3:0.8", "--out", "b.png"});
    const json files = w.json({"compare", "a.png", "b.png"});
    CHECK(files["ssim"].get<double>() == Approx(j["ssim"].get<double>()).margin(0.005));
    CHECK(files["delta_e"]["mean"].get<double>() == Approx(j["delta_e"]["mean"].get<double>()).margin(0.05));
    const Outcome text = w.run(Words{"compare", "tents:3:0.1", "tents:2"} + kView);
    CHECK(text.out.find("f3") != std::string::npos);
    CHECK(text.out.find(" - ") != std::string::npos); // which the second one does not have
}

TEST_CASE("two views and two frames are compared", "[cli][compare]") {
    const Workshop w;
    const json views = w.json(Words{"compare", "tents:3", "tents:3"} + kView + Words{"--view-b", "120,-20"});
    CHECK(views["delta_e"]["mean"].get<double>() > 0.1);
    CHECK(views["features"][0]["a"]["opacity"] == views["features"][0]["b"]["opacity"]);
    CHECK(views["features"][0]["a"]["vws"] != views["features"][0]["b"]["vws"]);
    const json frames = w.json({"compare", "tents:3", "tents:3", "sample:vortex", "--sample-size", "16", "--size",
                                "32x32", "--engine", "cpu", "--frame-b", "40"});
    CHECK(frames["ssim"].get<double>() < 1);
    CHECK(w.json(Words{"compare", "tents:3", "tents:3"} + kView)["ssim"] == 1);
}

TEST_CASE("a session is compared with the state that it keeps", "[cli][compare]") {
    const Workshop w;
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 24;
    Session session = sessionOf(source);
    session.setTf(tents(3, 0.8));
    ComparisonView view;
    view.b = comparedState(session, "pinned");
    session.setTf(tents(3, 0.1));
    const Words command{"compare", "s.pellucid.json", "--size", "64x48", "--engine", "cpu"};
    writeSession(session, w.path("s.pellucid.json").string());
    CHECK(w.run(command).err.find("keeps nothing to compare with") != std::string::npos);
    session.comparison = view;
    writeSession(session, w.path("s.pellucid.json").string());
    const json kept = w.json(command);
    CHECK(kept["b"] == "pinned");
    const json named = w.json(Words{"compare", "tents:3:0.1", "tents:3:0.8"} + kView);
    CHECK(kept["features"] == named["features"]);
    CHECK(kept["ssim"] == named["ssim"]);
}

TEST_CASE("what cannot be compared is said", "[cli][compare]") {
    const Workshop w;
    writeImage(half(0, 0), w.path("a.png").string());
    writeImage(Image(8, 8), w.path("small.png").string());
    const auto refused = [&](const Words& words, int status, const std::string& why) {
        const Outcome r = w.run(Words{"compare"} + words);
        CHECK(r.status == status);
        CHECK(r.err.find(why) != std::string::npos);
    };
    refused({"a.png", "small.png"}, 1, "differ in size");
    refused({"a.png", "tents:3"}, 2, "one is a picture");
    refused({"a.png", "a.png", "sample:shells"}, 2, "need no volume");
    refused({"a.png", "none.png"}, 1, "none.png");
    refused({"tents:3", "tents:2"}, 2, "VOLUME");
    refused({"a.png"}, 2, "B is missing");
    refused({"a.png", "a.png", "--difference", "a.png"}, 2, "a.png");
    refused({"a.png", "a.png", "--difference", "d.jpg"}, 2, ".exr or .png");
    refused({"a.png", "a.png", "--figures", "d.txt"}, 2, ".csv or .json");
}
