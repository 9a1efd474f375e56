#include "report/study_report.h"

#include <algorithm>
#include <cmath>

#include "base/csv.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "image_io/image_file.h"
#include "report/page_style.h"
#include "report/study_plots.h"
#include "report/svg_plot.h"

namespace pellucid {

namespace {

constexpr int kWidthOfPictures = 160; ///< at most, pixels

constexpr const char* kOwnStyle = R"(
.three{display:grid;grid-template-columns:repeat(auto-fit,minmax(17rem,1fr));gap:1.2rem}
td small{white-space:nowrap}
@media print{th,td{padding:.15rem .35rem}}
table.people td:first-child{white-space:nowrap}table.people th:last-child,table.people td:last-child{text-align:left}
table.stimuli img{width:7rem}table.stimuli tr{break-inside:avoid}
table.stimuli th:nth-child(-n+3),table.stimuli td:nth-child(-n+3){text-align:left}
)";

std::string counted(std::size_t count, const std::string& one, const std::string& several) {
    return std::to_string(count) + " " + (count == 1 ? one : several);
}

std::string numberOr(double value, int decimals) {
    return std::isnan(value) ? std::string("–") : fixedText(value, decimals);
}

std::string intervalText(const Interval& interval, int decimals) {
    if (std::isnan(interval.low)) return "–";
    return fixedText(interval.low, decimals) + " to " + fixedText(interval.high, decimals);
}

std::string withInterval(double value, const Interval& interval) {
    const std::string text = numberOr(value, 3);
    return std::isnan(interval.low) ? text : text + " (" + intervalText(interval, 3) + ")";
}

/// Two digits are enough.
std::string pText(double p) {
    if (p >= 0.1) return fixedText(p, 2);
    const double unit = std::pow(10, std::floor(std::log10(std::max(p, 1e-300))) - 1);
    return shortText(std::round(p / unit) * unit);
}

std::string figureText(const std::optional<double>& figure) { return figure ? fixedText(*figure, 4) : "–"; }

std::string cell(const std::string& text) { return "<td>" + escapedXml(text) + "</td>"; }
std::string row(const std::vector<std::string>& cells) { return "<tr>" + joined(cells, "", cell) + "</tr>\n"; }
std::string head(const std::vector<std::string>& cells) {
    return "<tr>" + joined(cells, "", [](const std::string& text) { return "<th>" + escapedXml(text) + "</th>"; }) +
           "</tr>\n";
}
std::string paragraph(const std::string& text) { return "<p>" + escapedXml(text) + "</p>\n"; }
std::string faint(const std::string& text) { return "<p class=\"faint\">" + escapedXml(text) + "</p>\n"; }

std::string confidenceText(const StudyAnalysis& analysis) {
    return shortText(100 * analysis.bootstrap.confidence) + " %";
}

std::string headline(const StudyAnalysis& analysis) {
    std::size_t scores = 0, seen = 0;
    for (const StudyParticipant& p : analysis.participants)
        if (p.counts()) scores += p.scores;
    for (std::size_t s = 0; s < analysis.stimuli.size(); ++s)
        seen += std::ranges::find(analysis.points, s, &OpinionPoint::stimulus) != analysis.points.end() ? 1 : 0;
    const std::size_t all = analysis.participants.size(), counts = analysis.counted();
    std::string text = counts == all ? counted(all, "participant", "participants")
                                     : std::to_string(counts) + " of " + counted(all, "participant", "participants");
    text += " gave " + counted(scores, "score", "scores") + " to " + counted(seen, "picture", "pictures");
    const auto repeats = static_cast<std::size_t>(std::ranges::count(analysis.points, true, &OpinionPoint::repeat));
    if (repeats > 0) text += ", " + std::to_string(repeats) + " of them shown twice";
    return text + ".";
}

std::string simulatedText(const StudyAnalysis& analysis) {
    const std::size_t simulated = analysis.simulated();
    if (simulated == 0) return "";
    const std::string who = simulated == analysis.counted()
                                ? "All of them are"
                                : std::to_string(simulated) + " of them " + (simulated == 1 ? "is" : "are");
    return who + " simulated: their answers were computed, and say nothing about people.";
}

std::string comparisonText(const PredictionDifference& d) {
    const bool isFirst = d.value >= 0;
    const std::string better = shortName(isFirst ? d.first : d.second), other = shortName(isFirst ? d.second : d.first);
    const std::string by = fixedText(std::abs(d.value), 3);
    const Interval of = isFirst ? d.interval : Interval{-d.interval.high, -d.interval.low};
    const std::string range = std::isnan(of.low) ? "" : " (" + intervalText(of, 3) + ")";
    if (std::isnan(of.low) || of.contains(0))
        return better + " and " + other + " cannot be told apart: the difference of their correlations is " + by +
               range + ".";
    return better + " predicts opinions better than " + other + ": its correlation is higher by " + by + range + ".";
}

std::string participantsPart(const StudyAnalysis& analysis) {
    std::string html = "<h2>Participants</h2>\n";
    const Plot plot = consistencyPlot(analysis);
    if (!plot.series.front().points.empty()) html += plotFigure(plot, 720, 280);
    html += "<div class=\"wide\"><table class=\"people\">\n" +
            head({"Participant", "Scores", "Skipped", "Repeated", "Sum of differences", "Mean difference",
                  "Colour vision", "Counts"});
    for (const StudyParticipant& p : analysis.participants)
        html += row({p.id, std::to_string(p.scores), std::to_string(p.skipped), std::to_string(p.pairs),
                     p.pairs > 0 ? fixedText(p.sumDifference, 0) : "–", numberOr(p.meanDifference(), 2),
                     name(p.colorVision), p.counts() ? "yes" : "no: " + wordsOf(p, analysis.mostDifference)});
    html += "</table></div>\n";
    if (analysis.keepAll) html += paragraph("Nobody is left out by a rule, as was asked for.");
    std::string agreement;
    if (const IntraclassCorrelation& icc = analysis.intraclass; !std::isnan(icc.mean))
        agreement = "How alike they answer: the intraclass correlation of single scores, ICC(2,1), is " +
                    fixedText(icc.single, 3) + ", and that of the means over " +
                    counted(icc.raters, "participant", "participants") + " who scored everything, ICC(2,k), is " +
                    fixedText(icc.mean, 3) + ". ";
    if (!std::isnan(analysis.alpha))
        agreement +=
            "Krippendorff's α of ordered scores, over all participants, is " + fixedText(analysis.alpha, 3) + ".";
    return agreement.empty() ? html : html + paragraph(agreement);
}

std::string correlationTable(const StudyAnalysis& analysis) {
    std::string html = "<div class=\"wide\"><table>\n" +
                       head({"Measure", "Points", "Spearman", "p", "Kendall τ-b", "p", "Pearson", "p", "Thesis"});
    for (const MeasurePrediction& prediction : analysis.predictions) {
        html += "<tr>" + cell(shortName(prediction.measure)) + cell(std::to_string(prediction.points));
        for (const CorrelationKind kind :
             {CorrelationKind::Spearman, CorrelationKind::Kendall, CorrelationKind::Pearson}) {
            const Correlation& c = prediction.of(kind);
            html += "<td>" + numberOr(c.value, 3) + "<br><small>" + intervalText(c.interval, 3) + "</small></td>" +
                    cell(std::isnan(c.p) ? "–" : pText(c.p));
        }
        html += cell(exactText(kThesisCorrelations[static_cast<std::size_t>(prediction.measure)])) + "</tr>\n";
    }
    return html + "</table></div>\n" +
           faint("Below each correlation its " + confidenceText(analysis) +
                 " interval. Thesis: Spearman's of §4.5.5, over 54 points of 29 participants, with p below 0.00002.");
}

std::string predictionsPart(const StudyAnalysis& analysis) {
    std::string html = "<h2>What predicts opinions</h2>\n";
    for (const std::string& sentence : sentencesOf(analysis)) html += paragraph(sentence);
    html += correlationTable(analysis) + "<div class=\"three\">\n";
    for (const StudyMeasure measure : allOf<StudyMeasure>())
        html += plotFigure(opinionPlot(analysis, measure), 340, 320);
    return html + "</div>\n" +
           faint(
               "As figure 4.14. VWS: visibility-weighted saliency; FV: feature visibility; 2DFS: 2D feature saliency. "
               "Hollow: a picture's second showing.");
}

std::string featuresPart(const StudyAnalysis& analysis) {
    if (analysis.features.empty()) return "";
    std::string html = "<h2>Feature by feature</h2>\n<div class=\"three\">\n";
    for (const FeatureOpinions& feature : analysis.features)
        html += plotFigure(featureOpinionPlot(analysis, feature), 340, 240);
    return html + "</div>\n" +
           faint("As figure 4.15: mean opinions with their " + confidenceText(analysis) +
                 " intervals, in the order of VWS. Hollow: a picture's second showing.");
}

/// The point of a showing; null where nobody has scored it.
const OpinionPoint* pointOf(const StudyAnalysis& analysis, std::size_t stimulus, bool repeat) {
    const auto at = std::ranges::find_if(
        analysis.points, [&](const OpinionPoint& p) { return p.stimulus == stimulus && p.repeat == repeat; });
    return at == analysis.points.end() ? nullptr : &*at;
}

std::string opinionText(const OpinionPoint* point) {
    if (point == nullptr) return "–";
    const double spread = point->opinion.interval.high - point->opinion.value;
    return fixedText(point->opinion.value, 2) + (std::isnan(spread) ? "" : " ± " + fixedText(spread, 2)) + " (" +
           std::to_string(point->opinion.count) + ")";
}

std::string stimuliPart(const StudyReport& report) {
    const StudyAnalysis& analysis = report.analysis;
    std::string html = "<h2>Pictures</h2>\n<div class=\"wide\"><table class=\"stimuli\">\n" +
                       head({"Picture", "Stimulus", "Feature", "MOS", "MOS, second showing", "VWS", "FV", "2DFS"});
    for (std::size_t s = 0; s < analysis.stimuli.size(); ++s) {
        const Stimulus& stimulus = analysis.stimuli[s];
        const std::string swatch =
            stimulus.color ? "<span class=\"swatch\" style=\"background:" + hexFromRgb(*stimulus.color) + "\"></span>"
                           : "";
        const std::string picture =
            report.pictures[s].png.empty() ? "–" : pictureElement(report.pictures[s], "Picture " + stimulus.id);
        html += "<tr><td>" + picture + "</td><td>" + escapedXml(stimulus.id) + "<br><small>" +
                escapedXml(volumeOf(stimulus)) + "</small></td><td>" + swatch + escapedXml(stimulus.word()) + "</td>" +
                cell(opinionText(pointOf(analysis, s, false))) + cell(opinionText(pointOf(analysis, s, true))) +
                cell(figureText(stimulus.vws)) + cell(figureText(stimulus.visibility)) + cell(figureText(stimulus.fs)) +
                "</tr>\n";
    }
    return html + "</table></div>\n" +
           faint("MOS: mean opinion score, 1 to 5, ± half of its " + confidenceText(analysis) +
                 " interval, and in brackets how many scores there are.");
}

std::string methodsPart(const StudyAnalysis& analysis) {
    const std::string most =
        std::isnan(analysis.mostDifference) ? "" : ", here " + fixedText(analysis.mostDifference, 2);
    const std::vector<std::pair<std::string, std::string>> methods{
        {"Mean opinion score",
         "The mean of the scores that those who count gave to one showing of a picture, with the " +
             confidenceText(analysis) + " interval of Student's t."},
        {"Consistency",
         "The absolute differences between both scores of each repeated picture, added up and as a mean."},
        {"Left out", "Those who report a colour vision deficiency, and those who have at least " +
                         std::to_string(kLeastPairs) +
                         " repeated pictures and a mean difference above the median of all participants plus 3 · "
                         "1.4826 times the median absolute deviation, at least " +
                         shortText(kToleratedDifference) + most + "."},
        {"Correlations",
         "Each showing is one point. p is two-sided: exact for Spearman of up to 9 points and Kendall of "
         "fewer than 50 where none are equal, else by Student's t and the normal distribution."},
        {"Intervals of correlations", "Percentiles over " + std::to_string(analysis.bootstrap.resamples) +
                                          " resamples of the pictures, each with all of its points, from seed " +
                                          std::to_string(analysis.bootstrap.seed) + "."},
        {"Agreement", "ICC(2,1) and ICC(2,k) after Shrout and Fleiss, of participants who scored every point; "
                      "Krippendorff's α with the ordinal metric, of all who count."}};
    std::string html = "<h2>Methods</h2>\n<table class=\"settings\">\n";
    for (const auto& [what, how] : methods) html += row({what, how});
    return html + "</table>\n";
}

ReportPicture smallPicture(const Stimulus& stimulus, std::vector<std::string>& remarks) {
    try {
        return encoded(reduced(readImage(stimulus.picture), kWidthOfPictures));
    } catch (const Error& e) {
        remarks.push_back("The picture of " + stimulus.id + " cannot be shown: " + e.problem() + ".");
        return {};
    }
}

} // namespace

