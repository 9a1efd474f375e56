#include "report/study_plots.h"

#include <algorithm>
#include <cmath>

#include "base/round_numbers.h"
#include "report/convergence.h"

namespace pellucid {

namespace {

PlotAxis opinionAxis() { return {.label = "mean opinion score", .lo = kLowestScore, .hi = kHighestScore}; }

/// From 0 to a little beyond the largest, as figures are shares.
PlotAxis figureAxis(const std::string& label, double largest) {
    return {.label = label, .lo = 0, .hi = largest > 0 ? std::min(1.0, 1.05 * largest) : 1};
}

std::vector<std::string> volumesOf(const StudyAnalysis& analysis) {
    std::vector<std::string> volumes;
    for (const Stimulus& stimulus : analysis.stimuli)
        if (std::ranges::find(volumes, volumeOf(stimulus)) == volumes.end()) volumes.push_back(volumeOf(stimulus));
    return volumes;
}

} // namespace

Plot opinionPlot(const StudyAnalysis& analysis, StudyMeasure measure) {
    const double found = analysis.predictions[static_cast<std::size_t>(measure)].of(CorrelationKind::Spearman).value;
    const std::string name = shortName(measure);
    Plot plot{.title = "MOS and " + name + (std::isnan(found) ? "" : ", rank correlation " + fixedText(found, 3)),
              .x = {},
              .y = opinionAxis(),
              .series = {}};
    const std::vector<std::string> volumes = volumesOf(analysis);
    for (std::size_t v = 0; v < volumes.size(); ++v)
        plot.series.push_back(
            {.name = volumes[v], .color = curveColor(v), .dotted = true, .points = {}, .joined = false});
    double largest = 0;
    for (const OpinionPoint& point : analysis.points) {
        const Stimulus& stimulus = analysis.stimulusOf(point);
        const std::optional<double>& figure = figureOf(stimulus, measure);
        if (!figure) continue;
        const auto v = static_cast<std::size_t>(std::ranges::find(volumes, volumeOf(stimulus)) - volumes.begin());
        plot.series[v].points.push_back({*figure, point.opinion.value, point.repeat});
        largest = std::max(largest, *figure);
    }
    plot.x = figureAxis(name, largest);
    return plot;
}

Plot featureOpinionPlot(const StudyAnalysis& analysis, const FeatureOpinions& feature) {
    PlotSeries series{.name = {}, .dotted = true, .points = {}};
    double largest = 0;
    for (const std::size_t p : feature.points) {
        const OpinionPoint& point = analysis.points[p];
        const Stimulus& stimulus = analysis.stimulusOf(point);
        if (!series.color) series.color = stimulus.color.value_or(curveColor(0));
        const double spread = point.opinion.interval.high - point.opinion.value;
        series.points.push_back({*stimulus.vws, point.opinion.value, point.repeat, std::isnan(spread) ? 0 : spread});
        largest = std::max(largest, *stimulus.vws);
    }
    return {.title = feature.volume + ", " + feature.word,
            .x = figureAxis("VWS", largest),
            .y = opinionAxis(),
            .series = {series}};
}

Plot consistencyPlot(const StudyAnalysis& analysis) {
    std::vector<const StudyParticipant*> order;
    for (const StudyParticipant& p : analysis.participants)
        if (p.pairs > 0) order.push_back(&p);
    std::ranges::stable_sort(order, {}, [](const StudyParticipant* p) { return p->meanDifference(); });
    PlotSeries series{.name = {}, .color = curveColor(0), .dotted = true, .points = {}, .joined = false};
    for (const StudyParticipant* p : order)
        series.points.push_back({static_cast<double>(series.points.size() + 1), p->meanDifference(), !p->counts()});
    const double last = static_cast<double>(order.size()) + 1;
    Plot plot{.title = "Differences between both scores of a repeated picture",
              .x = {.label = "participants, the most consistent first", .lo = 0, .hi = last, .whole = true},
              .y = {.label = "mean difference"},
              .series = {series}};
    if (!std::isnan(analysis.mostDifference))
        plot.series.push_back({.name = "tolerated",
                               .dashed = true,
                               .points = {{0, analysis.mostDifference}, {last, analysis.mostDifference}}});
    fitLinear(plot, kHighestScore - kLowestScore);
    return plot;
}

} // namespace pellucid
