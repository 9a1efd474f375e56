// Plots as pictures in memory, for PNG files.
#pragma once

#include <span>

#include "base/image.h"
#include "report/plot_drawing.h"

namespace pellucid {

/// Plots below each other, each of `page`, on white; `scale` pixels to one of the page, > 0. Letters are made of lines,
/// the same on every machine.
Image imageOf(std::span<const Plot> plots, const PlotPage& page = {}, double scale = 2);

} // namespace pellucid
