#include "report/tf_plot.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

namespace {

constexpr Rgb kHistogram{0.5, 0.52, 0.56};
constexpr int kSlices = 192; ///< of the area below the curve, each of one colour
/// Slices reach below the next one, so that no ground shows between them.
constexpr double kOverlap = 0.5 / kSlices;

double highestOpacity(const TransferFunction& tf) {
    double most = 0;
    for (const ControlPoint& p : tf.points) most = std::max(most, p.opacity);
    return most > 0 ? std::min(1.0, 1.05 * most) : 1;
}

/// The counts of voxels as steps, on a logarithmic scale of their own.
PlotSeries stepsOf(const Histogram& histogram, const ValueRange& window, double top) {
    PlotSeries steps{.name = "voxels (logarithmic)", .color = kHistogram, .points = {}};
    const double most = std::log1p(static_cast<double>(std::ranges::max(histogram.counts)));
    const auto bins = static_cast<double>(histogram.counts.size());
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
        const double height = most > 0 ? top * std::log1p(static_cast<double>(histogram.counts[i])) / most : 0;
        for (const std::size_t end : {i, i + 1})
            steps.points.push_back({window.lo + static_cast<double>(end) / bins * (window.hi - window.lo), height});
    }
    return steps;
}

} // namespace

Plot tfPlot(const TransferFunction& tf, const TfPlotAxes& axes) {
    // Where all values are one the axis has a width all the same.
    const ValueRange window{axes.window.lo, axes.window.hi > axes.window.lo ? axes.window.hi : axes.window.lo + 1};
    const auto value = [&](double x) { return window.lo + x * (window.hi - window.lo); };
    const double top = axes.highest > 0 ? axes.highest : highestOpacity(tf);
    Plot plot{.title = "Transfer function",
              .x = {.label = axes.unit.empty() ? "value" : "value (" + axes.unit + ")", .lo = value(0), .hi = value(1)},
              .y = {.label = "opacity per d0", .hi = top},
              .series = {}};
    const TfSampler sampler(tf);
    for (int i = 0; i < kSlices; ++i) {
        const double from = i / double{kSlices}, to = (i + 1) / double{kSlices}, middle = (from + to) / 2;
        if (const double opacity = sampler.opacity(middle); opacity > 0)
            plot.bars.push_back({value(from), value(std::min(1.0, to + kOverlap)), opacity, sampler.color(middle)});
    }
    if (axes.histogram != nullptr && axes.histogram->total > 0)
        plot.series.push_back(stepsOf(*axes.histogram, window, top));
    PlotSeries curve{.name = axes.histogram != nullptr ? "opacity" : "", .points = {}};
    for (const ControlPoint& p : tf.pointsWithEnds()) curve.points.push_back({value(p.x), p.opacity});
    curve.dotted = true;
    plot.series.push_back(std::move(curve));
    return plot;
}

} // namespace pellucid
