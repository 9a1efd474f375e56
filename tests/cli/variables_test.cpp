// --variable and --hsb: several variables, and the colours that they drive.
#include <cmath>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"

using namespace pellucid;
using pellucid::test::operator+;
using Catch::Matchers::Contains;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kData{"sample:hurricane", "--sample-size", "32", "--frame", "12", "--engine", "cpu"};
const Words kRain{"--variable", "y=sample:hurricane/precipitation"};

} // namespace

TEST_CASE("render draws by the variables that it is told", "[cli][variables]") {
    const Workshop w;
    const Words render = Words{"render"} + kData + Words{"--size", "40x30", "--out", "a.png"};
    const auto answer = w.json(render + kRain + Words{"--hsb", "saturation=volatility:x:5,brightness=y,hue=120,b=2.5"});
    CHECK(answer["hsb"]["alpha"] == "x");
    CHECK(answer["hsb"]["saturation"] == "volatility:x:5");
    CHECK(answer["hsb"]["brightness"] == "y");
    CHECK(answer["hsb"]["hue"] == 120);
    CHECK(answer["hsb"]["a"].get<double>() > 1); // by the data: deviations are below ½
    CHECK(answer["hsb"]["b"] == 2.5);
    // Green or grey on black, never more red or blue than green.
    const Image image = readImage(w.path("a.png").string());
    double most = 0, strongest = 0;
    for (int i = 0; i < 40 * 30; ++i) {
        const float* p = image.pixel(i % 40, i / 40);
        CHECK(p[0] <= p[1] + 0.01f);
        CHECK(p[2] <= p[1] + 0.01f);
        most = std::max(most, static_cast<double>(p[1]));
        strongest = std::max(strongest, static_cast<double>(p[1] - p[0]));
    }
    CHECK(most > 0.3);
    CHECK(strongest > 0.1);

    // Colours are by the transfer function unless others are wanted; another variable may come first.
    CHECK_FALSE(w.json(render).contains("hsb"));
    CHECK(w.json(render + kRain + Words{"--hsb", "alpha=y,brightness=x"})["hsb"]["alpha"] == "y");
    const auto gradient = w.json(render + Words{"--variable", "g=gradient:x", "--hsb", "hue=x,brightness=g,hue-to=90"});
    CHECK(gradient["hsb"]["hue"] == "x");
    CHECK(gradient["hsb"]["hue_to"] == 90);
}

TEST_CASE("measures are of the colours that are drawn", "[cli][variables]") {
    const Workshop w;
    const Words measure = Words{"measure"} + kData + kRain + Words{"--tf", "tents:3:0.3"};
    const auto plain = w.json(measure);
    const auto drawn = w.json(measure + Words{"--hsb", "saturation=volatility:x:5,brightness=y"});
    CHECK(std::abs(plain["features"][0]["vws"].get<double>() - drawn["features"][0]["vws"].get<double>()) > 1e-3);
    CHECK(plain["features"][0]["visibility"] == drawn["features"][0]["visibility"]);
    CHECK(drawn["hsb"]["brightness"] == "y");
    // Without a transfer function opacity is the intensity itself, in three features.
    const auto ramp = w.json(Words{"measure"} + kData + kRain + Words{"--hsb", "brightness=y"});
    CHECK(ramp["features"].size() == 3);
    CHECK(ramp["features"][2]["name"] == "high");
    CHECK(ramp["features"][2]["vws"].get<double>() > 0);
}

TEST_CASE("a region is refined by the colours that are drawn", "[cli][variables]") {
    const Workshop w;
    const auto answer =
        w.json(Words{"refine"} + Words{"sample:hurricane", "--sample-size", "32", "--frame", "12"} + kRain +
               Words{"--hsb", "saturation=volatility:x:5,brightness=y", "--region", "20,20,60,60", "--size", "80x80",
                     "--tf", "tents:3:0.5"});
    CHECK(answer["hsb"]["brightness"] == "y");
    CHECK(answer["priority"]["kind"] == "region");
}

