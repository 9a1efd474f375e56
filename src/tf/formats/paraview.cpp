// Presets of ParaView: JSON lists of colour maps, with opacities where somebody asked for them.
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_value.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/paraview_preset.h"
#include "tf/formats/preset_choice.h"
#include "tf/formats/read_curves.h"
#include "tf/formats/tf_format.h"

namespace pellucid {

using nlohmann::json;

namespace {

constexpr const char* kUnitKey = "ScalarOpacityUnitDistance"; ///< ours: ParaView passes over what it does not know
constexpr OpacityLength kDefaultLength{OpacityLength::Kind::ParaView, 1};

bool isPreset(const json& j) { return j.is_object() && (j.contains("RGBPoints") || j.contains("IndexedColors")); }

bool knowsPreset(const ForeignFile& file) {
    if (!file.isJson()) return false;
    const json& j = file.json();
    return isPreset(j) || (j.is_array() && !j.empty() && isPreset(j[0]));
}

ColorSpace spaceOf(const JsonValue& preset) {
    if (!preset.has("ColorSpace")) return ColorSpace::Rgb;
    const std::string space = lowerCase(preset["ColorSpace"].text());
    if (const auto known = paraViewSpace(space)) return *known;
    if (space == "labciede2000") return ColorSpace::Ciede2000;
    if (space == "prolab") return ColorSpace::ProLab;
    if (space != "hsv")
        preset["ColorSpace"].fail("there is no colour space " + inQuotes(preset["ColorSpace"].text()),
                                  "use RGB, HSV, Lab, Diverging, Step, LabCIEDE2000 or ProLab");
    const bool wraps = preset.has("HSVWrap") && preset["HSVWrap"].json() != 0 && preset["HSVWrap"].json() != false;
    return wraps ? ColorSpace::HsvWrapped : ColorSpace::Hsv;
}

/// Numbers by fours.
std::vector<std::array<double, 4>> foursOf(const JsonValue& list) {
    const std::vector<double> numbers = list.numbers();
    if (numbers.size() % 4 != 0) list.fail("the number of values is no multiple of 4");
    std::vector<std::array<double, 4>> fours;
    for (std::size_t i = 0; i < numbers.size(); i += 4)
        fours.push_back({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]});
    return fours;
}

CurveShape shapeOf(const JsonValue& list, double midpoint, double sharpness) {
    const auto isPart = [](double v) { return v >= 0 && v <= 1; };
    if (!isPart(midpoint) || !isPart(sharpness)) list.fail("a midpoint or sharpness is not between 0 and 1");
    return {midpoint, sharpness};
}

TfCurves curvesOf(const JsonValue& preset) {
    TfCurves curves;
    curves.space = spaceOf(preset);
    for (const auto& [x, r, g, b] : foursOf(preset["RGBPoints"])) curves.colors.push_back({x, {r, g, b}, {}});
    if (preset.has("Points"))
        for (const auto& [x, opacity, midpoint, sharpness] : foursOf(preset["Points"]))
            curves.opacities.push_back({x, opacity, shapeOf(preset["Points"], midpoint, sharpness)});
    const json scale = preset.json().value("UseLogScale", json(0));
    curves.isLogarithmic = scale != 0 && scale != false;
    curves.sort();
    curves.keepLastOfEach();
    return curves;
}

std::vector<std::string> namesIn(const ForeignFile& file) { return presetNames(file, isPreset); }

ReadTf readPreset(const ForeignFile& file) {
    const PresetChoice choice = presetOf(file, isPreset);
    const JsonValue& preset = choice.preset;
    if (!preset.has("RGBPoints"))
        preset.fail("its colours are of categories, not of a range of values",
                    "give a preset with RGBPoints, or name labels by --classes");
    const TfCurves curves = curvesOf(preset);
    const std::optional<ValueRange> positions = paraViewPositions(curves);
    ReadTf read = tfOfCurves(curves, positions, file.path());
    read.positions = positions;
    read.length = kDefaultLength;
    if (preset.has(kUnitKey)) read.length = {OpacityLength::Kind::World, preset[kUnitKey].number(1e-30, 1e30)};
    read.notices.insert(read.notices.begin(), choice.notices.begin(), choice.notices.end());
    keepAs(read.tf, "paraview",
           preset.unknownKeys({"Name", "ColorSpace", "HSVWrap", "RGBPoints", "Points", "UseLogScale", "Creator",
                               "NanColor", kUnitKey}));
    return read;
}

WrittenTf writePreset(const TfToWrite& tf) {
    const std::vector<ControlPoint> points = tf.pointsApart(kDefaultLength);
    json preset = presetOfPoints(points, tf.range(), tf.name());
    preset[kUnitKey] = kDefaultLength.inWorld(tf.geometry());
    if (const std::string kept = tf.keptOf("paraview"); !kept.empty()) addUnknownKeys(preset, kept);
    WrittenTf written;
    addVtkLosses(written.losses, points);
    written.text = json::array({preset}).dump(1, ' ', false, json::error_handler_t::replace) + "\n";
    return written;
}

} // namespace

std::optional<ColorSpace> paraViewSpace(const std::string& name) {
    if (name == "rgb") return ColorSpace::Rgb;
    if (name == "lab" || name == "cielab") return ColorSpace::Lab;
    if (name == "diverging") return ColorSpace::Diverging;
    if (name == "step") return ColorSpace::Step;
    return {};
}

std::optional<ValueRange> paraViewPositions(const TfCurves& curves) {
    const ValueRange range = curves.range();
    if (range == ValueRange{0, 1} || range == ValueRange{-1, 1}) return range;
    return {};
}

json presetOfPoints(const std::vector<ControlPoint>& points, const ValueRange& range, const std::string& name) {
    json colors = json::array(), opacities = json::array();
    for (const ControlPoint& p : points) {
        const double value = range.lo + p.x * (range.hi - range.lo);
        for (const double v : {value, p.color.r, p.color.g, p.color.b}) colors.push_back(v);
        for (const double v : {value, p.opacity, 0.5, 0.0}) opacities.push_back(v); // straight on to the next
    }
    return {{"Name", name},          {"Creator", "Pellucid"},          {"ColorSpace", "RGB"},
            {"NanColor", {0, 0, 0}}, {"RGBPoints", std::move(colors)}, {"Points", std::move(opacities)}};
}

json paraViewPreset(const TransferFunction& tf, const ValueRange& window, const std::string& name) {
    TransferFunction placed = tf;
    placed.range = window;
    const TfToWrite writing(placed, window, {}, name);
    return json::array({presetOfPoints(writing.pointsApart({}), window, name)});
}

TfFormat paraViewFormat() {
    return {"paraview",
            "ParaView preset",
            "a ParaView preset",
            kParaViewSuffix,
            true,
            "features; opacities hold for ParaView's default unit distance",
            &knowsPreset,
            &readPreset,
            &writePreset,
            &namesIn};
}

} // namespace pellucid
