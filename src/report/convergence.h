// The curves of optimizations (thesis figures 5.6 to 5.10): distance from the targets, VWS and opacity over the moves.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/plot.h"
#include "session/session.h"

namespace pellucid {

/// Colours of curves that belong to no feature, told apart by all eyes; after the sixth they begin anew. (Okabe and
/// Ito, "Color universal design", 2008.)
Rgb curveColor(std::size_t number);

/// The method in a word or two: "newton", "parallel, second"; "optimize" where the session file does not tell.
std::string methodText(const Run& run);
/// What tells a run from others: its own name, else method and time: "newton 14:03".
std::string titleOf(const Run& run);

/// A run in a plot of several.
struct RunCurve {
    const Run* run = nullptr; ///< of an optimization
    Rgb color;
};

/// F over the moves of each run, 0 being the start, and the tolerance of each as a dashed line. Dots of moves along
/// rays are hollow; of a single run these moves are a band.
Plot objectivePlot(std::span<const RunCurve> runs, bool logarithmic = false);
/// VWS of each feature, in its colour, and its target as a dashed line.
Plot vwsPlot(const Run& run);
/// Opacity of each feature's peak (α of a path of length d0).
Plot opacityPlot(const Run& run, bool logarithmic = false);

/// The plots of one run, in this order.
std::vector<Plot> convergencePlots(const Run& run);

} // namespace pellucid
