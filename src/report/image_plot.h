// Plots as pictures in memory, for PNG files.
#pragma once

#include <span>

#include "base/image.h"
#include "report/plot_drawing.h"

namespace pellucid {

/// `page` with the widths that letters have here: they are made of lines, the same on every machine.
PlotPage imagePage(const PlotPage& page);

/// Drawings below each other, made for an imagePage(), on white; `scale` pixels to one of the page, > 0.
Image imageOf(std::span<const PlotDrawing> drawings, double scale = 2);
/// The same of plots, each of `page`.
Image imageOf(std::span<const Plot> plots, const PlotPage& page = {}, double scale = 2);

} // namespace pellucid
