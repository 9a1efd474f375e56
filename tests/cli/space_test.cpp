// `space`: the parameter space of two or three features.
#include <sstream>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"
#include "volume/loader.h"

using nlohmann::json;
using pellucid::Image;
using pellucid::loadVolume;
using pellucid::readImage;
using pellucid::Volume;
using pellucid::VolumeSource;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kShells{"sample:shells", "--sample-size", "16", "--tf", "tents:3"};
const Words kSpace = Words{"space"} + kShells + Words{"--target", "1,3,6", "--samples", "5"};

std::vector<std::string> linesOf(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

std::vector<double> numbersOf(const std::string& line) {
    std::istringstream in(line);
    std::vector<double> numbers;
    for (std::string cell; std::getline(in, cell, ',');) numbers.push_back(std::stod(cell));
    return numbers;
}

Volume nrrd(const Workshop& w, const std::string& name) {
    VolumeSource source;
    source.path = w.path(name).string();
    return loadVolume(source);
}

bool isPlain(const Image& image) {
    for (std::size_t i = 4; i < image.rgba.size(); ++i)
        if (image.rgba[i] != image.rgba[i - 4]) return false;
    return true;
}

} // namespace

TEST_CASE("space samples three features and finds the least F", "[cli][space]") {
    const Workshop w;
    const json answer =
        w.json(kSpace + Words{"--csv", "s.csv", "--save", "F.nrrd", "--out", "F.png", "--size", "300x260"});
    CHECK(answer["command"] == "space");
    CHECK(answer["coarser_by"] == 1);
    CHECK(answer["evaluations"] == 125);
    REQUIRE(answer["axes"].size() == 3);
    CHECK(answer["axes"][2]["feature"] == "f3");
    CHECK(answer["axes"][0]["opacity"] == json({0.0, 0.25, 0.5, 0.75, 1.0}));
    CHECK(answer["others"].empty());
    CHECK(answer["target"] == json({0.1, 0.3, 0.6}));

    const auto lines = linesOf(w.read("s.csv"));
    REQUIRE(lines.size() == 126);
    double least = 1;
    std::vector<double> best;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const auto row = numbersOf(lines[i]); // three opacities, three W, F
        REQUIRE(row.size() == 7);
        if (row[6] < least) {
            least = row[6];
            best = row;
        }
    }
    CHECK(answer["minimum"]["objective"].get<double>() == Approx(least));
    CHECK(answer["objective_range"][0].get<double>() == Approx(least));
    for (std::size_t f = 0; f < 3; ++f) {
        CHECK(answer["minimum"]["opacity"][f].get<double>() == best[f]);
        CHECK(answer["minimum"]["vws"][f].get<double>() == Approx(best[3 + f]));
    }
    // The sample of all opacities ½ (2 + 5·2 + 25·2 = 62) is what `measure` says of tents of that height.
    const json measured = w.json(Words{"measure"} + kShells);
    const auto middle = numbersOf(lines[63]);
    CHECK(middle[0] == 0.5);
    for (std::size_t f = 0; f < 3; ++f)
        CHECK(middle[3 + f] == Approx(measured["features"][f]["vws"].get<double>()).margin(1e-4));

    const Volume saved = nrrd(w, "F.nrrd");
    CHECK(saved.dims() == pellucid::Int3(5, 5, 5));
    CHECK(saved.value(62) == Approx(middle[6]));
    CHECK(saved.dataRange().lo == Approx(least));
    const Image picture = readImage(w.path("F.png").string());
    CHECK(picture.width == 300);
    CHECK(picture.height == 260);
    CHECK_FALSE(isPlain(picture));
}

