// *.vp.json, volume properties of 3D Slicer since 5.9: the schema v1.0.0, with unit distances, midpoints and sharpness.
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_value.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/slicer_property.h"

namespace pellucid {

using nlohmann::json;

namespace {

constexpr const char* kSchema = "https://raw.githubusercontent.com/slicer/slicer/main/Modules/Loadable/VolumeRendering/"
                                "Resources/Schema/volume-property-schema-v1.0.0.json#";

bool knowsProperty(const ForeignFile& file) {
    return file.isJson() && file.json().is_object() && file.json().contains("volumeProperties");
}

CurveShape shapeOf(const JsonValue& point) {
    return {point.has("midpoint") ? point["midpoint"].number(0, 1) : 0.5,
            point.has("sharpness") ? point["sharpness"].number(0, 1) : 0};
}

Rgb colorOf(const JsonValue& point) {
    const std::vector<JsonValue> parts = point["color"].items(3);
    return {parts[0].number(), parts[1].number(), parts[2].number()};
}

TfCurves curvesOf(const JsonValue& component) {
    TfCurves curves;
    if (component.has("scalarOpacity"))
        for (const JsonValue& p : component["scalarOpacity"]["points"].items())
            curves.opacities.push_back({p["x"].number(), p["y"].number(), shapeOf(p)});
    if (component.has("rgbTransferFunction"))
        for (const JsonValue& p : component["rgbTransferFunction"]["points"].items())
            curves.colors.push_back({p["x"].number(), colorOf(p), shapeOf(p)});
    return curves;
}

SlicerLook lookOf(const JsonValue& property, const JsonValue& component) {
    SlicerLook look;
    if (property.has("interpolationType"))
        look.interpolation = property["interpolationType"].text() == "nearest" ? 0 : 1;
    if (component.has("shade")) look.shade = component["shade"].boolean();
    if (component.has("lighting")) {
        const JsonValue lighting = component["lighting"];
        const auto read = [&](const char* key, double& value) {
            if (lighting.has(key)) value = lighting[key].number();
        };
        read("ambient", look.ambient);
        read("diffuse", look.diffuse);
        read("specular", look.specular);
        read("specularPower", look.specularPower);
    }
    if (component.has("gradientOpacity"))
        for (const JsonValue& p : component["gradientOpacity"]["points"].items())
            look.gradient.push_back({p["x"].number(), p["y"].number()});
    return look;
}

json parsedOrEmpty(const std::string& text) { return text.empty() ? json::object() : json::parse(text); }

ReadTf readProperty(const ForeignFile& file) {
    const JsonValue document(file.json(), file.path());
    const std::vector<JsonValue> properties = document["volumeProperties"].items();
    if (properties.empty()) document.fail("there is no volume property in it");
    const JsonValue& property = properties.front();
    const std::vector<JsonValue> components = property["components"].items();
    if (components.empty()) property.fail("there is no component in it");
    const JsonValue& component = components.front();
    ReadTf read = tfOfCurves(curvesOf(component), {}, file.path());
    read.length = kMillimetre;
    if (component.has("scalarOpacityUnitDistance"))
        read.length.value = component["scalarOpacityUnitDistance"].number(1e-30, 1e30);
    if (properties.size() > 1)
        read.notices.push_back("the first of " + std::to_string(properties.size()) + " volume properties is taken");
    if (components.size() > 1)
        read.notices.push_back("the first of " + std::to_string(components.size()) + " components is taken");
    const json others = {
        {"property", parsedOrEmpty(property.unknownKeys({"effectiveRange", "components", "interpolationType"}))},
        {"component",
         parsedOrEmpty(component.unknownKeys({"shade", "lighting", "scalarOpacityUnitDistance", "rgbTransferFunction",
                                              "scalarOpacity", "gradientOpacity"}))}};
    keepLook(read, lookOf(property, component), others);
    return read;
}

json shaped(json point) {
    point["midpoint"] = 0.5;
    point["sharpness"] = 0.0;
    return point;
}

json functionOf(const char* type, json points) { return {{"type", type}, {"points", std::move(points)}}; }

json componentOf(const std::vector<ControlPoint>& points, const TfToWrite& tf, const SlicerLook& look) {
    json colors = json::array(), opacities = json::array(), gradient = json::array();
    for (const ControlPoint& p : points) {
        colors.push_back(shaped({{"x", tf.value(p.x)}, {"color", {p.color.r, p.color.g, p.color.b}}}));
        opacities.push_back(shaped({{"x", tf.value(p.x)}, {"y", p.opacity}}));
    }
    for (const auto& [x, y] : look.gradient) gradient.push_back(shaped({{"x", x}, {"y", y}}));
    if (look.gradient.empty()) gradient = {shaped({{"x", 0.0}, {"y", 1.0}}), shaped({{"x", 255.0}, {"y", 1.0}})};
    return {{"componentWeight", 1.0},
            {"shade", look.shade},
            {"lighting",
             {{"ambient", look.ambient},
              {"diffuse", look.diffuse},
              {"specular", look.specular},
              {"specularPower", look.specularPower}}},
            {"disableGradientOpacity", !look.gradientMatters()},
            {"scalarOpacityUnitDistance", tf.geometry().d0()},
            {"rgbTransferFunction", functionOf("colorTransferFunction", std::move(colors))},
            {"scalarOpacity", functionOf("piecewiseLinearFunction", std::move(opacities))},
            {"gradientOpacity", functionOf("piecewiseLinearFunction", std::move(gradient))}};
}

/// What was kept of a file goes before the usual, but not before what the transfer function says itself.
void update(json& object, const json& kept, const char* key, std::initializer_list<const char*> own) {
    if (!kept.contains(key) || !kept[key].is_object()) return;
    json more = kept[key];
    for (const char* name : own) more.erase(name);
    object.update(more);
}

WrittenTf writeProperty(const TfToWrite& tf) {
    const std::vector<ControlPoint> points = tf.pointsApart({}); // its unit distance is d0
    const SlicerLook look = keptLook(tf);
    const json others = keptOthers(tf);
    json component = componentOf(points, tf, look);
    update(component, others, "component", {"rgbTransferFunction", "scalarOpacity", "gradientOpacity"});
    json property = {{"effectiveRange", {tf.range().lo, tf.range().hi}},
                     {"isoSurfaceValues", json::array()},
                     {"independentComponents", true},
                     {"interpolationType", look.interpolation == 0 ? "nearest" : "linear"},
                     {"useClippedVoxelIntensity", false},
                     {"clippedVoxelIntensity", -1e10},
                     {"scatteringAnisotropy", 0.0},
                     {"components", json::array({std::move(component)})}};
    update(property, others, "property", {"components", "effectiveRange"});
    WrittenTf written;
    addVtkLosses(written.losses, points);
    written.text = json{{"@schema", kSchema}, {"volumeProperties", json::array({std::move(property)})}}.dump(
                       2, ' ', false, json::error_handler_t::replace) +
                   "\n";
    return written;
}

} // namespace

TfFormat slicerFormat() {
    return {"slicer",
            "3D Slicer volume property",
            "a volume property of 3D Slicer",
            ".vp.json",
            true,
            "features",
            &knowsProperty,
            &readProperty,
            &writeProperty};
}

} // namespace pellucid
