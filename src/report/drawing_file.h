// Plots and charts as files: a drawing (SVG) or a picture (PNG), by the suffix.
#pragma once

#include <functional>
#include <string>

#include "report/plot_drawing.h"

namespace pellucid {

/// Lays something out on a page, whose letters are as wide as the page says.
using PageDrawing = std::function<PlotDrawing(const PlotPage& page)>;

/// Throws UsageError unless `path` ends in .svg or .png. `what` is written, in the plural: "bars".
void checkDrawingSuffix(const std::string& path, const std::string& what);
/// Throws UsageError for another suffix, FileError.
void writeDrawing(const PageDrawing& draw, const PlotPage& page, const std::string& path);

} // namespace pellucid
