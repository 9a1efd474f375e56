#include "report/page_parts.h"

#include "base/base64.h"

#include <algorithm>

#include "image_io/image_file.h"
#include "report/svg_plot.h"

namespace pellucid {

ReportPicture encoded(const Image& image) { return {image.width, image.height, pngOf(image)}; }

Image reduced(const Image& image, int most) {
    const int factor = std::max(1, (image.width + most - 1) / most);
    if (factor == 1) return image;
    Image small(std::max(1, image.width / factor), std::max(1, image.height / factor));
    const auto scale = 1 / static_cast<float>(factor * factor);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            float* const to = small.pixel(x, y);
            float alpha = 0; // colours are straight: each counts as much as it covers
            for (int j = 0; j < factor; ++j)
                for (int i = 0; i < factor; ++i) {
                    const float* const from = image.pixel(std::min(image.width - 1, x * factor + i),
                                                          std::min(image.height - 1, y * factor + j));
                    for (int c = 0; c < 3; ++c) to[c] += from[3] * from[c];
                    alpha += from[3];
                }
            for (int c = 0; c < 3; ++c) to[c] = alpha > 0 ? to[c] / alpha : 0;
            to[3] = alpha * scale;
        }
    return small;
}

std::string dataUri(const char* type, std::span<const unsigned char> bytes) {
    return std::string("data:") + type + ";base64," + base64(bytes);
}

std::string dataUri(const char* type, const std::string& text) {
    return dataUri(type, std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

std::string pictureElement(const ReportPicture& picture, const std::string& alt) {
    return "<img src=\"" + dataUri("image/png", picture.png) + "\" width=\"" + std::to_string(picture.width) +
           "\" height=\"" + std::to_string(picture.height) + "\" alt=\"" + escapedXml(alt) + "\">";
}

std::string plotFigure(const Plot& plot, double width, double height) {
    const PlotPage page{.width = width, .height = height};
    return "<figure>" + svgElement(drawingOf(plot, page), plot.title) + "</figure>\n";
}

} // namespace pellucid
