// *.itf, the transfer functions of Inviwo: points with straight RGBA, over a range of their own or that of the data.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/read_curves.h"
#include "tf/formats/tf_format.h"
#include "tf/formats/xml_document.h"

namespace pellucid {

namespace {

constexpr OpacityLength kInviwoLength{OpacityLength::Kind::Texture, 1.0 / 150};

/// What holds the points: the root, or a transfer function inside it.
XmlElement holderOf(const XmlElement& root) {
    if (root.child("Points")) return root;
    for (const XmlElement e : root.children())
        if (e.child("Points")) return e;
    return {};
}

bool knowsInviwo(const ForeignFile& file) {
    if (!file.isXml()) return false;
    const XmlElement root = file.xml().root();
    return std::string_view(root.name()) == "InviwoWorkspace" && holderOf(root);
}

double contentOf(const XmlDocument& xml, const XmlElement& holder, const char* name, double otherwise) {
    const XmlElement e = holder.child(name);
    return e ? xml.numberOr(e, "content", otherwise) : otherwise;
}

TfCurves pointsIn(const XmlDocument& xml, const XmlElement& points, bool isRelative) {
    TfCurves curves;
    for (const XmlElement p : points.children()) {
        const XmlElement pos = xml.child(p, "pos"), rgba = xml.child(p, "rgba");
        const double x = isRelative ? xml.number(pos, "content", 0, 1) : xml.number(pos, "content");
        curves.colors.push_back({x, {xml.number(rgba, "x"), xml.number(rgba, "y"), xml.number(rgba, "z")}, {}});
        curves.opacities.push_back({x, xml.number(rgba, "w"), {}});
    }
    curves.sort();
    return curves;
}

/// Opacity 0 below `lo` and above `hi`, which are in the units of the points, with a step at either that lies within
/// them; 0 everywhere where nothing lies between.
void mask(TfCurves& curves, double lo, double hi) {
    std::vector<OpacityNode>& all = curves.opacities;
    if (all.empty()) return;
    const double first = all.front().x, last = all.back().x;
    if (!(lo < hi) || hi < first || lo > last) {
        for (OpacityNode& n : all) n.opacity = 0;
        return;
    }
    if (lo > first) {
        const double there = opacityAt(curves, lo);
        std::erase_if(all, [&](const OpacityNode& n) { return n.x < lo; });
        all.insert(all.begin(), {{first, 0, {}}, {lo, 0, {}}, {lo, there, {}}});
    }
    if (hi < last) { // a step there is that of the mask: what lies before it counts
        const double there = opacityAt(curves, std::nextafter(hi, first));
        std::erase_if(all, [&](const OpacityNode& n) { return n.x >= hi; });
        all.insert(all.end(), {{hi, there, {}}, {hi, 0, {}}, {last, 0, {}}});
    }
}

ReadTf readInviwo(const ForeignFile& file) {
    const XmlDocument& xml = file.xml();
    const XmlElement holder = holderOf(xml.root());
    if (!holder) throw FileError("there are no points in it", file.path(), "give a transfer function of Inviwo");
    const bool isRelative = contentOf(xml, holder, "type", 0) == 0;
    TfCurves curves = pointsIn(xml, holder.child("Points"), isRelative);
    constexpr double kNone = std::numeric_limits<double>::max();
    const double lo = contentOf(xml, holder, "maskMin", -kNone), hi = contentOf(xml, holder, "maskMax", kNone);
    mask(curves, lo, hi);
    const std::optional<ValueRange> positions = isRelative ? std::optional(ValueRange{0, 1}) : std::nullopt;
    ReadTf read = tfOfCurves(curves, positions, file.path());
    read.positions = positions;
    read.length = kInviwoLength;
    return read;
}

WrittenTf writeInviwo(const TfToWrite& tf) {
    const bool isRelative = !tf.hasRange();
    WrittenTf written;
    const std::vector<ControlPoint> points = tf.pointsApart(kInviwoLength);
    std::string& text = written.text;
    text = "<?xml version=\"1.0\" ?>\n<InviwoWorkspace version=\"3\">\n    <maskMin content=\"" +
           exactText(isRelative ? 0 : tf.range().lo) + "\" />\n    <maskMax content=\"" +
           exactText(isRelative ? 1 : tf.range().hi) + "\" />\n    <type content=\"" + (isRelative ? "0" : "1") +
           "\" />\n    <Points>\n";
    for (const ControlPoint& p : points)
        text += "        <Point>\n            <pos content=\"" + exactText(tf.value(p.x)) +
                "\" />\n            <rgba x=\"" + exactText(p.color.r) + "\" y=\"" + exactText(p.color.g) + "\" z=\"" +
                exactText(p.color.b) + "\" w=\"" + exactText(p.opacity) + "\" />\n        </Point>\n";
    text += "    </Points>\n</InviwoWorkspace>\n";
    return written;
}

} // namespace

TfFormat inviwoFormat() {
    return {"inviwo",    "Inviwo",    "a transfer function of Inviwo", ".itf", true, "features", &knowsInviwo,
            &readInviwo, &writeInviwo};
}

} // namespace pellucid
