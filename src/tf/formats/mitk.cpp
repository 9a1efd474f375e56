// Transfer functions of MITK: XML with opacities, gradient opacities and colours in data units.
#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/slicer_property.h"
#include "tf/formats/tf_format.h"
#include "tf/formats/xml_document.h"

namespace pellucid {

namespace {

constexpr const char* kFunction = "TransferFunction";

/// Beside others at the top, or inside a root.
XmlElement functionIn(const ForeignFile& file) {
    if (const XmlElement e = file.xml().document().child(kFunction)) return e;
    return file.xml().root().child(kFunction);
}

bool knowsMitk(const ForeignFile& file) {
    if (!file.isXml()) return false;
    const XmlElement e = functionIn(file);
    return e && e.child("ScalarOpacity");
}

ReadTf readMitk(const ForeignFile& file) {
    const XmlDocument& xml = file.xml();
    const XmlElement function = functionIn(file);
    if (!function) throw FileError("there is no TransferFunction in it", file.path(), "give one of MITK");
    TfCurves curves;
    for (const XmlElement p : xml.child(function, "ScalarOpacity").children("point"))
        curves.opacities.push_back({xml.number(p, "x"), xml.number(p, "y"), {}});
    for (const XmlElement p : xml.child(function, "Color").children("point"))
        curves.colors.push_back({xml.number(p, "x"),
                                 {xml.number(p, "r"), xml.number(p, "g"), xml.number(p, "b")},
                                 {xml.number(p, "midpoint", 0, 1), xml.number(p, "sharpness", 0, 1)}});
    SlicerLook look; // the same curve, in the same terms
    for (const XmlElement p : xml.child(function, "GradientOpacity").children("point"))
        look.gradient.push_back({xml.number(p, "x"), xml.number(p, "y")});
    curves.sort();
    curves.keepLastOfEach();
    ReadTf read = tfOfCurves(curves, {}, file.path());
    read.length = kMillimetre;
    keepLook(read, look);
    return read;
}

std::string pointText(double x, double y) {
    return "    <point x=\"" + exactText(x) + "\" y=\"" + exactText(y) + "\" />\n";
}

WrittenTf writeMitk(const TfToWrite& tf) {
    const std::vector<ControlPoint> points = tf.pointsApart(kMillimetre);
    const SlicerLook look = keptLook(tf);
    std::string opacities, gradient, colors;
    for (const ControlPoint& p : points) {
        const std::string x = exactText(tf.value(p.x));
        opacities += pointText(tf.value(p.x), p.opacity);
        colors += "    <point x=\"" + x + "\" r=\"" + exactText(p.color.r) + "\" g=\"" + exactText(p.color.g) +
                  "\" b=\"" + exactText(p.color.b) + "\" midpoint=\"0.5\" sharpness=\"0\" />\n";
    }
    for (const auto& [x, y] : look.gradient) gradient += pointText(x, y);
    if (look.gradient.empty()) gradient = pointText(0, 1) + pointText(255, 1);
    WrittenTf written;
    written.text = "<?xml version=\"1.0\" ?>\n<Version TransferfunctionVersion=\"1\" />\n<TransferFunction>\n"
                   "  <ScalarOpacity>\n" +
                   opacities + "  </ScalarOpacity>\n  <GradientOpacity>\n" + gradient +
                   "  </GradientOpacity>\n  <Color>\n" + colors + "  </Color>\n</TransferFunction>\n";
    addVtkLosses(written.losses, points);
    return written;
}

} // namespace

TfFormat mitkFormat() {
    return {"mitk",      "MITK",    "a transfer function of MITK",
            ".mitk.xml", true,      "features, unit distance (opacities are for 1 mm)",
            &knowsMitk,  &readMitk, &writeMitk};
}

} // namespace pellucid
