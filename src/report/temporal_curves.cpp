#include "report/temporal_curves.h"

#include <algorithm>
#include <optional>

#include "base/csv.h"
#include "report/convergence.h"

namespace pellucid {

namespace {

constexpr double kSmallestShown = 1e-5; ///< on logarithmic axes

PlotAxis frameAxis(const TemporalCurves& curves) {
    int first = 0, last = 1;
    bool any = false;
    for (const TemporalRun& run : curves.runs)
        for (const FrameFigures& f : run.frames) {
            first = any ? std::min(first, f.frame) : f.frame;
            last = any ? std::max(last, f.frame) : f.frame;
            any = true;
        }
    return {.label = "frame",
            .lo = static_cast<double>(first),
            .hi = static_cast<double>(std::max(last, first + 1)),
            .whole = true};
}

/// A curve over the frames of a run, cut where there is no value.
template <class ValueAt>
void addCurve(Plot& plot, const TemporalRun& run, const std::string& name, const std::optional<Rgb>& color, bool dashed,
              const ValueAt& valueAt) {
    PlotSeries piece{.name = name, .color = color, .dashed = dashed, .points = {}};
    const auto end = [&] {
        if (piece.points.size() == 1) piece.dotted = true; // a line of one point is none
        if (!piece.points.empty()) {
            plot.series.push_back(piece);
            piece.name.clear(); // once in the legend
        }
        piece.points.clear();
        piece.dotted = false;
    };
    for (const FrameFigures& f : run.frames) {
        const std::optional<double> value = f.problem.empty() ? valueAt(f) : std::nullopt;
        if (value)
            piece.points.push_back({static_cast<double>(f.frame), *value});
        else
            end();
    }
    end();
}

std::optional<double> at(const std::vector<double>& values, std::size_t i) {
    return i < values.size() ? std::optional(values[i]) : std::nullopt;
}

Plot plotOf(const TemporalCurves& curves, std::string title, std::string label) {
    Plot plot{.title = std::move(title), .x = frameAxis(curves), .y = {.label = std::move(label)}, .series = {}};
    if (curves.present >= plot.x.lo && curves.present <= plot.x.hi) {
        const double half = 0.002 * (plot.x.hi - plot.x.lo), x = curves.present;
        plot.bands.push_back({std::max(plot.x.lo, x - half), std::min(plot.x.hi, x + half), ""});
    }
    return plot;
}

std::string titled(const TemporalCurves& curves, const std::string& what, std::size_t run) {
    return curves.runs.size() > 1 ? what + ", " + curves.runs[run].name : what;
}

/// One curve per feature of a run; those of targets are dashed and have no names.
void addFeatures(Plot& plot, const TemporalCurves& curves, std::size_t run, std::vector<double> FrameFigures::*values) {
    const bool isTarget = values == &FrameFigures::targets;
    for (std::size_t i = 0; i < curves.features.size(); ++i)
        addCurve(plot, curves.runs[run], isTarget ? std::string() : curves.features[i],
                 i < curves.colors.size() ? curves.colors[i] : curveColor(i), isTarget,
                 [&](const FrameFigures& f) { return at(f.*values, i); });
}

/// One curve per run.
template <class ValueAt>
void addRuns(Plot& plot, const TemporalCurves& curves, const ValueAt& valueAt) {
    for (std::size_t r = 0; r < curves.runs.size(); ++r)
        addCurve(plot, curves.runs[r], curves.runs[r].name, curveColor(r), false, valueAt);
}

} // namespace

bool TemporalCurves::empty() const {
    return std::all_of(runs.begin(), runs.end(), [](const TemporalRun& run) {
        return std::all_of(run.frames.begin(), run.frames.end(),
                           [](const FrameFigures& f) { return !f.problem.empty(); });
    });
}

bool TemporalCurves::hasPictures() const {
    return std::ranges::any_of(runs, [](const TemporalRun& run) {
        return std::ranges::any_of(run.frames, [](const FrameFigures& f) { return !f.fs.empty(); });
    });
}

bool TemporalCurves::hasEnergies() const {
    return std::ranges::any_of(runs, [](const TemporalRun& run) {
        return std::ranges::any_of(run.frames, [](const FrameFigures& f) { return f.energy.has_value(); });
    });
}

Plot temporalVwsPlot(const TemporalCurves& curves, std::size_t run, double highest) {
    Plot plot = plotOf(curves, titled(curves, "Visibility-weighted saliency", run), "VWS");
    addFeatures(plot, curves, run, &FrameFigures::vws);
    addFeatures(plot, curves, run, &FrameFigures::targets);
    fitLinear(plot, 1);
    if (highest > 0) plot.y.hi = highest;
    return plot;
}

Plot temporalVisibilityPlot(const TemporalCurves& curves, std::size_t run) {
    Plot plot = plotOf(curves, titled(curves, "Feature visibility", run), "FV");
    addFeatures(plot, curves, run, &FrameFigures::visibility);
    fitLinear(plot, 1);
    return plot;
}

Plot temporalPicturePlot(const TemporalCurves& curves, std::size_t run) {
    Plot plot = plotOf(curves, titled(curves, "2D feature saliency", run), "2DFS");
    addFeatures(plot, curves, run, &FrameFigures::fs);
    fitLinear(plot, 1);
    return plot;
}

Plot temporalOpacityPlot(const TemporalCurves& curves, std::size_t run, bool logarithmic) {
    Plot plot = plotOf(curves, titled(curves, "Opacity of the peaks", run), "opacity per d0");
    addFeatures(plot, curves, run, &FrameFigures::opacity);
    logarithmic ? fitDecades(plot, kSmallestShown) : fitLinear(plot, 1);
    return plot;
}

Plot temporalObjectivePlot(const TemporalCurves& curves) {
    Plot plot = plotOf(curves, "Distance from the targets", "F");
    addRuns(plot, curves, [](const FrameFigures& f) { return std::optional(f.objective); });
    fitLinear(plot, 1);
    return plot;
}

Plot temporalFlickerPlot(const TemporalCurves& curves) {
    Plot plot = plotOf(curves, "Flicker", "mean delta E");
    addRuns(plot, curves, [](const FrameFigures& f) { return f.flicker; });
    fitLinear(plot, 200);
    return plot;
}

std::vector<Plot> temporalPlots(const TemporalCurves& curves) {
    std::vector<Plot> plots;
    double highest = 0;
    for (std::size_t r = 0; r < curves.runs.size(); ++r) highest = std::max(highest, temporalVwsPlot(curves, r).y.hi);
    for (std::size_t r = 0; r < curves.runs.size(); ++r) plots.push_back(temporalVwsPlot(curves, r, highest));
    plots.push_back(temporalObjectivePlot(curves));
    plots.push_back(temporalFlickerPlot(curves));
    for (std::size_t r = 0; r < curves.runs.size(); ++r) {
        plots.push_back(temporalVisibilityPlot(curves, r));
        if (curves.hasPictures()) plots.push_back(temporalPicturePlot(curves, r));
        plots.push_back(temporalOpacityPlot(curves, r));
    }
    return plots;
}

std::string csvOf(const TemporalCurves& curves) {
    CsvTable csv;
    for (const char* column : {"run", "frame", "file", "time", "F", "flicker", "moves", "seconds"}) csv << column;
    if (curves.hasEnergies()) csv << "energy";
    using Values = std::vector<double> FrameFigures::*;
    std::vector<std::pair<const char*, Values>> columns{{"VWS ", &FrameFigures::vws},
                                                        {"target ", &FrameFigures::targets},
                                                        {"FV ", &FrameFigures::visibility},
                                                        {"opacity ", &FrameFigures::opacity}};
    if (curves.hasPictures()) columns.emplace_back("2DFS ", &FrameFigures::fs);
    for (const std::string& feature : curves.features)
        for (const auto& [what, values] : columns) csv << what + feature;
    csv << "problem";
    csv.endLine();
    for (const TemporalRun& run : curves.runs)
        for (const FrameFigures& f : run.frames) {
            const auto when = [](bool known, double value) { return known ? std::optional(value) : std::nullopt; };
            csv << run.name << f.frame << f.file << f.time << when(f.problem.empty(), f.objective) << f.flicker
                << f.moves << when(f.moves.has_value(), f.seconds);
            if (curves.hasEnergies()) csv << f.energy;
            for (std::size_t i = 0; i < curves.features.size(); ++i)
                for (const auto& [what, values] : columns) csv << at(f.*values, i);
            csv << f.problem;
            csv.endLine();
        }
    return csv.text();
}

} // namespace pellucid
