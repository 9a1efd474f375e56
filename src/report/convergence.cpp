#include "report/convergence.h"

#include <algorithm>
#include <array>

#include "tf/feature.h"

namespace pellucid {

namespace {

constexpr double kSmallestShown = 1e-6; ///< on logarithmic axes: F of 0 has a place too

PlotAxis moveAxis(std::size_t states) {
    return {.label = "move", .lo = 0, .hi = static_cast<double>(std::max<std::size_t>(2, states) - 1), .whole = true};
}

/// The moves of one run along rays: neighbours together.
std::vector<PlotBand> coarseBands(const Run& run) {
    std::vector<PlotBand> bands;
    for (std::size_t i = 0; i < run.history.size(); ++i) {
        if (run.history[i].level == 0) continue;
        const double at = static_cast<double>(i), last = static_cast<double>(run.history.size() - 1);
        if (!bands.empty() && bands.back().to == at - 0.5)
            bands.back().to = std::min(at + 0.5, last);
        else
            bands.push_back({std::max(0.0, at - 0.5), std::min(at + 0.5, last), "along rays"});
    }
    return bands;
}

/// One curve of a run; `valueAt` of a state.
template <class ValueAt>
PlotSeries curve(const Run& run, std::string name, Rgb color, const ValueAt& valueAt) {
    PlotSeries series{.name = std::move(name), .color = color, .dotted = true, .points = {}};
    for (std::size_t i = 0; i < run.history.size(); ++i)
        series.points.push_back({static_cast<double>(i), valueAt(run.history[i]), run.history[i].level > 0});
    return series;
}

PlotSeries level(double value, std::size_t states, std::optional<Rgb> color) {
    const double last = moveAxis(states).hi;
    return {.name = {}, .color = color, .dashed = true, .points = {{0, value}, {last, value}}};
}

double at(const std::vector<double>& values, std::size_t i) { return i < values.size() ? values[i] : 0; }

Rgb featureColor(const Run& run, std::size_t feature) {
    const auto& features = run.start->tf.features;
    return feature < features.size() ? features[feature].color : curveColor(feature);
}

} // namespace

Rgb curveColor(std::size_t number) {
    static constexpr std::array<const char*, 6> kColors{"#0072b2", "#d55e00", "#009e73",
                                                        "#cc79a7", "#e69f00", "#56b4e9"};
    return rgbFromHex(kColors[number % kColors.size()]);
}

std::string methodText(const Run& run) {
    if (run.start->tf.points.empty()) return run.kind;
    const OptimizeOptions& options = run.start->options;
    const std::string method = name(options.method);
    if (options.method == SearchMethod::Newton || options.direction == Direction::Gradient) return method;
    return method + ", " + name(options.direction);
}

std::string titleOf(const Run& run) {
    if (!run.name.empty()) return run.name;
    const std::size_t time = run.started.find('T'); // 2026-11-22T14:03:07
    return methodText(run) + (time == std::string::npos ? "" : " " + run.started.substr(time + 1, 5));
}

Plot objectivePlot(std::span<const RunCurve> runs, bool logarithmic) {
    Plot plot{.title = "Distance from the targets", .x = {}, .y = {.label = "F"}, .series = {}};
    std::size_t longest = 0;
    std::vector<double> tolerances;
    for (const RunCurve& r : runs) longest = std::max(longest, r.run->history.size());
    for (const RunCurve& r : runs) {
        if (r.run->history.empty()) continue;
        plot.series.push_back(
            curve(*r.run, titleOf(*r.run), r.color, [](const OptimizeState& state) { return state.objective; }));
        const double tolerance = r.run->start->options.tolerance;
        if (std::find(tolerances.begin(), tolerances.end(), tolerance) == tolerances.end())
            tolerances.push_back(tolerance);
    }
    for (const double tolerance : tolerances) plot.series.push_back(level(tolerance, longest, {}));
    plot.x = moveAxis(longest);
    if (runs.size() == 1) plot.bands = coarseBands(*runs.front().run);
    logarithmic ? fitDecades(plot, kSmallestShown) : fitLinear(plot, 1);
    return plot;
}

Plot vwsPlot(const Run& run) {
    Plot plot{.title = "Visibility-weighted saliency",
              .x = moveAxis(run.history.size()),
              .y = {.label = "VWS"},
              .series = {}};
    for (std::size_t f = 0; f < run.features.size(); ++f) {
        const Rgb color = featureColor(run, f);
        plot.series.push_back(
            curve(run, run.features[f], color, [f](const OptimizeState& state) { return at(state.vws, f); }));
        if (f < run.targets.size()) plot.series.push_back(level(run.targets[f], run.history.size(), color));
    }
    plot.bands = coarseBands(run);
    fitLinear(plot, 1);
    return plot;
}

Plot opacityPlot(const Run& run, bool logarithmic) {
    Plot plot{.title = "Opacity of the peaks",
              .x = moveAxis(run.history.size()),
              .y = {.label = "opacity per d0"},
              .series = {}};
    for (std::size_t f = 0; f < run.features.size(); ++f)
        plot.series.push_back(curve(run, run.features[f], featureColor(run, f),
                                    [f](const OptimizeState& state) { return at(state.opacity, f); }));
    plot.bands = coarseBands(run);
    logarithmic ? fitDecades(plot, kSmallestShown) : fitLinear(plot, 1);
    return plot;
}

std::vector<Plot> convergencePlots(const Run& run) {
    const std::array runs{RunCurve{&run, curveColor(0)}};
    return {objectivePlot(runs), vwsPlot(run), opacityPlot(run)};
}

} // namespace pellucid
