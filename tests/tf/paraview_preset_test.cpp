// What ParaView imports: a list of presets with points in data units.
#include <catch2/catch.hpp>

#include <fstream>

#include <nlohmann/json.hpp>

#include "support/temp_folder.h"
#include "tf/edit.h"
#include "tf/formats/paraview_preset.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/tf_json.h"
#include "tf/shapes.h"

using namespace pellucid;
using nlohmann::json;

namespace {

/// Opacity or a colour by straight lines between points of `each` numbers, of which the first is the value.
double between(const json& points, std::size_t each, std::size_t number, double value) {
    for (std::size_t i = 0; i + each < points.size(); i += each) {
        const double a = points[i].get<double>(), b = points[i + each].get<double>();
        if (value < a || value > b) continue;
        const double t = (value - a) / (b - a), at = points[i + number].get<double>();
        return at + t * (points[i + each + number].get<double>() - at);
    }
    return -1;
}

TransferFunction withSteps() {
    TransferFunction tf = tents(3, 0.4);
    tf.points = {{0, 0.1, {1, 0, 0}, false, {}},    {0.25, 0.1, {1, 0, 0}, false, {}},
                 {0.25, 0.6, {0, 1, 0}, false, {}}, {0.75, 0.6, {0, 1, 0}, false, {}},
                 {1, 0.2, {0, 0, 1}, false, {}},    {1, 0.9, {0, 0, 1}, false, {}}};
    return tf;
}

} // namespace

TEST_CASE("a preset for ParaView draws what the transfer function says, in data units", "[paraview]") {
    const ValueRange window{-1000, 3000};
    for (const TransferFunction& tf : {tents(3, 0.4), withSteps()}) {
        const json presets = paraViewPreset(tf, window, "mine");
        REQUIRE(presets.size() == 1);
        const json& preset = presets[0];
        CHECK(preset["Name"] == "mine");
        CHECK(preset["ColorSpace"] == "RGB");
        const json &colors = preset["RGBPoints"], &points = preset["Points"];
        CHECK(colors[0] == -1000.0);
        CHECK(colors[colors.size() - 4] == 3000.0);
        REQUIRE(points.size() == colors.size());
        for (std::size_t i = 4; i < points.size(); i += 4) {
            CHECK(points[i].get<double>() > points[i - 4].get<double>()); // ParaView keeps one point for each x
            CHECK(points[i + 2] == 0.5);
            CHECK(points[i + 3] == 0.0);
        }
        for (const double s : {0.05, 0.2, 0.3, 0.5, 0.66, 0.8, 0.95}) {
            INFO(s);
            const double value = window.lo + s * (window.hi - window.lo);
            CHECK(between(points, 4, 1, value) == Approx(tf.opacity(s)).margin(1e-4));
            CHECK(between(colors, 4, 2, value) == Approx(tf.color(s).g).margin(1e-4));
        }
    }
}

TEST_CASE("steps at both ends keep their order in the preset, and its ends their values", "[paraview]") {
    TransferFunction tf = tents(1, 0.4);
    tf.points.clear();
    for (const double x : {0.0, 0.0, 0.5, 1.0, 1.0, 1.0}) tf.points.push_back({x, 0.1, {1, 1, 1}, false, {}});
    tf.points.back().opacity = 0.7;
    const json presets = paraViewPreset(tf, {0, 10}, "mine");
    const json& points = presets[0]["Points"];
    REQUIRE(points.size() == 6 * 4);
    CHECK(points[0] == 0.0);
    CHECK(points[20] == 10.0);
    CHECK(points[21] == 0.7);
    for (std::size_t i = 4; i < points.size(); i += 4) CHECK(points[i].get<double>() > points[i - 4].get<double>());
}

TEST_CASE("what an eye hides is transparent in the preset", "[paraview]") {
    const TransferFunction tf = withFeatureHidden(tents(3, 0.4), 1, true);
    const json presets = paraViewPreset(tf, {0, 1}, "mine");
    CHECK(between(presets[0]["Points"], 4, 1, 0.5) == Approx(0).margin(1e-6));
    CHECK(between(presets[0]["Points"], 4, 1, 1.0 / 6) == Approx(0.4).margin(1e-4));
}

TEST_CASE("the suffix says for whom a transfer function is written", "[paraview]") {
    const test::TempFolder folder;
    const std::string preset = folder.path("skull.paraview.json"), own = folder.path("skull.tf.json");
    writeTfFile({tents(2), ValueRange{0, 10}, {}, "skull"}, preset);
    writeTfFile({tents(2), ValueRange{0, 10}, {}, "skull"}, own);
    json read;
    std::ifstream(preset) >> read;
    CHECK(read[0]["Name"] == "skull");
    CHECK(readTf(own) == tents(2));
    CHECK(isWrittenForOthers(preset));
    CHECK(!isWrittenForOthers(own));
}
