// ColorMap, the older colour maps of ParaView in XML: colours; opacities are read where they are there.
#include <algorithm>

#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/paraview_preset.h"
#include "tf/formats/preset_choice.h"
#include "tf/formats/read_curves.h"
#include "tf/formats/xml_document.h"

namespace pellucid {

namespace {

constexpr const char* kMap = "ColorMap";

std::vector<XmlElement> mapsIn(const ForeignFile& file) {
    std::vector<XmlElement> maps;
    const XmlElement root = file.xml().root();
    if (std::string_view(root.name()) == kMap) maps.push_back(root);
    for (const XmlElement e : root.children(kMap)) maps.push_back(e);
    return maps;
}

bool knowsMaps(const ForeignFile& file) { return file.isXml() && !mapsIn(file).empty(); }

std::vector<std::string> namesIn(const ForeignFile& file) {
    std::vector<std::string> names;
    for (const XmlElement& e : mapsIn(file)) names.emplace_back(e.attribute("name").value());
    return distinctNames(std::move(names));
}

ColorSpace spaceOf(const XmlDocument& xml, const XmlElement& map) {
    const std::string space = lowerCase(map.attribute("space").value());
    if (space.empty()) return ColorSpace::Rgb;
    if (const auto known = paraViewSpace(space)) return *known;
    if (space == "hsv") return ColorSpace::Hsv;
    if (space == "wrapped") return ColorSpace::HsvWrapped;
    xml.fail("there is no colour space " + inQuotes(space), map);
}

TfCurves curvesOf(const XmlDocument& xml, const XmlElement& map) {
    TfCurves curves;
    curves.space = spaceOf(xml, map);
    // Maps of colours alone carry an opacity of 1, or one as large as x, which nobody has set.
    bool tells = false;
    for (const XmlElement p : map.children("Point")) {
        const double x = xml.number(p, "x"), opacity = xml.numberOr(p, "o", 1);
        curves.colors.push_back({x, {xml.number(p, "r"), xml.number(p, "g"), xml.number(p, "b")}, {}});
        curves.opacities.push_back({x, opacity, {}});
        tells = tells || (opacity != 1 && opacity != x);
    }
    if (!tells) curves.opacities.clear();
    curves.sort();
    curves.keepLastOfEach();
    return curves;
}

ReadTf readMaps(const ForeignFile& file) {
    const std::vector<XmlElement> maps = mapsIn(file);
    if (maps.empty()) throw FileError("there is no ColorMap in it", file.path(), "give colour maps of ParaView");
    std::vector<std::string> notices;
    const XmlElement map = maps[presetNamed(namesIn(file), file, notices)];
    if (map.attribute("indexedLookup").as_bool())
        file.xml().fail("its colours are of categories, not of a range of values", map);
    const TfCurves curves = curvesOf(file.xml(), map);
    const std::optional<ValueRange> positions = paraViewPositions(curves);
    ReadTf read = tfOfCurves(curves, positions, file.path());
    read.positions = positions;
    read.length = {OpacityLength::Kind::ParaView, 1};
    read.notices.insert(read.notices.begin(), notices.begin(), notices.end());
    return read;
}

WrittenTf writeMap(const TfToWrite& tf) {
    WrittenTf written;
    written.text =
        "<ColorMaps>\n<ColorMap name=\"" + xmlEscaped(tf.name()) + "\" space=\"RGB\" indexedLookup=\"false\">\n";
    for (const ControlPoint& p : tf.pointsApart({}))
        written.text += "  <Point x=\"" + exactText(tf.value(p.x)) + "\" o=\"1\" r=\"" + exactText(p.color.r) +
                        "\" g=\"" + exactText(p.color.g) + "\" b=\"" + exactText(p.color.b) + "\"/>\n";
    written.text += "  <NaN r=\"0\" g=\"0\" b=\"0\"/>\n</ColorMap>\n</ColorMaps>\n";
    written.losses.emplace_back("opacities are not stored: this format has colours only");
    return written;
}

} // namespace

TfFormat paraViewXmlFormat() {
    return {"paraview-xml",
            "ParaView colour map, older XML",
            "an older ParaView colour map (XML)",
            ".xml",
            false,
            "opacities, features",
            &knowsMaps,
            &readMaps,
            &writeMap,
            &namesIn};
}

} // namespace pellucid
