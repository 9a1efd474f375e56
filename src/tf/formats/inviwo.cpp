// *.itf, the transfer functions of Inviwo: points with straight RGBA, over a range of their own or that of the data.
#include <algorithm>

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

/// Opacity 0 below `lo` and above `hi`, with a step at either that lies within 0 to 1.
void mask(TfCurves& curves, double lo, double hi) {
    if (curves.opacities.empty()) return;
    const double atLo = opacityAt(curves, lo), atHi = opacityAt(curves, hi);
    std::erase_if(curves.opacities, [&](const OpacityNode& n) { return n.x <= lo || n.x >= hi; });
    std::vector<OpacityNode>& all = curves.opacities;
    all.insert(all.begin(), {{lo, lo > 0 ? 0 : atLo, {}}, {lo, atLo, {}}});
    all.insert(all.end(), {{hi, atHi, {}}, {hi, hi < 1 ? 0 : atHi, {}}});
}

ReadTf readInviwo(const ForeignFile& file) {
    const XmlDocument& xml = file.xml();
    const XmlElement holder = holderOf(xml.root());
    if (!holder) throw FileError("there are no points in it", file.path(), "give a transfer function of Inviwo");
    const bool isRelative = contentOf(xml, holder, "type", 0) == 0;
    TfCurves curves = pointsIn(xml, holder.child("Points"), isRelative);
    const double lo = contentOf(xml, holder, "maskMin", 0), hi = contentOf(xml, holder, "maskMax", 1);
    if (isRelative && lo < hi && (lo > 0 || hi < 1)) mask(curves, std::max(lo, 0.0), std::min(hi, 1.0));
    ReadTf read = tfOfCurves(curves, isRelative ? std::optional(ValueRange{0, 1}) : std::nullopt, file.path());
    if (isRelative) read.notices.push_back(noDomainNotice());
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
    return {"inviwo", "Inviwo", ".itf", true, "features", &knowsInviwo, &readInviwo, &writeInviwo};
}

} // namespace pellucid
