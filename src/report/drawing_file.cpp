#include "report/drawing_file.h"

#include <filesystem>
#include <span>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"
#include "image_io/image_file.h"
#include "report/image_plot.h"
#include "report/svg_plot.h"

namespace pellucid {

namespace {

std::string suffixOf(const std::string& path) { return lowerCase(std::filesystem::path(path).extension().string()); }

} // namespace

void checkDrawingSuffix(const std::string& path, const std::string& what) {
    if (suffixOf(path) != ".svg" && suffixOf(path) != ".png")
        throw UsageError(what + " are written as .svg or .png", path, "give one of these suffixes");
}

void writeDrawing(const PageDrawing& draw, const PlotPage& page, const std::string& path) {
    checkDrawingSuffix(path, "drawings");
    const bool svg = suffixOf(path) == ".svg";
    const PlotDrawing drawing = draw(svg ? page : imagePage(page));
    if (svg)
        writeTextAtomically(path, svgOf(std::span(&drawing, 1)));
    else
        writeImage(imageOf(std::span(&drawing, 1)), path);
}

} // namespace pellucid
