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
    const auto json = w.json(render + kRain + Words{"--hsb", "saturation=volatility:x:5,brightness=y,hue=120,b=2.5"});
    CHECK(json["hsb"]["alpha"] == "x");
    CHECK(json["hsb"]["saturation"] == "volatility:x:5");
    CHECK(json["hsb"]["brightness"] == "y");
    CHECK(json["hsb"]["hue"] == 120);
    CHECK(json["hsb"]["a"].get<double>() > 1); // by the data: deviations are below ½
    CHECK(json["hsb"]["b"] == 2.5);
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
    const auto json =
        w.json(Words{"refine"} + Words{"sample:hurricane", "--sample-size", "32", "--frame", "12"} + kRain +
               Words{"--hsb", "saturation=volatility:x:5,brightness=y", "--region", "20,20,60,60", "--size", "80x80",
                     "--tf", "tents:3:0.5"});
    CHECK(json["hsb"]["brightness"] == "y");
    CHECK(json["priority"]["kind"] == "region");
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
}

TEST_CASE("samples over time are written frame by frame", "[cli][generate]") {
    const Workshop w;
    const auto json = w.json({"generate", "vortex", "--size", "16", "--frames", "3", "--out", "v%02d.nrrd"});
    CHECK(json["files"].size() == 3);
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
