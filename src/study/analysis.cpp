#include "study/analysis.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "base/text.h"

namespace pellucid {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A showing of a stimulus: its index, and whether it is the second.
using Showing = std::pair<std::size_t, bool>;

/// Whose picture was given which score; the last where a file has several.
struct Scored {
    StudyParticipant who;
    std::map<Showing, std::optional<int>> scores;
};

/// `strangers` counts answers about pictures that the study does not have.
Scored scoredOf(const Participant& participant, const std::vector<Stimulus>& stimuli, std::size_t& strangers) {
    Scored scored{{.id = participant.id, .colorVision = participant.colorVision}, {}};
    for (const Answer& answer : participant.answers) {
        if (answer.training) continue;
        const auto at = std::ranges::find(stimuli, answer.stimulus, &Stimulus::id);
        if (at == stimuli.end())
            ++strangers;
        else
            scored.scores[{static_cast<std::size_t>(at - stimuli.begin()), answer.repeat}] = answer.score;
    }
    for (const auto& [showing, score] : scored.scores) {
        ++(score ? scored.who.scores : scored.who.skipped);
        const auto second = scored.scores.find({showing.first, true});
        if (showing.second || !score || second == scored.scores.end() || !second->second) continue;
        ++scored.who.pairs;
        scored.who.sumDifference += std::abs(*score - *second->second);
    }
    return scored;
}

void exclude(StudyParticipant& who, const StudyAnalysisOptions& options, double mostDifference) {
    if (who.scores == 0)
        who.exclusion = Exclusion::NoScores;
    else if (std::ranges::count(options.exclude, who.id) > 0)
        who.exclusion = Exclusion::ByHand;
    else if (!options.keepAll && who.colorVision == ColorVision::Deficient)
        who.exclusion = Exclusion::ColorVision;
    else if (!options.keepAll && who.pairs >= kLeastPairs && who.meanDifference() > mostDifference)
        who.exclusion = Exclusion::Inconsistent;
}

void requireKnown(const std::vector<std::string>& excluded, const std::vector<Participant>& participants) {
    for (const std::string& id : excluded)
        if (std::ranges::find(participants, id, &Participant::id) == participants.end())
            throw UsageError("there is no participant '" + id + "'", "participants to leave out",
                             "give one of " + joined(participants, ", ", &Participant::id));
}

/// Points and the scores behind them: a row per point, a column per participant that counts.
void addPoints(StudyAnalysis& analysis, ScoreTable& table, const std::vector<Scored>& all) {
    for (std::size_t s = 0; s < analysis.stimuli.size(); ++s)
        for (const bool repeat : {false, true}) {
            std::vector<std::optional<double>> row;
            std::vector<double> scores;
            for (const Scored& one : all) {
                if (!one.who.counts()) continue;
                const auto found = one.scores.find({s, repeat});
                row.push_back(found == one.scores.end() ? std::nullopt : found->second);
                if (row.back()) scores.push_back(*row.back());
            }
            if (scores.empty()) continue;
            table.push_back(std::move(row));
            analysis.points.push_back({s, repeat, meanOf(scores, analysis.bootstrap.confidence)});
        }
}

/// Opinions and the figures of some measures at the points that have all of them.
struct Series {
    std::vector<double> opinions;
    std::vector<std::vector<double>> figures;      ///< per measure
    std::vector<std::vector<std::size_t>> stimuli; ///< the places of each one's points
};

Series seriesOf(const StudyAnalysis& analysis, const std::vector<StudyMeasure>& measures) {
    Series series{.opinions = {}, .figures = std::vector<std::vector<double>>(measures.size()), .stimuli = {}};
    std::map<std::size_t, std::vector<std::size_t>> places;
    for (const OpinionPoint& point : analysis.points) {
        const Stimulus& stimulus = analysis.stimulusOf(point);
        if (!std::ranges::all_of(measures, [&](StudyMeasure m) { return figureOf(stimulus, m).has_value(); })) continue;
        places[point.stimulus].push_back(series.opinions.size());
        series.opinions.push_back(point.opinion.value);
        for (std::size_t m = 0; m < measures.size(); ++m) series.figures[m].push_back(*figureOf(stimulus, measures[m]));
    }
    for (auto& [stimulus, of] : places) series.stimuli.push_back(std::move(of));
    return series;
}

/// All points of the drawn stimuli.
Series resampled(const Series& series, std::span<const std::size_t> drawn) {
    Series picked{.opinions = {}, .figures = std::vector<std::vector<double>>(series.figures.size()), .stimuli = {}};
    for (const std::size_t stimulus : drawn)
        for (const std::size_t place : series.stimuli[stimulus]) {
            picked.opinions.push_back(series.opinions[place]);
            for (std::size_t m = 0; m < series.figures.size(); ++m)
                picked.figures[m].push_back(series.figures[m][place]);
        }
    return picked;
}

MeasurePrediction predictionOf(const StudyAnalysis& analysis, StudyMeasure measure) {
    const Series series = seriesOf(analysis, {measure});
    MeasurePrediction prediction{.measure = measure, .points = series.opinions.size()};
    for (const CorrelationKind kind : allOf<CorrelationKind>()) {
        Correlation& found = prediction.correlations[static_cast<std::size_t>(kind)];
        found = {kNone, kNone, {}};
        if (series.stimuli.size() < kLeastStimuli) continue;
        found = correlation(kind, series.opinions, series.figures[0], {.resamples = 0});
        found.interval = bootstrapInterval(
            series.stimuli.size(),
            [&](std::span<const std::size_t> drawn) {
                const Series picked = resampled(series, drawn);
                return coefficient(kind, picked.opinions, picked.figures[0]);
            },
            analysis.bootstrap);
    }
    return prediction;
}

PredictionDifference differenceOf(const StudyAnalysis& analysis, StudyMeasure first, StudyMeasure second) {
    const Series series = seriesOf(analysis, {first, second});
    PredictionDifference difference{
        .first = first, .second = second, .points = series.opinions.size(), .value = kNone, .interval = {}};
    if (series.stimuli.size() < kLeastStimuli) return difference;
    const auto spearman = [](const Series& of, std::size_t m) {
        return coefficient(CorrelationKind::Spearman, of.opinions, of.figures[m]);
    };
    difference.value = spearman(series, 0) - spearman(series, 1);
    difference.interval = bootstrapInterval(
        series.stimuli.size(),
        [&](std::span<const std::size_t> drawn) {
            const Series picked = resampled(series, drawn);
            return spearman(picked, 0) - spearman(picked, 1);
        },
        analysis.bootstrap);
    return difference;
}

std::vector<FeatureOpinions> featuresOf(const StudyAnalysis& analysis) {
    std::vector<FeatureOpinions> features;
    for (std::size_t p = 0; p < analysis.points.size(); ++p) {
        const Stimulus& stimulus = analysis.stimulusOf(analysis.points[p]);
        if (!stimulus.vws) continue;
        const std::string volume = volumeOf(stimulus);
        const auto known = std::ranges::find_if(
            features, [&](const FeatureOpinions& f) { return f.volume == volume && f.feature == stimulus.feature; });
        FeatureOpinions& feature =
            known != features.end()
                ? *known
                : features.emplace_back(FeatureOpinions{volume, stimulus.feature, stimulus.word(), {}});
        feature.points.push_back(p);
    }
    for (FeatureOpinions& feature : features)
        std::ranges::stable_sort(feature.points, {},
                                 [&](std::size_t p) { return *analysis.stimulusOf(analysis.points[p]).vws; });
    return features;
}

void addRemarks(StudyAnalysis& analysis, std::size_t strangers) {
    if (strangers > 0)
        analysis.remarks.push_back(
            std::to_string(strangers) +
            (strangers == 1 ? " answer is about a picture that the study does not have, and is left out."
                            : " answers are about pictures that the study does not have, and are left out."));
    for (const MeasurePrediction& prediction : analysis.predictions) {
        const std::string name = shortName(prediction.measure);
        const Series series = seriesOf(analysis, {prediction.measure});
        const std::size_t stimuli = series.stimuli.size(), without = analysis.points.size() - prediction.points;
        if (stimuli < kLeastStimuli)
            analysis.remarks.push_back("Only " + std::to_string(stimuli) + " scored pictures have a value of " + name +
                                       ": there is no correlation of fewer than " + std::to_string(kLeastStimuli) +
                                       ".");
        else if (std::isnan(prediction.of(CorrelationKind::Spearman).value))
            analysis.remarks.push_back("All opinions, or all values of " + name +
                                       ", are equal: there is no correlation.");
        else if (without > 0)
            analysis.remarks.push_back(std::to_string(without) +
                                       (without == 1 ? " point has no value of " : " points have no value of ") + name +
                                       (without == 1 ? " and is" : " and are") + " left out of its correlation.");
    }
}

} // namespace