TEST_CASE("space shows two features as a heat map, the others keep their opacities", "[cli][space]") {
    const Workshop w;
    const Words two = kSpace + Words{"--features", "f3,f1", "--out", "map.png", "--csv", "s.csv"};
    const json answer = w.json(two);
    CHECK(answer["evaluations"] == 25);
    REQUIRE(answer["axes"].size() == 2);
    CHECK(answer["axes"][0]["feature"] == "f3");
    CHECK(answer["others"] == json({{"f2", 0.5}}));
    CHECK(answer["minimum"]["opacity"][1] == 0.5);
    CHECK(linesOf(w.read("s.csv")).size() == 26);
    const std::string map = w.read("map.png");
    CHECK_FALSE(isPlain(readImage(w.path("map.png").string())));
    w.json(two + Words{"--show", "f2"});
    CHECK(w.read("map.png") != map);
    const json log = w.json(kSpace + Words{"--features", "f1,f2", "--scale", "log:0.01"});
    CHECK(log["axes"][0]["scale"] == "log");
    CHECK(log["axes"][0]["opacity"][0].get<double>() == Approx(0.01));
    CHECK(log["axes"][0]["opacity"][2].get<double>() == Approx(0.1)); // the middle of 0.01 … 1 in equal factors
}

TEST_CASE("space draws the paths of methods", "[cli][space]") {
    const Workshop w;
    w.json(kSpace + Words{"--out", "bare.png"});
    const json answer = w.json(kSpace + Words{"--out", "paths.png", "--paths", "parallel,fixed"});
    REQUIRE(answer["paths"].size() == 2);
    CHECK(answer["paths"][0]["method"] == "parallel");
    CHECK(answer["paths"][1]["method"] == "fixed");
    const json alone =
        w.json(Words{"optimize"} + kShells + Words{"--target", "1,3,6", "--method", "parallel", "--exact-shares"});
    CHECK(answer["paths"][0]["objective"] == alone["objective"]);
    CHECK(answer["paths"][0]["opacity"] == alone["opacity"]);
    CHECK(w.read("paths.png") != w.read("bare.png"));
}

TEST_CASE("space samples a coarser copy where it is told to", "[cli][space]") {
    const Workshop w;
    const Words large{"space",   "sample:shells", "--sample-size", "32",        "--tf",
                      "tents:3", "--target",      "1,1,1",         "--samples", "3"};
    const json full = w.json(large + Words{"--reduce", "1", "--csv", "full.csv"});
    const json half = w.json(large + Words{"--reduce", "2", "--csv", "half.csv"});
    CHECK(half["coarser_by"] == 2);
    CHECK(half["volume"] == full["volume"]); // what was asked about
    const auto a = linesOf(w.read("full.csv")), b = linesOf(w.read("half.csv"));
    REQUIRE(a.size() == b.size());
    CHECK(a != b);
    // The lengths of opacity and saliency stay, so that W moves by no more than the coarser data do.
    for (std::size_t i = 1; i < a.size(); ++i)
        for (std::size_t f = 3; f < 6; ++f) CHECK(numbersOf(a[i])[f] == Approx(numbersOf(b[i])[f]).margin(0.1));
}

TEST_CASE("space refuses what it cannot do", "[cli][space]") {
    const Workshop w;
    const auto refused = [&](const Words& options, const std::string& part) {
        const Outcome outcome = w.run(Words{"space"} + kShells + options);
        INFO(outcome.err);
        CHECK(outcome.status == 2);
        CHECK(outcome.out.empty());
        CHECK(outcome.err.find(part) != std::string::npos);
    };
    refused({}, "--target is required");
    const Words target{"--target", "1,3,6"};
    refused({"--target", "1,3"}, "2 targets for 3 features");
    refused(target + Words{"--features", "f1"}, "two features or three");
    refused(target + Words{"--features", "f1,f9"}, "known: 'f1', 'f2', 'f3'");
    refused(target + Words{"--features", "f1,f1"}, "a feature is chosen for two axes");
    refused(target + Words{"--samples", "65"}, "--samples");
    refused(target + Words{"--scale", "cubic"}, "give linear or log");
    refused(target + Words{"--scale", "linear:0.1"}, "--scale");
    refused(target + Words{"--show", "f9"}, "--show");
    refused(target + Words{"--paths", "shortcut"}, "--paths");
    refused(target + Words{"--paths", "runs"}, "runs come from a session");
    refused(target + Words{"--space-view", "0,100"}, "elevation from -90 to 90");
    refused(target + Words{"--reduce", "0"}, "--reduce");
    refused(target + Words{"--out", "F.xyz"}, "F.xyz");
    CHECK(w.list().empty());
}
