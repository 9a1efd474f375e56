#include "foreign/images/page_words.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/text.h"
#include "volume/formats/text_header.h"

namespace pellucid {

namespace {

constexpr int kMost = 1'000'000; // of slices, channels or steps

int countIn(const std::string& text, int otherwise) {
    const double number = numberIn(trimmed(text));
    return number >= 1 && number <= kMost ? static_cast<int>(number) : otherwise;
}

double lengthIn(const std::string& text, double otherwise) {
    const double number = numberIn(trimmed(text));
    return number > 0 && std::isfinite(number) ? number : otherwise;
}

/// Lines "name=value".
PageOrder orderOfImageJ(const std::string& description, double pixelsPerUnitX, double pixelsPerUnitY) {
    std::map<std::string, std::string> fields;
    for (const std::string& text : splitAt('\n', description))
        if (const std::size_t sign = text.find('='); sign != std::string::npos)
            fields[text.substr(0, sign)] = text.substr(sign + 1);
    PageOrder order;
    order.software = "ImageJ";
    order.axes = "czt";
    order.images = countIn(fields["images"], 0);
    order.channels = countIn(fields["channels"], 1);
    order.slices = countIn(fields["slices"], 0);
    order.steps = countIn(fields["frames"], 1);
    if (order.slices == 0 && (order.channels > 1 || order.steps > 1)) order.slices = 1;
    if (pixelsPerUnitX > 0) order.spacing.x = 1 / pixelsPerUnitX;
    if (pixelsPerUnitY > 0) order.spacing.y = 1 / pixelsPerUnitY;
    order.spacing.z = lengthIn(fields["spacing"], order.spacing.x);
    order.stepSeconds = lengthIn(fields["finterval"], 0);
    return order;
}

/// The value of an attribute in a tag; empty where it has none.
std::string attribute(const std::string& tag, const std::string& name) {
    const std::size_t at = tag.find(" " + name + "=\"");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + name.size() + 3, end = tag.find('"', begin);
    return end == std::string::npos ? std::string() : tag.substr(begin, end - begin);
}

/// Micrometres of a unit of length; those of OME without one are micrometres.
std::optional<double> micrometresOf(const std::string& unit) {
    static const std::map<std::string, double> kUnits{{"", 1},     {"µm", 1},  {"um", 1},   {"nm", 1e-3}, {"mm", 1e3},
                                                      {"cm", 1e4}, {"m", 1e6}, {"Å", 1e-4}, {"pm", 1e-6}};
    const auto it = kUnits.find(unit);
    return it == kUnits.end() ? std::nullopt : std::optional(it->second);
}

/// The element Pixels of the first image.
PageOrder orderOfOme(const std::string& description) {
    PageOrder order;
    order.software = "OME";
    const std::size_t begin = description.find("<Pixels"), end = description.find('>', begin);
    if (begin == std::string::npos || end == std::string::npos) return order;
    const std::string tag = description.substr(begin, end - begin);
    const std::string dimensions = lowerCase(attribute(tag, "DimensionOrder")); // "xyzct"
    order.axes = dimensions.starts_with("xy") ? dimensions.substr(2) : "";
    if (!std::ranges::is_permutation(order.axes, std::string("zct"))) order.axes = "zct"; // the most frequent one
    order.slices = countIn(attribute(tag, "SizeZ"), 0);
    order.channels = countIn(attribute(tag, "SizeC"), 1);
    order.steps = countIn(attribute(tag, "SizeT"), 1);
    order.stepSeconds = lengthIn(attribute(tag, "TimeIncrement"), 0);
    for (int a = 0; a < 3; ++a) { // all in the unit of x
        const std::string name = std::string("PhysicalSize") + "XYZ"[a];
        const auto unit = micrometresOf(attribute(tag, name + "Unit")),
                   first = micrometresOf(attribute(tag, "PhysicalSizeXUnit"));
        order.spacing[a] = lengthIn(attribute(tag, name), 1) * (unit && first ? *unit / *first : 1);
    }
    return order;
}

} // namespace

PageOrder pageOrderIn(const std::string& description, double pixelsPerUnitX, double pixelsPerUnitY) {
    if (description.starts_with("ImageJ=")) return orderOfImageJ(description, pixelsPerUnitX, pixelsPerUnitY);
    if (description.find("<OME") != std::string::npos && description.find("<Pixels") != std::string::npos)
        return orderOfOme(description);
    return {};
}

} // namespace pellucid
