// Shares of features as bars: VWS with its target, and visibility (the histograms of thesis figures 5.7 to 5.10).
#pragma once

#include <vector>

#include "report/plot_drawing.h"

namespace pellucid {

struct ShareBar {
    std::string name;
    Rgb color;
    double vws = 0;                   ///< [0,1], the thick bar
    std::optional<double> visibility; ///< [0,1], the thin bar below it
    std::optional<double> target;     ///< [0,1], an upright line
};

/// A row per bar, as wide as the page; the height follows from their number. All of it stands for shares from 0 to
/// `most`.
PlotDrawing drawingOf(const std::vector<ShareBar>& bars, double most, const PlotPage& page);

} // namespace pellucid