const char* shortName(StudyMeasure measure) {
    static constexpr std::array<const char*, 3> kNames{"VWS", "FV", "2DFS"};
    return kNames[static_cast<std::size_t>(measure)];
}

const std::optional<double>& figureOf(const Stimulus& stimulus, StudyMeasure measure) {
    return measure == StudyMeasure::Vws          ? stimulus.vws
           : measure == StudyMeasure::Visibility ? stimulus.visibility
                                                 : stimulus.fs;
}

std::string volumeOf(const Stimulus& stimulus) {
    if (!stimulus.data.empty()) return stimulus.data;
    return std::filesystem::path(stimulus.volume.empty() ? stimulus.session : stimulus.volume).filename().string();
}

std::vector<Stimulus> analysedStimuli(const Study& study) {
    std::vector<Stimulus> stimuli;
    std::ranges::copy_if(study.stimuli, std::back_inserter(stimuli), [](const Stimulus& s) { return !s.training; });
    return stimuli;
}

std::size_t StudyAnalysis::counted() const {
    return static_cast<std::size_t>(std::ranges::count_if(participants, &StudyParticipant::counts));
}

std::size_t StudyAnalysis::simulated() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(participants, [](const auto& p) { return p.counts() && p.isSimulated(); }));
}

double mostDifferenceOf(std::span<const StudyParticipant> participants) {
    std::vector<double> differences;
    for (const StudyParticipant& p : participants)
        if (p.pairs >= kLeastPairs) differences.push_back(p.meanDifference());
    if (differences.empty()) return kNone;
    const double middle = median(differences);
    for (double& d : differences) d = std::abs(d - middle);
    // 1.4826 makes the median absolute deviation the standard deviation where the distribution is normal.
    return std::max(kToleratedDifference, middle + 3 * 1.4826 * median(differences));
}

