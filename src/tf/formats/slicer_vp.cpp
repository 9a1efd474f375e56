// *.vp, the older volume properties of 3D Slicer: nine lines of text.
#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/slicer_property.h"

namespace pellucid {

namespace {

constexpr std::size_t kLines = 9;

std::vector<std::string_view> filledLines(const ForeignFile& file) {
    std::vector<std::string_view> filled;
    for (const std::string_view line : file.lines())
        if (!trimmed(line).empty()) filled.push_back(line);
    return filled;
}

bool isNumber(std::string_view text) {
    double value = 0;
    return parseNumber(trimmed(text), value);
}

/// Six lines of one number each, then three lists.
bool knowsLines(const ForeignFile& file) {
    if (file.isJson() || file.isXml()) return false;
    const std::vector<std::string_view> lines = filledLines(file);
    if (lines.size() < kLines) return false;
    for (std::size_t i = 0; i < 6; ++i)
        if (!isNumber(lines[i])) return false;
    return splitWords(lines[6]).size() > 1 && splitWords(lines[8]).size() > 1;
}

double numberOn(const std::vector<std::string_view>& lines, std::size_t i, const ForeignFile& file) {
    double value = 0;
    if (!parseNumber(trimmed(lines[i]), value))
        throw FileError(inQuotes(trimmed(lines[i])) + " is not a number",
                        file.path() + ", line " + std::to_string(i + 1), "correct the file");
    return value;
}

ReadTf readLines(const ForeignFile& file) {
    const std::vector<std::string_view> lines = filledLines(file);
    if (lines.size() < kLines)
        throw FileError("it has " + std::to_string(lines.size()) + " of 9 lines", file.path(),
                        "give a volume property of 3D Slicer, *.vp");
    SlicerLook look;
    look.interpolation = numberOn(lines, 0, file) == 0 ? 0 : 1;
    look.shade = numberOn(lines, 1, file) != 0;
    look.diffuse = numberOn(lines, 2, file);
    look.ambient = numberOn(lines, 3, file);
    look.specular = numberOn(lines, 4, file);
    look.specularPower = numberOn(lines, 5, file);
    look.gradient = gradientOf(lines[7], file.path());
    ReadTf read = tfOfCurves(slicerCurves(lines[6], lines[8], file.path()), {}, file.path());
    read.length = kMillimetre;
    keepLook(read, look);
    return read;
}

WrittenTf writeLines(const TfToWrite& tf) {
    const std::vector<ControlPoint> points = tf.pointsApart(kMillimetre);
    const SlicerLook look = keptLook(tf);
    WrittenTf written;
    for (const double v : {static_cast<double>(look.interpolation), look.shade ? 1.0 : 0.0, look.diffuse, look.ambient,
                           look.specular, look.specularPower})
        written.text += exactText(v) + "\n";
    written.text += slicerOpacities(points, tf) + "\n" + slicerGradient(look) + "\n" + slicerColors(points, tf) + "\n";
    addVtkLosses(written.losses, points);
    return written;
}

} // namespace

TfFormat slicerVpFormat() {
    return {"slicer-vp",
            "3D Slicer, older volume property",
            "an older volume property of 3D Slicer",
            ".vp",
            true,
            "features, unit distance (opacities are for 1 mm)",
            &knowsLines,
            &readLines,
            &writeLines};
}

} // namespace pellucid