namespace {

constexpr int kSide = 6, kFrames = 4;

/// How far voxel i swings about 128: 0 … 120.
int swing(int i) { return 8 * (i * 7 % 16); }

/// Frames f0.raw … f3.raw of 6³ bytes: 128 + d in odd frames, 128 − d in even ones, d = swing(); one voxel is 0 and one
/// 255 in all. X is value/255, so that over 2 frames its deviation is d/255, but 0 in the first.
struct Swinging : Workshop {
    Swinging() {
        for (int f = 0; f < kFrames; ++f) {
            std::string bytes;
            for (int i = 0; i < kSide * kSide * kSide; ++i)
                bytes += static_cast<char>(i == 0 ? 0 : i == 1 ? 255 : 128 + (f % 2 == 1 ? 1 : -1) * swing(i));
            write("f" + std::to_string(f) + ".raw", bytes);
        }
        std::string floats;
        for (int i = 0; i < kSide * kSide * kSide; ++i) {
            const float deviation = i < 2 ? 0.0f : static_cast<float>(swing(i) / 255.0);
            floats.append(reinterpret_cast<const char*>(&deviation), sizeof deviation);
        }
        write("deviation.raw", floats);
    }
};

const Words kSwinging{"f%d.raw", "--raw", "6,6,6,u8", "--tf", "tents:3:0.3"};
const Words kDeviation{"deviation.raw", "--raw", "6,6,6,f32", "--tf", "tents:3:0.3"};
const Words kFeaturesOf{"--features-of", "volatility:2"};

void checkSame(const nlohmann::json& a, const nlohmann::json& b) {
    REQUIRE(a.size() == b.size());
    REQUIRE(a.size() == 3);
    for (std::size_t f = 0; f < a.size(); ++f)
        for (const char* figure : {"vws", "visibility", "vws_brightness", "vws_saturation", "opacity"})
            CHECK(a[f][figure].get<double>() == Approx(b[f][figure].get<double>()).margin(1e-5));
}

} // namespace

TEST_CASE("features of the volatility are those of the same values in a file", "[cli][variables]") {
    const Swinging w;
    const auto info = w.json(Words{"info", "f%d.raw", "--raw", "6,6,6,u8", "--frame", "2"} + kFeaturesOf);
    CHECK(info["data_range"][1].get<double>() == Approx(120 / 255.0).margin(1e-6));
    const auto file = w.json(Words{"measure"} + kDeviation);
    CHECK_FALSE(file.contains("features_of"));
    for (const char* frame : {"1", "2", "3"}) { // the same in all but the first
        const auto derived = w.json(Words{"measure"} + kSwinging + kFeaturesOf + Words{"--frame", frame});
        CHECK(derived["features_of"] == "volatility:x:2");
        // Intensity 0 and 1 are the least and the largest of all frames: 0 and 120/255.
        CHECK(derived["volume"]["range"][0] == 0.0);
        CHECK(derived["volume"]["range"][1].get<double>() == Approx(120 / 255.0).margin(1e-6));
        checkSame(derived["features"], file["features"]);
    }
    // With all zeros there is nothing of the upper features.
    const auto first = w.json(Words{"measure"} + kSwinging + kFeaturesOf + Words{"--frame", "0"});
    CHECK(first["features"][2]["visibility"] == 0.0);
    // A name, and what is written in full, say the same; of X itself figures are others.
    const Words atTwo = Words{"measure"} + kSwinging + Words{"--frame", "2"};
    const auto named = w.json(atTwo + Words{"--variable", "v=volatility:x:2", "--features-of", "v"});
    checkSame(named["features"], file["features"]);
    checkSame(w.json(atTwo + Words{"--features-of", "volatility:x:2"})["features"], file["features"]);
    CHECK(std::abs(w.json(atTwo)["features"][0]["vws"].get<double>() - file["features"][0]["vws"].get<double>()) >
          0.01);
    CHECK(w.json(atTwo + Words{"--features-of", "gradient"})["features_of"] == "gradient:x");
    CHECK(w.json(atTwo + Words{"--features-of", "difference:1"})["features_of"] == "difference:x:1");
    CHECK(w.json(atTwo + kFeaturesOf + Words{"--range", "0,0.25"})["volume"]["range"][1] == 0.25);
}

