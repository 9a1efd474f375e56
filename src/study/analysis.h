// What came of a study (thesis §4.5): mean opinion scores, whose answers count, and how well computed measures predict
// what people see.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/job.h"
#include "base/statistics.h"
#include "study/agreement.h"
#include "study/answers.h"
#include "study/study.h"

namespace pellucid {

/// What is compared with opinions.
enum class StudyMeasure {
    Vws,        ///< visibility-weighted saliency
    Visibility, ///< FV, feature visibility
    Fs          ///< 2DFS, 2D feature saliency of the picture
};
template <>
inline constexpr auto kNamesOf<StudyMeasure> = enumNames("measure", "vws", "visibility", "fs");

const char* shortName(StudyMeasure measure); ///< "VWS", "FV", "2DFS"
const std::optional<double>& figureOf(const Stimulus& stimulus, StudyMeasure measure);

/// What the volume of a stimulus is called: its title where the study was prepared, else the name of its file.
std::string volumeOf(const Stimulus& stimulus);

/// Those that are not for training, in their order.
std::vector<Stimulus> analysedStimuli(const Study& study);

struct StudyAnalysisOptions {
    std::vector<std::string> exclude; ///< participants that are left out by hand
    bool keepAll = false;             ///< no others are left out
    BootstrapOptions bootstrap;       ///< of all intervals but those of means, which have its confidence only
};

/// What simulated participants' ids begin with.
inline constexpr const char* kSimulatedPrefix = "simulated-";

/// Why somebody's answers do not count.
enum class Exclusion {
    None,        ///< they count
    NoScores,    ///< there are none
    ByHand,      ///< StudyAnalysisOptions::exclude
    ColorVision, ///< ColorVision::Deficient
    Inconsistent ///< repeated pictures were scored too differently, see mostDifferenceOf()
};
template <>
inline constexpr auto kNamesOf<Exclusion> = enumNames("exclusion", "none", "no scores", "by hand", "color vision",
                                                      "inconsistent");

/// A participant as the analysis sees it.
struct StudyParticipant {
    std::string id;
    ColorVision colorVision = ColorVision::NotSaid;
    std::size_t scores = 0;   ///< pictures that were given one, training not counted
    std::size_t skipped = 0;  ///< pictures that were seen and given none
    std::size_t pairs = 0;    ///< repeated pictures with both scores
    double sumDifference = 0; ///< Σ |first − second| over the pairs
    Exclusion exclusion = Exclusion::None;
    bool counts() const { return exclusion == Exclusion::None; }
    bool isSimulated() const { return id.starts_with(kSimulatedPrefix); }
    double meanDifference() const { return sumDifference / static_cast<double>(pairs); } ///< NaN without pairs
};

/// One point of the plots: a picture, or its repetition (which is a point of its own, as in fig 4.15).
struct OpinionPoint {
    std::size_t stimulus = 0; ///< index into StudyAnalysis::stimuli
    bool repeat = false;
    Mean opinion; ///< MOS, [1,5], over the participants that count
};

/// How well a measure predicts the opinions.
struct MeasurePrediction {
    StudyMeasure measure = StudyMeasure::Vws;
    std::size_t points = 0; ///< whose stimulus has the figure
    /// By CorrelationKind. p is over the points; the interval is over the stimuli, since the two points of one are not
    /// independent.
    std::array<Correlation, 3> correlations{};
    const Correlation& of(CorrelationKind kind) const { return correlations[static_cast<std::size_t>(kind)]; }
};

/// By how much Spearman's correlation of one measure is above that of another, over the points that have both.
struct PredictionDifference {
    StudyMeasure first = StudyMeasure::Vws, second = StudyMeasure::Visibility;
    std::size_t points = 0;
    double value = 0;  ///< NaN where either cannot be told
    Interval interval; ///< over the stimuli
};

/// The points of a feature of a volume (fig 4.15), by VWS; those without one are left out.
struct FeatureOpinions {
    std::string volume, feature, word;
    std::vector<std::size_t> points; ///< indices into StudyAnalysis::points
};

struct StudyAnalysis {
    std::string title;
    std::string question; ///< with "…" in the place of the feature
    BootstrapOptions bootstrap;
    std::vector<Stimulus> stimuli;              ///< without those of the training, in the study's order
    std::vector<StudyParticipant> participants; ///< as they were given
    bool keepAll = false;
    double mostDifference = 0; ///< a participant whose mean difference is above it is left out; NaN: nobody has pairs
    std::vector<OpinionPoint> points;              ///< in the order of stimuli, first showing before repetition
    std::vector<MeasurePrediction> predictions;    ///< of all measures
    std::vector<PredictionDifference> differences; ///< of each two of them
    std::vector<FeatureOpinions> features;         ///< in the order of stimuli
    IntraclassCorrelation intraclass;
    double alpha = 0;                 ///< Krippendorff's
    std::vector<std::string> remarks; ///< sentences: what could not be told, and why

    std::size_t counted() const;   ///< participants that are not left out
    std::size_t simulated() const; ///< of those
    const Stimulus& stimulusOf(const OpinionPoint& point) const { return stimuli[point.stimulus]; }
};

/// Fewer pictures with a figure tell no correlation.
inline constexpr std::size_t kLeastStimuli = 3;
/// Fewer pairs tell nothing of a participant's consistency.
inline constexpr std::size_t kLeastPairs = 3;
/// Differences of so much on average are anybody's.
inline constexpr double kToleratedDifference = 1;
/// max(kToleratedDifference, median + 3·1.4826·MAD) of the mean differences of those with kLeastPairs; NaN of none.
double mostDifferenceOf(std::span<const StudyParticipant> participants);

/// Throws UsageError for an excluded participant that there is not, and Error where no answers are left.
StudyAnalysis analyzeStudy(const Study& study, const std::vector<Participant>& participants,
                           const StudyAnalysisOptions& options = {}, const JobControl& job = {});

} // namespace pellucid
