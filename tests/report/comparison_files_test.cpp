// The files of a comparison.
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "report/comparison_files.h"

using namespace pellucid;

namespace {

Comparison example() {
    Comparison c;
    c.a = "now";
    c.b = "preset:bone";
    c.imageA = c.imageB = Image(4, 3);
    c.difference = {{}, 0.5, 1.25, 40, 0.25};
    c.features = {{"skin, fat", FeatureFigures{"skin, fat", {}, false, 0.75, 0.5, 0.1, 0.6},
                   FeatureFigures{"skin, fat", {}, false, 0.5, 0.25, 0.2, 0.4}},
                  {"bone", {}, FeatureFigures{"bone", {}, false, 0.5, 0.75, 1, {}}}};
    return c;
}

} // namespace

TEST_CASE("figures as a table have a line each, with the difference", "[comparison_files]") {
    CHECK(csvOf(example()) == "feature,figure,a,b,difference\n"
                              "\"skin, fat\",vws,0.75,0.5,-0.25\n"
                              "\"skin, fat\",visibility,0.5,0.25,-0.25\n"
                              "\"skin, fat\",fs,0.6,0.4,-0.19999999999999996\n"
                              "\"skin, fat\",opacity,0.1,0.2,0.1\n"
                              "bone,vws,,0.5,\n"
                              "bone,visibility,,0.75,\n"
                              "bone,opacity,,1,\n"
                              ",ssim,,,0.5\n"
                              ",delta_e_mean,,,1.25\n"
                              ",delta_e_largest,,,40\n"
                              ",delta_e_noticed,,,0.25\n");
}

TEST_CASE("figures as JSON leave out what is missing", "[comparison_files]") {
    const nlohmann::ordered_json j = jsonOf(example());
    CHECK(j["a"] == "now");
    CHECK(j["size"] == nlohmann::ordered_json{4, 3});
    CHECK(j["delta_e"]["largest"] == 40);
    CHECK_FALSE(j["features"][1].contains("a"));
    CHECK(j["features"][1]["b"]["vws"] == 0.5);
    CHECK_FALSE(j["features"][1]["b"].contains("fs"));
    CHECK_THROWS_AS(checkFiguresSuffix("figures.txt"), UsageError);
}
