// A transfer function as a plot: opacity over the values in its colours, with the histogram of the volume (thesis
// figures 3.4 to 3.8, 3.14).
#pragma once

#include <string>

#include "report/plot.h"
#include "tf/transfer_function.h"
#include "volume/histogram.h"

namespace pellucid {

struct TfPlotAxes {
    ValueRange window = {0, 1};           ///< data units of intensity 0 and 1
    std::string unit = {};                ///< of the data; may be empty
    const Histogram* histogram = nullptr; ///< of the volume through that window; null: none is drawn
    double highest = 0;                   ///< upper end of the axis of opacity, [0,1]; 0: what fits
};

/// The curve, its area in the colours that it gives, and how many voxels have each value, logarithmically, the most as
/// high as the plot.
Plot tfPlot(const TransferFunction& tf, const TfPlotAxes& axes);

} // namespace pellucid
