// Colour maps of ITK-SNAP: a registry in XML with control points over 0 to 1.
#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/read_curves.h"
#include "tf/formats/tf_format.h"
#include "tf/formats/xml_document.h"

namespace pellucid {

namespace {

XmlElement folderIn(const XmlElement& parent, const std::string& key) {
    return parent.find_child_by_attribute("folder", "key", key.c_str());
}
XmlElement entryIn(const XmlElement& parent, const char* key) {
    return parent.find_child_by_attribute("entry", "key", key);
}

/// What holds the control points: the root, or a folder inside it.
XmlElement mapIn(const XmlElement& parent, int depth = 4) {
    if (entryIn(parent, "NumberOfControlPoints")) return parent;
    if (depth == 0) return {};
    for (const XmlElement folder : parent.children("folder"))
        if (const XmlElement map = mapIn(folder, depth - 1)) return map;
    return {};
}

bool knowsMap(const ForeignFile& file) {
    if (!file.isXml()) return false;
    const XmlElement root = file.xml().root();
    return std::string_view(root.name()) == "registry" && (mapIn(root) || entryIn(root, "Preset"));
}

double valueOf(const XmlDocument& xml, const XmlElement& folder, const char* key, double lo, double hi) {
    const XmlElement entry = entryIn(folder, key);
    if (!entry) xml.fail(std::string("there is no ") + key + " in it", folder);
    return xml.number(entry, "value", lo, hi);
}

void addSide(const XmlDocument& xml, const XmlElement& point, const char* side, double x, TfCurves& curves) {
    const XmlElement folder = folderIn(point, side);
    if (!folder) xml.fail(std::string("there is no ") + side + " in it", point);
    const auto part = [&](const char* key) { return valueOf(xml, folder, key, 0, 255) / 255; };
    curves.colors.push_back({x, {part("R"), part("G"), part("B")}, {}});
    curves.opacities.push_back({x, part("A"), {}});
}

std::string keyOf(std::size_t i) {
    std::string digits = std::to_string(i);
    return "ControlPoint[" + std::string(4 - std::min<std::size_t>(4, digits.size()), '0') + digits + "]";
}

ReadTf readMap(const ForeignFile& file) {
    const XmlDocument& xml = file.xml();
    const XmlElement map = mapIn(xml.root());
    if (!map)
        throw FileError("it names a preset of ITK-SNAP and has no points", file.path(),
                        "change the map in ITK-SNAP a little and save it again: then it has");
    const auto count = static_cast<std::size_t>(valueOf(xml, map, "NumberOfControlPoints", 1, 10000));
    TfCurves curves;
    for (std::size_t i = 0; i < count; ++i) {
        const XmlElement point = folderIn(map, keyOf(i));
        if (!point) xml.fail("there is no " + keyOf(i) + " in it", map);
        const double x = valueOf(xml, point, "Index", 0, 1);
        addSide(xml, point, "Left", x, curves);
        if (lowerCase(entryIn(point, "Type").attribute("value").value()) == "discontinuous")
            addSide(xml, point, "Right", x, curves);
    }
    ReadTf read = tfOfCurves(curves, ValueRange{0, 1}, file.path());
    read.positions = ValueRange{0, 1};
    read.spansData = true;
    return read;
}

std::string entryText(const char* key, const std::string& value) {
    return std::string("<entry key=\"") + key + "\" value=\"" + value + "\" />";
}

std::string sideText(const char* key, const ControlPoint& p) {
    return std::string("    <folder key=\"") + key + "\">" + entryText("A", std::to_string(eightBits(p.opacity))) +
           entryText("B", std::to_string(eightBits(p.color.b))) + entryText("G", std::to_string(eightBits(p.color.g))) +
           entryText("R", std::to_string(eightBits(p.color.r))) + "</folder>\n";
}

WrittenTf writeMap(const TfToWrite& tf) {
    const std::vector<ControlPoint> points = tf.overData().points({});
    std::string folders;
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++count) {
        std::size_t last = i;
        while (last + 1 < points.size() && points[last + 1].x == points[i].x) ++last;
        folders += "  <folder key=\"" + keyOf(count) + "\">\n    " + entryText("Index", exactText(points[i].x)) +
                   entryText("Type", last > i ? "Discontinuous" : "Continuous") + "\n" + sideText("Left", points[i]) +
                   sideText("Right", points[last]) + "  </folder>\n";
        i = last + 1;
    }
    WrittenTf written;
    written.text = "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<registry>\n  " +
                   entryText("NumberOfControlPoints", std::to_string(count)) + "\n  <folder key=\"NaNColor\">" +
                   entryText("A", "0") + entryText("B", "0") + entryText("G", "0") + entryText("R", "0") +
                   "</folder>\n" + folders + "</registry>\n";
    addEightBitLosses(written.losses, points);
    addNoDomainLoss(written.losses, tf, "ITK-SNAP");
    return written;
}

} // namespace

TfFormat itkSnapFormat() {
    return {"itksnap",
            "ITK-SNAP colour map",
            "a colour map of ITK-SNAP",
            ".itksnap.xml",
            true,
            "the data range, features; opacities and colours have 256 steps",
            &knowsMap,
            &readMap,
            &writeMap};
}

} // namespace pellucid
