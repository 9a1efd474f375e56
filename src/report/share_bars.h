// Shares of features as bars: VWS with its target, and visibility (the histograms of thesis figures 4.5, 4.6, 4.9, 4.12
// and 5.7 to 5.10).
#pragma once

#include <string>
#include <vector>

#include "report/plot_drawing.h"
#include "saliency/vws.h"
#include "tf/transfer_function.h"

namespace pellucid {

struct ShareBar {
    std::string name;
    Rgb color;
    double vws = 0;                                                        ///< [0,1], the thick bar
    std::optional<double> visibility;                                      ///< [0,1], the thin bar below it
    std::optional<double> target;                                          ///< [0,1], an upright line
    std::optional<double> vwsBrightness = {}, vwsSaturation = {}, fs = {}; ///< [0,1], in charts of their own
};

/// A bar per feature of `tf`, without a target. `fs`, 2D feature saliency, may be empty.
std::vector<ShareBar> shareBarsOf(const TransferFunction& tf, const std::vector<FeatureMeasures>& measures,
                                  const std::vector<double>& fs = {});

/// A row per bar, as wide as the page; the height follows from their number. All of it stands for shares from 0 to
/// `most`.
PlotDrawing drawingOf(const std::vector<ShareBar>& bars, double most, const PlotPage& page);

/// Bar charts of each measure that is known, in the order of figure 4.5: visibility, VWS of brightness, of saturation,
/// VWS with the targets, 2D feature saliency. They have one scale; as many stand side by side as have room on the
/// page, whose height does not count.
PlotDrawing chartsOf(const std::vector<ShareBar>& bars, const PlotPage& page);

/// The charts as a file, .svg or .png. Throws UsageError for another suffix, Error where there are no bars,
/// FileError.
void writeShareCharts(const std::vector<ShareBar>& bars, const std::string& path);

} // namespace pellucid