TEST_CASE("every search is of the features' variable", "[cli][variables]") {
    const Swinging w;
    const Words frame{"--frame", "2"};
    const auto refined = w.json(Words{"refine"} + kSwinging + kFeaturesOf + frame);
    CHECK(refined["features_of"] == "volatility:x:2");
    const auto plain = w.json(Words{"refine"} + kDeviation);
    for (const char* energy : {"energy_before", "energy_after"})
        CHECK(refined[energy].get<double>() == Approx(plain[energy].get<double>()).epsilon(1e-6));

    const Words target{"--target", "equal", "--exact-shares"};
    const auto optimized = w.json(Words{"optimize"} + kSwinging + kFeaturesOf + frame + target);
    const auto other = w.json(Words{"optimize"} + kDeviation + target);
    REQUIRE(optimized["objective"].size() > 1);
    CHECK(optimized["objective"].back().get<double>() == Approx(other["objective"].back().get<double>()).margin(1e-4));

    // A picture, and every frame of a series with its own volatility.
    const Words picture{"--size", "24x24"};
    w.json(Words{"render"} + kSwinging + kFeaturesOf + frame + picture + Words{"--out", "a.png"});
    w.json(Words{"render"} + kDeviation + picture + Words{"--out", "b.png"});
    const Image a = readImage(w.path("a.png").string()), b = readImage(w.path("b.png").string());
    double most = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        most = std::max(most, static_cast<double>(std::abs(a.rgba[i] - b.rgba[i])));
    CHECK(most < 2.5 / 255);
    const Outcome sequence = w.run(Words{"sequence"} + kSwinging + kFeaturesOf + picture +
                                   Words{"--mode", "static", "--out", "frames", "--json"});
    REQUIRE(sequence.status == 0);
    const auto frames = nlohmann::json::parse(sequence.out)["frames"];
    REQUIRE(frames.size() == kFrames);
    const auto file = w.json(Words{"measure"} + kDeviation);
    CHECK(frames[0]["visibility"][2] == 0.0);
    for (std::size_t f = 1; f < kFrames; ++f)
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(frames[f]["vws"][i].get<double>() == Approx(file["features"][i]["vws"].get<double>()).margin(1e-5));
}

TEST_CASE("a session's features stay those of its variable, whatever data is opened", "[cli][variables]") {
    const Swinging w;
    w.write("s.pellucid.json", R"({"format":"pellucid-session","version":1,"frame":2,"variables":[
        {"name":"motion","derived":"volatility:x:2","transfer_functions":[]},
        {"name":"x","source":{"path":"nowhere%d.raw","raw":{"dims":[6,6,6],"type":"u8","endian":"little","spacing":[1,1,1],"skip":0}},"transfer_functions":[]}]})");
    const auto of = w.json(Words{"measure"} + kSwinging + Words{"--session", "s.pellucid.json"});
    CHECK(of["features_of"] == "volatility:x:2");
    checkSame(of["features"], w.json(Words{"measure"} + kDeviation)["features"]);
    // Back to the data, by name.
    const auto back =
        w.json(Words{"measure"} + kSwinging + Words{"--session", "s.pellucid.json", "--features-of", "x"});
    CHECK_FALSE(back.contains("features_of"));
    checkSame(back["features"], w.json(Words{"measure"} + kSwinging + Words{"--frame", "2"})["features"]);
}

TEST_CASE("variables that cannot be are told with their option", "[cli][variables]") {
    const Workshop w;
    const auto fails = [&](const Words& options, const std::string& what) {
        const Outcome outcome = w.run(Words{"measure"} + kData + options);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Contains(what));
    };
    fails({"--variable", "rain.nrrd"}, "NAME=FILE");
    fails({"--variable", "x=sample:shells"}, "VOLUME's");
    fails({"--variable", "a:b=sample:shells"}, "colon");
    fails({"--variable", "g=gradient:z"}, "no variable 'z'");
    fails({"--hsb", "brightness=y"}, "no variable 'y'");
    fails({"--hsb", "darkness=x"}, "there is no channel 'darkness'");
    fails({"--hsb", "brightness"}, "sets nothing");
    fails({"--hsb", "a=-1"}, "--hsb");
    fails({"--hsb", "saturation=volatility:x:0"}, "out of range");
    fails({"--features-of", "y"}, "no variable 'y', --features-of");
    fails({"--features-of", "volatility:0"}, "out of range");
    fails({"--features-of", "gradient:z"}, "no variable 'z'");
    fails({"--features-of", "gradient", "--hsb", "alpha=x"}, "alpha= of --hsb");
}

TEST_CASE("samples over time are written frame by frame", "[cli][generate]") {
    const Workshop w;
    const auto answer = w.json({"generate", "vortex", "--size", "16", "--frames", "3", "--out", "v%02d.nrrd"});
    CHECK(answer["files"].size() == 3);
    CHECK(w.list() == std::vector<std::string>{"v00.nrrd", "v01.nrrd", "v02.nrrd"});
    CHECK_FALSE(w.read("v00.nrrd") == w.read("v01.nrrd"));
    CHECK(w.json({"info", "v%02d.nrrd"}).dump().find("v02") != std::string::npos);
    // Without a pattern numbers stand before the suffix.
    w.json({"generate", "smoke", "--size", "16", "--frames", "2", "--out", "s.nrrd"});
    CHECK(w.has("s_000.nrrd"));
    CHECK(w.has("s_001.nrrd"));
    CHECK(w.run({"generate", "vortex", "--size", "16", "--frames", "101", "--out", "t.nrrd"}).status == 2);
    CHECK(w.run({"generate", "shells", "--size", "16", "--frames", "2", "--out", "t.nrrd"}).status == 2);
}
