// A scene as a figure for print: SVG or PDF.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "figure/figure_layout.h"
#include "session/workspace.h"

namespace pellucid {

struct FigureTask {
    Scene scene;
    RenderSettings look; ///< how it is drawn; its size is not used
    FigureSettings settings = {};
    std::string path = {};
};

/// Throws UsageError unless `path` ends in .svg or .pdf.
void checkFigureSuffix(const std::string& path);
/// What can be told before any work. Throws UsageError (a size) and Error (a field).
void checkFigure(const FigureTask& task);

/// Draws and measures what the settings ask for. Throws as checkFigure() does, as renderers, Workspace::measure() and
/// extentOf() do, and Cancelled.
FigureContent figureContent(const FigureTask& task, Workspace& workspace, const JobControl& job = {});

/// That none of these families is installed, and which one stands in; empty: one is. Generic names, as sans, stand for
/// any font.
std::string fontNotice(const std::string& font);

struct FigureFile {
    FigurePixels pixels;          ///< of the picture
    double width = 0, height = 0; ///< of the page, mm
    std::vector<FigureRow> rows;  ///< as figureContent() gives them
    std::optional<FigureScale> scale;
    std::string caption; ///< empty: not asked for
    std::size_t bytes = 0;
    std::vector<std::string> notices; ///< what is not as it was asked for
};
/// Writes it; the file is whole or absent. Throws as figureContent() does, and FileError.
FigureFile makeFigure(const FigureTask& task, const JobControl& job = {});

} // namespace pellucid
