// presets.xml, the presets that 3D Slicer offers: volume properties in a scene.
#include <algorithm>

#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/preset_choice.h"
#include "tf/formats/slicer_property.h"
#include "tf/formats/xml_document.h"

namespace pellucid {

namespace {

constexpr const char* kProperty = "VolumeProperty";

std::vector<XmlElement> propertiesIn(const ForeignFile& file) {
    std::vector<XmlElement> properties;
    const XmlElement root = file.xml().root();
    if (std::string_view(root.name()) == kProperty) properties.push_back(root);
    for (const XmlElement e : root.children(kProperty)) properties.push_back(e);
    return properties;
}

bool knowsPresets(const ForeignFile& file) { return file.isXml() && !propertiesIn(file).empty(); }

std::vector<std::string> namesIn(const ForeignFile& file) {
    std::vector<std::string> names;
    for (const XmlElement& e : propertiesIn(file)) names.emplace_back(e.attribute("name").value());
    return distinctNames(std::move(names));
}

SlicerLook lookOf(const XmlDocument& xml, const XmlElement& e, const std::string& where) {
    SlicerLook look;
    look.interpolation = xml.numberOr(e, "interpolation", 1) == 0 ? 0 : 1;
    look.shade = xml.numberOr(e, "shade", 0) != 0;
    look.ambient = xml.numberOr(e, "ambient", look.ambient);
    look.diffuse = xml.numberOr(e, "diffuse", look.diffuse);
    look.specular = xml.numberOr(e, "specular", look.specular);
    look.specularPower = xml.numberOr(e, "specularPower", look.specularPower);
    look.gradient = gradientOf(e.attribute("gradientOpacity").value(), where);
    return look;
}

ReadTf readPresets(const ForeignFile& file) {
    const std::vector<XmlElement> properties = propertiesIn(file);
    if (properties.empty())
        throw FileError("there is no volume property in it", file.path(), "give presets of 3D Slicer");
    const std::vector<std::string> names = namesIn(file);
    std::vector<std::string> notices;
    const std::size_t which = presetNamed(names, file, notices);
    const XmlElement e = properties[which];
    const std::string where = file.path() + ", preset " + inQuotes(names[which]);
    // The range that Slicer shows at first is no part of the curves, and one of its own presets has no numbers there.
    ReadTf read = tfOfCurves(
        slicerCurves(e.attribute("scalarOpacity").value(), e.attribute("colorTransfer").value(), where), {}, where);
    read.length = {OpacityLength::Kind::World, 1};
    if (file.xml().has(e, "scalarOpacityUnitDistance"))
        read.length.value = file.xml().number(e, "scalarOpacityUnitDistance", 1e-30, 1e30);
    read.notices.insert(read.notices.begin(), notices.begin(), notices.end());
    keepLook(read, lookOf(file.xml(), e, where));
    return read;
}

WrittenTf writePresets(const TfToWrite& tf) {
    const std::vector<ControlPoint> points = tf.pointsApart(kMillimetre);
    const SlicerLook look = keptLook(tf);
    const auto attribute = [](const char* name, const std::string& value) {
        return std::string(" ") + name + "=\"" + xmlEscaped(value) + "\"";
    };
    WrittenTf written;
    written.text =
        "<MRML>\n <VolumeProperty" + attribute("id", "vtkMRMLVolumePropertyNode1") + attribute("name", tf.name()) +
        attribute("references", "") + attribute("interpolation", std::to_string(look.interpolation)) +
        attribute("shade", look.shade ? "1" : "0") + attribute("diffuse", exactText(look.diffuse)) +
        attribute("ambient", exactText(look.ambient)) + attribute("specular", exactText(look.specular)) +
        attribute("specularPower", exactText(look.specularPower)) +
        attribute("scalarOpacity", slicerOpacities(points, tf)) + attribute("gradientOpacity", slicerGradient(look)) +
        attribute("colorTransfer", slicerColors(points, tf)) +
        attribute("effectiveRange", exactText(tf.range().lo) + " " + exactText(tf.range().hi)) + "/>\n</MRML>\n";
    addVtkLosses(written.losses, points);
    return written;
}

} // namespace

TfFormat slicerXmlFormat() {
    return {"slicer-xml",
            "3D Slicer presets",
            "presets of 3D Slicer",
            ".xml",
            false,
            "features, unit distance (opacities are for 1 mm)",
            &knowsPresets,
            &readPresets,
            &writePresets,
            &namesIn};
}

} // namespace pellucid
