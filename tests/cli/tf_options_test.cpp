// --colormap, --density, --hide, --only: what is done to a transfer function before anything else.
#include <catch2/catch.hpp>

#include <cmath>

#include "cli_runner.h"

using nlohmann::json;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;
using pellucid::test::operator+;

namespace {

const Words kMeasureRamp{"measure", "sample:shells", "--size", "20", "--tf", "tents:3:0.1", "--engine", "cpu"};
const Words kRefineRamp{"refine", "sample:shells", "--size", "20", "--tf", "tents:3:0.1", "--max-iterations", "0"};

} // namespace

TEST_CASE("hidden features are not measured, and named ones alone are", "[cli][tf]") {
    const Workshop w;
    const json all = w.json(kMeasureRamp), hidden = w.json(kMeasureRamp + Words{"--hide", "f2"});
    CHECK(all["features"][1]["visibility"].get<double>() > 0.05);
    CHECK(hidden["features"][1]["visibility"] == 0.0);
    CHECK(hidden["features"][1]["name"] == "f2");
    CHECK(hidden["features"][0]["visibility"].get<double>() + hidden["features"][2]["visibility"].get<double>() ==
          Approx(1));
    const json only = w.json(kMeasureRamp + Words{"--only", "f1", "--only", "f3"});
    CHECK(only["features"] == hidden["features"]);
    CHECK(w.json(kMeasureRamp + Words{"--only", "f2"})["features"][1]["visibility"] == Approx(1));
}

TEST_CASE("pictures show what is not hidden", "[cli][tf]") {
    const Workshop w;
    const Words render{"render",      "sample:shells", "--sample-size", "16",           "--tf",
                       "tents:3:0.1", "--size",        "40x40",         "--no-metadata"};
    REQUIRE(w.run(render + Words{"--out", "all.png"}).status == 0);
    REQUIRE(w.run(render + Words{"--hide", "f1", "--out", "without.png"}).status == 0);
    REQUIRE(w.run(render + Words{"--only", "f2", "--only", "f3", "--out", "others.png"}).status == 0);
    REQUIRE(w.run(render + Words{"--density", "3", "--out", "dense.png"}).status == 0);
    CHECK(w.read("all.png") != w.read("without.png"));
    CHECK(w.read("without.png") == w.read("others.png"));
    CHECK(w.read("all.png") != w.read("dense.png"));
}

TEST_CASE("density and colour maps change the transfer function that comes out", "[cli][tf]") {
    const Workshop w;
    const json plain = w.json(kRefineRamp)["tf"], dense = w.json(kRefineRamp + Words{"--density", "2"})["tf"];
    // 1 − 0.9² = 0.19 at each peak.
    for (const std::size_t peak : {1u, 4u, 7u}) CHECK(dense["points"][peak]["opacity"].get<double>() == Approx(0.19));
    const json colored = w.json(kRefineRamp + Words{"--colormap", "categorical"})["tf"];
    REQUIRE(colored["points"].size() == plain["points"].size());
    for (std::size_t i = 0; i < plain["points"].size(); ++i) {
        CHECK(colored["points"][i]["opacity"] == plain["points"][i]["opacity"]);
        CHECK(colored["points"][i]["color"] == colored["features"][i / 3]["color"]);
        CHECK(colored["points"][i]["color"] != plain["points"][i]["color"]);
    }
    // Reversed over features, the first of grey has what the last had.
    const json grey = w.json(kRefineRamp + Words{"--colormap", "grey,features"})["tf"],
               reversed = w.json(kRefineRamp + Words{"--colormap", "grey,reverse,features"})["tf"];
    CHECK(grey["features"][0]["color"] == reversed["features"][2]["color"]);
    CHECK(grey["features"][1]["color"] == reversed["features"][1]["color"]);
}

TEST_CASE("a search leaves a hidden feature its opacity and aims it at nothing", "[cli][tf]") {
    const Workshop w;
    const json found =
        w.json({"optimize", "sample:shells", "--size", "16", "--tf", "tents:3:0.1", "--engine", "cpu", "--target",
                "0.5,0.3,0.2", "--hide", "f2", "--max-iterations", "4", "--out-tf", "found.tf.json"});
    for (const json& vws : found["vws"]) CHECK(vws[1] == 0.0);
    CHECK(found["target"][1] == 0.0);
    CHECK(found["target"][0].get<double>() == Approx(0.5 / 0.7));
    CHECK(found["iterations"].get<int>() > 0);
    const json tf = json::parse(w.read("found.tf.json"));
    CHECK(tf["features"][1]["hidden"] == true);
    CHECK(tf["points"][4]["opacity"].get<double>() == 0.1); // its peak
    CHECK(tf["points"][1]["opacity"].get<double>() != 0.1);
}

TEST_CASE("names that are not there are said, with those that are", "[cli][tf]") {
    const Workshop w;
    const auto fails = [&](const Words& words, const std::string& part, const std::string& known) {
        const Outcome o = w.run(kMeasureRamp + words);
        CHECK(o.status == 2);
        CHECK(o.out.empty());
        CHECK_THAT(o.err, Catch::Contains(part) && Catch::Contains(known));
    };
    fails({"--hide", "skin"}, "no feature is named 'skin', --hide", "known: 'f1', 'f2', 'f3'");
    fails({"--only", "skin"}, "no feature is named 'skin', --only", "known: 'f1', 'f2', 'f3'");
    fails({"--colormap", "jet"}, "there is no colour map 'jet', --colormap", "hue, spiral, ember, sand");
    fails({"--colormap", "grey,upside-down"}, "'upside-down'", "reverse, invert or features");
    fails({"--density", "0"}, "--density", "0.001");
}
