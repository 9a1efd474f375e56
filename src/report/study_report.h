// What came of a study, for readers: one page with opinions, pictures and predictions (thesis §4.5; docs/guide.md,
// "Studies").
#pragma once

#include <string>
#include <vector>

#include "base/job.h"
#include "report/page_parts.h"
#include "study/analysis.h"

namespace pellucid {

struct StudyReport {
    StudyAnalysis analysis;
    std::vector<ReportPicture> pictures; ///< of the stimuli, small; without bytes where the file cannot be read
    std::string command;                 ///< what repeats it, as typed into a shell
    bool liesWithStudy = false;          ///< the page is in the study's folder, where `command` is to be typed
    std::string program;                 ///< and its version
};

/// Reads and analyses the study that was prepared into a folder, and its answers. `command` and `program` are for the
/// caller to fill in. Throws Error and Cancelled.
StudyReport makeStudyReport(const std::string& folder, const StudyAnalysisOptions& options, const JobControl& job = {});

/// A self-contained HTML page. Every text is escaped.
std::string htmlOf(const StudyReport& report);

/// A line per point: stimulus, volume, feature, what the question called it, repeat (0 or 1), scores (how many), MOS,
/// its standard deviation and interval, VWS, FV and 2DFS. What is not known is empty. Numbers with all their digits.
std::string csvOf(const StudyAnalysis& analysis);

/// "Spearman's rank correlation with the mean opinion score, … is 0.675 (0.48 to 0.81) for VWS, …" and which of the
/// measures can be told apart, in sentences; for the page and for people at a terminal.
std::vector<std::string> sentencesOf(const StudyAnalysis& analysis);
/// Why a participant's answers do not count, in words; empty where they do.
std::string wordsOf(const StudyParticipant& participant, double mostDifference);

/// What the thesis found with 29 participants and 54 points (§4.5.5), by measure.
inline constexpr std::array<double, 3> kThesisCorrelations{0.67508, 0.678626, 0.550472};

} // namespace pellucid
