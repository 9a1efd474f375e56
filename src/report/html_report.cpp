#include "report/html_report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/round_numbers.h"
#include "optimize/answer/visibility_words.h"
#include "report/convergence.h"
#include "report/csv.h"
#include "report/page_parts.h"
#include "report/page_style.h"
#include "report/share_bars.h"
#include "report/svg_plot.h"
#include "report/tf_plot.h"
#include "session/session.h"

namespace pellucid {

namespace {

std::vector<ShareBar> barsOf(const Report& report, const OptimizeState& state,
                             const std::vector<FeatureMeasures>& measures) {
    std::vector<ShareBar> bars;
    for (std::size_t f = 0; f < report.run.features.size(); ++f) {
        ShareBar bar{report.run.features[f],
                     f < report.tfBefore.features.size() ? report.tfBefore.features[f].color : curveColor(f),
                     state.vws[f],
                     {},
                     report.run.targets[f]};
        if (f < measures.size()) bar.visibility = measures[f].visibility;
        bars.push_back(bar);
    }
    return bars;
}

/// SSIM over the moves, and where §5.4 says that it should lie.
Plot ssimPlot(const Report& report) {
    Plot plot{.title = "Likeness to the answer", .x = {}, .y = {.label = "SSIM"}, .series = {}};
    PlotSeries series{.name = "SSIM", .color = curveColor(0), .dotted = true, .points = {}};
    double least = 1;
    for (const ReportState& s : report.states) {
        series.points.push_back({static_cast<double>(s.move), s.ssim, report.run.history[s.move].level > 0});
        least = std::min(least, s.ssim);
    }
    const std::array runs{RunCurve{&report.run, curveColor(0)}};
    plot.x = objectivePlot(runs).x;
    plot.y.lo = std::min(0.9, least - 0.05 * (1 - least));
    plot.series = {
        series,
        {.name = "0.99", .dashed = true, .points = {{0, ThresholdCheck::kAlike}, {plot.x.hi, ThresholdCheck::kAlike}}}};
    return plot;
}

std::string headline(const Run& run) {
    const std::string f = shortText(run.after), from = shortText(run.before),
                      moves = std::to_string(run.iterations) + (run.iterations == 1 ? " move" : " moves");
    const auto coarse = std::count_if(run.history.begin(), run.history.end(),
                                      [](const OptimizeState& state) { return state.level > 0; });
    const std::string before = coarse > 0 ? " after " + std::to_string(coarse) + " along rays" : "";
    const std::string figures = offTargetText(run.after) + " (F " + f + "), from " + percentText(run.before) + " (F " +
                                from + "), in " + moves + before;
    if (run.ended == "converged") return "On target: " + figures + ".";
    if (run.ended == "max-iterations") return "Stopped at the most moves allowed: " + figures + ".";
    if (run.ended == "visible") return "As near as it comes with a picture that can be seen: " + figures + ".";
    if (run.ended == "cancelled") return "Stopped by hand: " + figures + ".";
    return "As near as it came from this view: " + figures + ".";
}

std::string featureTable(const Report& report) {
    const Run& run = report.run;
    const OptimizeState &start = run.history.front(), &answer = run.history[run.best];
    std::string html =
        "<div class=\"wide\"><table><tr><th>Feature</th><th>Target</th><th>VWS before</th><th>VWS after</th>"
        "<th>Visibility before</th><th>Visibility after</th><th>2DFS before</th><th>2DFS after</th>"
        "<th>Opacity before</th><th>Opacity after</th><th>Bounds</th></tr>\n";
    const auto cell = [](const std::string& text) { return "<td>" + text + "</td>"; };
    for (std::size_t f = 0; f < run.features.size(); ++f) {
        const auto visibility = [&](const std::vector<FeatureMeasures>& measures) {
            return f < measures.size() ? fixedText(measures[f].visibility, 4) : std::string("–");
        };
        const auto share = [&](const std::vector<double>& fs) {
            return f < fs.size() ? fixedText(fs[f], 4) : std::string("–");
        };
        std::string bounds = "–";
        if (f < run.start->limits.size()) {
            const OpacityLimits& l = run.start->limits[f];
            if (l.locked)
                bounds = "locked";
            else if (l.lowest > 0 || l.highest < 1)
                bounds = shortText(l.lowest) + " to " + shortText(l.highest);
        }
        const Rgb color = f < report.tfBefore.features.size() ? report.tfBefore.features[f].color : curveColor(f);
        html += "<tr><td><span class=\"swatch\" style=\"background:" + hexFromRgb(color) + "\"></span>" +
                escapedXml(run.features[f]) + "</td>" + cell(fixedText(run.targets[f], 4)) +
                cell(fixedText(start.vws[f], 4)) + cell(fixedText(answer.vws[f], 4)) +
                cell(visibility(report.measuresBefore)) + cell(visibility(report.measuresAfter)) +
                cell(share(report.fsBefore)) + cell(share(report.fsAfter)) + cell(shortText(start.opacity[f])) +
                cell(shortText(answer.opacity[f])) + cell(bounds) + "</tr>\n";
    }
    return html +
           "</table></div>\n<p class=\"faint\">2DFS, 2D feature saliency: each feature's share of what catches the "
           "eye in the picture (thesis, appendix A).</p>\n";
}

std::string beforeAndAfter(const Report& report) {
    double mostShare = 0, mostOpacity = 0;
    const OptimizeState &start = report.run.history.front(), &answer = report.run.history[report.run.best];
    for (std::size_t f = 0; f < report.run.features.size(); ++f)
        mostShare = std::max({mostShare, start.vws[f], answer.vws[f], report.run.targets[f]});
    for (const auto* measures : {&report.measuresBefore, &report.measuresAfter})
        for (const FeatureMeasures& m : *measures) mostShare = std::max(mostShare, m.visibility);
    for (const TransferFunction* tf : {&report.tfBefore, &report.tfAfter})
        for (const ControlPoint& p : tf->points) mostOpacity = std::max(mostOpacity, p.opacity);
    mostShare = mostShare > 0 ? std::min(1.0, 1.05 * mostShare) : 1;
    mostOpacity = mostOpacity > 0 ? std::min(1.0, 1.05 * mostOpacity) : 1;

    const auto side = [&](const char* title, const ReportPicture& picture, const TransferFunction& tf,
                          const OptimizeState& state, const std::vector<FeatureMeasures>& measures,
                          const std::string& alt, const std::string& words) {
        const PlotPage page{.width = 480};
        return "<div><h3>" + std::string(title) + "</h3><figure>" +
               pictureElement(picture, alt.empty() ? title : std::string(title) + ": " + alt) +
               (words.empty() ? "" : "<figcaption>" + escapedXml(words) + "</figcaption>") + "</figure>\n" +
               plotFigure(tfPlot(tf, {report.window, report.unit, nullptr, mostOpacity}), 480, 220) + "<figure>" +
               svgElement(drawingOf(barsOf(report, state, measures), mostShare, page), "Shares of the features") +
               "</figure></div>\n";
    };
    return "<div class=\"pair\">\n" +
           side("Before", report.before, report.tfBefore, start, report.measuresBefore, report.altBefore,
                report.captionBefore) +
           side("After", report.after, report.tfAfter, answer, report.measuresAfter, report.altAfter,
                report.captionAfter) +
           "</div>\n<p class=\"faint\">Thick bars: visibility-weighted saliency (VWS), each feature's share of what "
           "catches "
           "the eye, and an upright line at its target. Thin bars: visibility, its share of what is seen at all. Both "
           "sides have the same scale.</p>\n";
}

std::string statesOf(const Report& report) {
    const Run& run = report.run;
    std::string html = "<div class=\"states\">\n";
    for (const ReportState& s : report.states) {
        const OptimizeState& state = run.history[s.move];
        const std::string what = (s.move == 0 ? std::string("start") : "move " + std::to_string(s.move)) +
                                 (state.level > 0 ? ", along rays" : "") + (s.move == run.best ? ", the answer" : "");
        html += std::string("<figure") + (s.move == run.best ? " class=\"answer\"" : "") + ">" +
                pictureElement(s.picture, what) + "<figcaption>" + what + "<br>F " + shortText(state.objective) +
                ", SSIM " + fixedText(s.ssim, 4) + "</figcaption></figure>\n";
    }
    html += "</div>\n";
    if (report.states.size() < run.history.size())
        html += "<p class=\"faint\">" + std::to_string(report.states.size()) + " of " +
                std::to_string(run.history.size()) + " states, evenly chosen.</p>\n";
    return html;
}

} // namespace

std::string htmlOf(const Report& report) {
    const Run& run = report.run;
    const std::string title = report.title + ": saliency optimization";
    std::string html = "<h1>" + escapedXml(title) + "</h1>\n<p class=\"said\">" + headline(run) + "</p>\n";
    for (const std::string& remark : report.remarks) html += "<p>" + escapedXml(remark) + "</p>\n";
    html += "<h2>Before and after</h2>\n" + beforeAndAfter(report) + featureTable(report);

    html += "<h2>Convergence</h2>\n<div class=\"pair\">\n";
    for (const Plot& plot : convergencePlots(run)) html += plotFigure(plot, 480, 300);
    html += plotFigure(ssimPlot(report), 480, 300) + "</div>\n";
    const Run* const pointer = &run;
    const std::string csv = csvOf(std::span(&pointer, 1));
    html += "<p class=\"faint\">F is the root mean square distance of the VWS from the targets; dashed lines are the "
            "tolerance and the targets. <a download=\"" +
            std::string(kCurvesFile) + "\" href=\"" + dataUri("text/csv", csv) + "\">The curves as a table</a></p>\n";

    html += "<h2>The states, and how alike they look</h2>\n<p>" + wordsOf(thresholdCheck(run, report.states)) +
            "</p>\n" + statesOf(report) +
            "<p class=\"faint\">SSIM: structural similarity of the picture of a state and that of the answer, of the "
            "luminance in windows of 11×11 pixels, before the pictures were made small.</p>\n";

    html += "<h2>Settings</h2>\n<table class=\"settings\">\n";
    for (const auto& [what, how] : report.settings)
        html += "<tr><td>" + escapedXml(what) + "</td><td>" + escapedXml(how) + "</td></tr>\n";
    html += "</table>\n<h2>To repeat it</h2>\n";
    if (report.session) html += "<p>In the folder of this page:</p>\n";
    html += "<pre><code>" + escapedXml(report.command) + "</code></pre>\n<p class=\"faint\">" +
            escapedXml(report.program) + "</p>\n";
    return htmlPage(title, plotStyle(), html);
}

} // namespace pellucid