StudyAnalysis analyzeStudy(const Study& study, const std::vector<Participant>& participants,
                           const StudyAnalysisOptions& options, const JobControl& job) {
    if (participants.empty()) throw Error("nobody has taken part yet", study.title, "run the study first");
    requireKnown(options.exclude, participants);
    StudyAnalysis analysis;
    analysis.title = study.title;
    Stimulus any;
    any.label = "…";
    analysis.question = study.questionOf(any);
    analysis.bootstrap = options.bootstrap;
    analysis.stimuli = analysedStimuli(study);
    analysis.keepAll = options.keepAll;
    std::size_t strangers = 0;
    std::vector<Scored> all;
    for (const Participant& participant : participants)
        all.push_back(scoredOf(participant, analysis.stimuli, strangers));
    for (const Scored& one : all) analysis.participants.push_back(one.who);
    analysis.mostDifference = mostDifferenceOf(analysis.participants);
    for (std::size_t i = 0; i < all.size(); ++i) {
        exclude(all[i].who, options, analysis.mostDifference);
        analysis.participants[i] = all[i].who;
    }
    if (analysis.counted() == 0)
        throw Error("no participant's answers are left", study.title,
                    "exclude fewer, or run the study with more people");

    ScoreTable table;
    addPoints(analysis, table, all);
    analysis.intraclass = intraclassCorrelation(table);
    analysis.alpha = krippendorffAlpha(table);
    analysis.features = featuresOf(analysis);
    constexpr auto measures = allOf<StudyMeasure>();
    for (std::size_t i = 0; i < measures.size(); ++i) {
        job.throwIfStopped();
        analysis.predictions.push_back(predictionOf(analysis, measures[i]));
        for (std::size_t j = i + 1; j < measures.size(); ++j)
            analysis.differences.push_back(differenceOf(analysis, measures[i], measures[j]));
        job.report(static_cast<double>(i + 1) / static_cast<double>(measures.size()));
    }
    addRemarks(analysis, strangers);
    return analysis;
}

} // namespace pellucid
