#include "threads_plot.h"

#include <algorithm>
#include <limits>

#include "report/convergence.h"

namespace pellucid::cli {

Plot threadsPlot(std::span<const BenchResult> rows) {
    Plot plot{.title = "Parallel line search by number of threads",
              .x = {.label = "threads", .lo = 1, .hi = 2, .whole = true},
              .y = {.label = "seconds until F < 0.03"},
              .series = {}};
    std::vector<PlotSeries> ideal;
    for (const BenchResult& row : rows) {
        if (row.row != BenchRow::Threads) continue;
        const std::string name = row.tf ? row.volume + ", " + *row.tf : row.volume;
        auto curve = std::ranges::find(plot.series, name, &PlotSeries::name);
        if (curve == plot.series.end()) {
            const Rgb color = curveColor(plot.series.size());
            plot.series.push_back({.name = name, .color = color, .dotted = true, .points = {}});
            ideal.push_back({.name = {}, .color = color, .dashed = true, .points = {}});
            curve = plot.series.end() - 1;
        }
        const double threads = row.threads;
        curve->points.push_back({threads, row.seconds});
        PlotSeries& dashed = ideal[static_cast<std::size_t>(curve - plot.series.begin())];
        dashed.points.push_back({threads, curve->points.front().y * curve->points.front().x / threads});
        plot.x.hi = std::max(plot.x.hi, threads);
    }
    plot.series.insert(plot.series.end(), ideal.begin(), ideal.end());
    if (const int processors = processorCount(); processors < plot.x.hi)
        plot.bands = {{static_cast<double>(processors), plot.x.hi, "more threads than processors"}};
    fitLinear(plot, std::numeric_limits<double>::max());
    return plot;
}

} // namespace pellucid::cli
