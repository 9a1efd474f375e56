// A plot as data: curves over common axes. How it is drawn is the business of plot_drawing.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/color.h"

namespace pellucid {

struct PlotPoint {
    double x = 0, y = 0;      ///< finite, in the units of the axes
    bool preliminary = false; ///< its dot is hollow
    double spread = 0;        ///< half the height of an interval around it; 0: none
    bool operator==(const PlotPoint&) const = default;
};

struct PlotSeries {
    std::string name;              ///< in the legend; empty: not in it
    std::optional<Rgb> color = {}; ///< empty: that of texts
    bool dashed = false;
    bool dotted = false;           ///< a dot at each point
    std::vector<PlotPoint> points; ///< in the order in which the line goes
    bool joined = true;            ///< by a line; else dots alone
    bool operator==(const PlotSeries&) const = default;
};

struct PlotAxis {
    std::string label;     ///< what is counted and in which unit: "move", "value (HU)"
    double lo = 0, hi = 1; ///< lo < hi; both > 0 where it is logarithmic. What lies outside is drawn at the edge
    bool logarithmic = false;
    bool whole = false; ///< ticks at whole numbers only
    bool operator==(const PlotAxis&) const = default;
};

/// A part of the x axis that is set apart.
struct PlotBand {
    double from = 0, to = 0;
    std::string text;
    bool operator==(const PlotBand&) const = default;
};

/// An area that stands on the x axis.
struct PlotBar {
    double from = 0, to = 0;       ///< values of x
    double height = 0;             ///< a value of y
    std::optional<Rgb> color = {}; ///< empty: a shade
    bool operator==(const PlotBar&) const = default;
};

struct Plot {
    std::string title;
    PlotAxis x, y;
    std::vector<PlotSeries> series;
    std::vector<PlotBand> bands = {};
    std::vector<PlotBar> bars = {}; ///< below the curves
    bool operator==(const Plot&) const = default;
};

/// The y axis from 0 to a tenth beyond the largest value, at most to `most`.
void fitLinear(Plot& plot, double most);
/// A logarithmic y axis of whole decades around all values from `smallest` > 0 on.
void fitDecades(Plot& plot, double smallest);

} // namespace pellucid
