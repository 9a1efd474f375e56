// `study analyze`: what came of a study, as figures, a page and a table.
#include <cmath>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/text.h"
#include "command_line.h"
#include "commands.h"
#include "output_files.h"
#include "parse.h"
#include "report/study_report.h"

namespace pellucid::cli {

namespace {

struct StudyAnalyzeArguments {
    std::string folder;
    StudyAnalysisOptions analysis;
    std::optional<std::string> out, csv;
};

std::string numberOr(double value, int decimals) { return std::isnan(value) ? "-" : fixedText(value, decimals); }

std::string participantsText(const StudyAnalysis& analysis) {
    Table table({"participant", "scores", "skipped", "repeated", "mean difference", "colour vision", "counts"});
    std::string excluded;
    for (const StudyParticipant& p : analysis.participants) {
        table.add({p.id, std::to_string(p.scores), std::to_string(p.skipped), std::to_string(p.pairs),
                   numberOr(p.meanDifference(), 2), name(p.colorVision), p.counts() ? "yes" : "no"});
        if (!p.counts()) excluded += p.id + " is left out: " + wordsOf(p, analysis.mostDifference) + "\n";
    }
    return table.text() + excluded;
}

std::string predictionsText(const StudyAnalysis& analysis) {
    Table table({"measure", "points", "Spearman", "low", "high", "p", "Kendall", "Pearson"});
    for (const MeasurePrediction& prediction : analysis.predictions) {
        const Correlation& c = prediction.of(CorrelationKind::Spearman);
        table.add({shortName(prediction.measure), std::to_string(prediction.points), numberOr(c.value, 4),
                   numberOr(c.interval.low, 4), numberOr(c.interval.high, 4), std::isnan(c.p) ? "-" : shortText(c.p),
                   numberOr(prediction.of(CorrelationKind::Kendall).value, 4),
                   numberOr(prediction.of(CorrelationKind::Pearson).value, 4)});
    }
    return table.text();
}

/// What is not known is left out.
void put(Json& json, const char* key, double value) {
    if (!std::isnan(value)) json[key] = value;
}
void putInterval(Json& json, const Interval& interval) {
    put(json, "low", interval.low);
    put(json, "high", interval.high);
}

Json participantsJson(const StudyAnalysis& analysis) {
    Json all = Json::array();
    for (const StudyParticipant& p : analysis.participants) {
        Json json{{"id", p.id},
                  {"simulated", p.isSimulated()},
                  {"color_vision", name(p.colorVision)},
                  {"scores", p.scores},
                  {"skipped", p.skipped},
                  {"pairs", p.pairs},
                  {"sum_difference", p.sumDifference}};
        put(json, "mean_difference", p.meanDifference());
        if (!p.counts()) json["excluded"] = name(p.exclusion);
        all.push_back(json);
    }
    return all;
}

Json pointsJson(const StudyAnalysis& analysis) {
    Json all = Json::array();
    for (const OpinionPoint& point : analysis.points) {
        const Stimulus& stimulus = analysis.stimulusOf(point);
        Json json{{"stimulus", stimulus.id}, {"volume", volumeOf(stimulus)},  {"feature", stimulus.feature},
                  {"repeat", point.repeat},  {"scores", point.opinion.count}, {"mos", point.opinion.value}};
        put(json, "deviation", point.opinion.deviation);
        putInterval(json, point.opinion.interval);
        for (const StudyMeasure measure : allOf<StudyMeasure>())
            if (const std::optional<double>& figure = figureOf(stimulus, measure)) json[name(measure)] = *figure;
        all.push_back(json);
    }
    return all;
}

Json correlationsJson(const StudyAnalysis& analysis) {
    Json all = Json::array();
    for (const MeasurePrediction& prediction : analysis.predictions) {
        Json json{{"measure", name(prediction.measure)}, {"points", prediction.points}};
        for (const CorrelationKind kind : allOf<CorrelationKind>()) {
            const Correlation& c = prediction.of(kind);
            if (std::isnan(c.value)) continue;
            Json& of = json[name(kind)] = {{"value", c.value}};
            put(of, "p", c.p);
            putInterval(of, c.interval);
        }
        all.push_back(json);
    }
    return all;
}

Json differencesJson(const StudyAnalysis& analysis) {
    Json all = Json::array();
    for (const PredictionDifference& d : analysis.differences) {
        if (std::isnan(d.value)) continue;
        Json json{{"first", name(d.first)}, {"second", name(d.second)}, {"points", d.points}, {"value", d.value}};
        putInterval(json, d.interval);
        all.push_back(json);
    }
    return all;
}

Json agreementJson(const StudyAnalysis& analysis) {
    Json json{{"raters", analysis.intraclass.raters}, {"points", analysis.intraclass.things}};
    put(json, "icc_single", analysis.intraclass.single);
    put(json, "icc_mean", analysis.intraclass.mean);
    put(json, "alpha", analysis.alpha);
    return json;
}

Answer answerOf(const StudyAnalyzeArguments& o, const StudyAnalysis& analysis) {
    std::string text = participantsText(analysis) + "\n" + predictionsText(analysis);
    for (const std::string& sentence : sentencesOf(analysis)) text += sentence + "\n";
    Json json{{"command", "study analyze"},        {"folder", o.folder},
              {"title", analysis.title},           {"counted", analysis.counted()},
              {"simulated", analysis.simulated()}, {"participants", participantsJson(analysis)}};
    put(json, "most_difference", analysis.mostDifference);
    json["points"] = pointsJson(analysis);
    json["correlations"] = correlationsJson(analysis);
    json["differences"] = differencesJson(analysis);
    json["agreement"] = agreementJson(analysis);
    Answer answer{std::move(text), std::move(json), analysis.remarks};
    if (const std::size_t simulated = analysis.simulated(); simulated > 0)
        answer.notices.push_back(std::to_string(simulated) + " of the participants who count " +
                                 (simulated == 1 ? "is" : "are") + " simulated");
    return answer;
}

Answer run(const StudyAnalyzeArguments& o, Progress& progress) {
    const Stopwatch total;
    StudyReport report = makeStudyReport(o.folder, o.analysis, progress.phase("analysis"));
    report.command = commandLine();
    report.program = std::string("Pellucid ") + PELLUCID_VERSION;
    Answer answer = answerOf(o, report.analysis);
    const auto write = [&](const std::string& path, const std::string& text) {
        writeTextAtomically(path, text);
        answer.text += "wrote " + path + "\n";
        answer.json["files"].push_back(path);
    };
    if (o.out) write(*o.out, htmlOf(report));
    if (o.csv) write(*o.csv, csvOf(report.analysis));
    answer.json["seconds"] = {{"total", total.seconds()}};
    return answer;
}

void checkSuffix(const std::string& path, const std::string& suffix, const std::string& option) {
    if (lowerCase(std::filesystem::path(path).extension().string()) != suffix)
        throw UsageError("the file is written as " + suffix, option, "give it this suffix");
}

} // namespace

Command addStudyAnalyze(CLI::App& study) {
    CLI::App* app = study.add_subcommand("analyze", "What came of a study: opinions, and what predicts them");
    const auto o = std::make_shared<StudyAnalyzeArguments>();
    app->add_option("DIR", o->folder, "the folder that a study was prepared into")->required()->type_name("");
    addOutputFile(*app, "--out", o->out, "write the report, one self-contained page: .html",
                  [](const std::string& path) { checkSuffix(path, ".html", "--out"); });
    addOutputFile(*app, "--csv", o->csv, "write the mean opinion and the figures of each picture: .csv",
                  [](const std::string& path) { checkSuffix(path, ".csv", "--csv"); });
    addRepeated(*app, "--exclude", "ID", o->analysis.exclude, anyText, "leave out this participant; may be repeated");
    app->add_flag("--keep-all", o->analysis.keepAll,
                  "leave out nobody because of colour vision or inconsistent scores");
    addValue(*app, "--seed", "N", o->analysis.bootstrap.seed, wholeFrom<std::uint32_t>(0, UINT32_MAX),
             "what the resamples of the intervals are drawn from (default 1)");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