StudyReport makeStudyReport(const std::string& folder, const StudyAnalysisOptions& options, const JobControl& job) {
    const Study study = readPreparedStudy(folder);
    StudyReport report;
    report.analysis = analyzeStudy(study, readParticipants(folder), options, job.part(0, 2));
    const std::vector<Stimulus>& stimuli = report.analysis.stimuli;
    for (std::size_t s = 0; s < stimuli.size(); ++s) {
        job.throwIfStopped();
        report.pictures.push_back(smallPicture(stimuli[s], report.analysis.remarks));
        job.part(1, 2).report(static_cast<double>(s + 1) / static_cast<double>(stimuli.size()));
    }
    return report;
}

std::string htmlOf(const StudyReport& report) {
    const StudyAnalysis& analysis = report.analysis;
    std::string html =
        "<h1>" + escapedXml(analysis.title) + "</h1>\n<p class=\"said\">" + escapedXml(headline(analysis)) + "</p>\n";
    if (const std::string text = simulatedText(analysis); !text.empty())
        html += "<p class=\"said\">" + escapedXml(text) + "</p>\n";
    html += paragraph("They were asked: “" + analysis.question + "”");
    for (const std::string& remark : analysis.remarks) html += paragraph(remark);
    html += predictionsPart(analysis) + featuresPart(analysis) + participantsPart(analysis) + stimuliPart(report) +
            "<p class=\"faint\"><a download=\"points.csv\" href=\"" + dataUri("text/csv", csvOf(analysis)) +
            "\">All points as a table</a></p>\n" + methodsPart(analysis);
    html += "<h2>To repeat it</h2>\n";
    if (report.liesWithStudy) html += "<p>In the folder of this page:</p>\n";
    html += "<pre><code>" + escapedXml(report.command) + "</code></pre>\n";
    html += faint(report.program);
    return htmlPage(analysis.title, plotStyle() + kOwnStyle, html);
}

