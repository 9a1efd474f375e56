// Plots as SVG: files of their own, or parts of an HTML page.
#pragma once

#include <span>
#include <string>

#include "base/xml_text.h"
#include "report/plot_drawing.h"

namespace pellucid {

/// The colour of an ink on a white ground; not of Own, which brings its own.
Rgb inkOnLight(PlotInk ink);

/// Style rules for the classes of the drawings: dark texts on white; the reverse where whoever looks at it prefers
/// dark. Without them drawings have the colours for a white ground.
std::string plotStyle();

/// One `<svg>` element, without a style of its own: for pages that have plotStyle(). `label` is read out in its place.
std::string svgElement(const PlotDrawing& drawing, const std::string& label);

/// A file: drawings below each other, on a ground.
std::string svgOf(std::span<const PlotDrawing> drawings);
/// The same of plots, each of `page`.
std::string svgOf(std::span<const Plot> plots, const PlotPage& page = {});

} // namespace pellucid
