// Pictures and plots inside an HTML page, which then needs no other file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/image.h"
#include "report/plot.h"

namespace pellucid {

/// The name of a page in its folder, where nobody gives it another one.
inline constexpr const char* kReportFile = "report.html";

/// A picture as a PNG file.
struct ReportPicture {
    int width = 0, height = 0; ///< pixels
    std::vector<unsigned char> png;
};
ReportPicture encoded(const Image& image);
/// Means over squares of pixels, as wide as `most` at most.
Image reduced(const Image& image, int most);

/// A file as an address; `type` as in "text/csv".
std::string dataUri(const char* type, std::span<const unsigned char> bytes);
std::string dataUri(const char* type, const std::string& text);

/// `alt` is read out in its place, and escaped here.
std::string pictureElement(const ReportPicture& picture, const std::string& alt);
/// `width` and `height` in pixels of the page, which has plotStyle().
std::string plotFigure(const Plot& plot, double width, double height);

} // namespace pellucid
