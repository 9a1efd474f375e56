// Participants who are computed: to rehearse a study, and to see that its analysis gives back what was planted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/job.h"
#include "study/analysis.h"

namespace pellucid {

struct SimulationOptions {
    int participants = 30;
    StudyMeasure measure = StudyMeasure::Vws; ///< that their opinions follow
    double correlation = 0.7;                 ///< Spearman's of opinions and measure over the pictures, [−1, 1]
    /// Standard deviation of a score around the opinion, ≥ 0; participants as such lie half of it above or below.
    double noise = 0.7;
    std::uint32_t seed = 1;
};

/// Opinions in [1.5, 4.5] about things with these figures, evenly spread, whose rank correlation with them is as near
/// to `correlation` as their number allows. Throws Error where there are fewer than kLeastStimuli, or all are equal.
std::vector<double> plantedOpinions(const std::vector<double>& figures, double correlation, std::uint32_t seed);

/// Takes part in the study that was prepared into a folder, as kSimulatedPrefix and a number, the first ones that are
/// free; who is simulated answers every trial at once. Returns their ids. Throws Error where a stimulus has no figure,
/// and Cancelled.
std::vector<std::string> simulateParticipants(const std::string& folder, const SimulationOptions& options,
                                              const JobControl& job = {});

} // namespace pellucid