std::string csvOf(const StudyAnalysis& analysis) {
    CsvTable csv;
    for (const char* column : {"stimulus", "volume", "feature", "word", "repeat", "scores", "mos", "deviation", "low",
                               "high", "vws", "fv", "2dfs"})
        csv << column;
    csv.endLine();
    const auto known = [](double value) { return std::isnan(value) ? std::nullopt : std::optional(value); };
    for (const OpinionPoint& point : analysis.points) {
        const Stimulus& stimulus = analysis.stimulusOf(point);
        csv << stimulus.id << volumeOf(stimulus) << stimulus.feature << stimulus.word() << (point.repeat ? 1 : 0)
            << static_cast<int>(point.opinion.count) << point.opinion.value << known(point.opinion.deviation)
            << known(point.opinion.interval.low) << known(point.opinion.interval.high);
        for (const StudyMeasure measure : allOf<StudyMeasure>()) csv << figureOf(stimulus, measure);
        csv.endLine();
    }
    return csv.text();
}

std::vector<std::string> sentencesOf(const StudyAnalysis& analysis) {
    std::vector<std::string> sentences, found;
    for (const MeasurePrediction& prediction : analysis.predictions)
        if (const Correlation& c = prediction.of(CorrelationKind::Spearman); !std::isnan(c.value))
            found.push_back(withInterval(c.value, c.interval) + " for " + shortName(prediction.measure));
    if (!found.empty())
        sentences.push_back("Spearman's rank correlation with the mean opinion score, and its " +
                            confidenceText(analysis) + " interval, is " + joined(found) + ".");
    for (const PredictionDifference& difference : analysis.differences)
        if (!std::isnan(difference.value)) sentences.push_back(comparisonText(difference));
    return sentences;
}

std::string wordsOf(const StudyParticipant& participant, double mostDifference) {
    switch (participant.exclusion) {
    case Exclusion::None:
        return "";
    case Exclusion::NoScores:
        return "there is no score";
    case Exclusion::ByHand:
        return "left out by hand";
    case Exclusion::ColorVision:
        return "colour vision is deficient";
    case Exclusion::Inconsistent:
        return "the scores of repeated pictures differ by " + fixedText(participant.meanDifference(), 2) +
               " on average, more than " + fixedText(mostDifference, 2);
    }
    return "";
}

} // namespace pellucid
