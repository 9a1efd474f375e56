// In which order a participant sees the stimuli of a study.
#pragma once

#include <string>
#include <vector>

#include "study/study.h"

namespace pellucid {

struct PlannedTrial {
    int trial = 1; ///< its number, from 1
    bool training = false;
    std::size_t stimulus = 0; ///< in Study::stimuli
    bool repeat = false;      ///< shown the second time
    bool operator==(const PlannedTrial&) const = default;
};

/// Training in the order of the study, then each other stimulus once and Study::repeats of them a second time, in an
/// order that seed and participant decide, on every machine the same. Which are repeated is decided by the seed alone:
/// every participant sees the same ones twice. Between both showings there is at least one other.
std::vector<PlannedTrial> planOf(const Study& study, const std::string& participant);

/// Whether a participant may rest before the trial at `index` of the plan: after Study::pauseEvery trials since the
/// training, and before the first one after it.
bool isPauseBefore(const Study& study, const std::vector<PlannedTrial>& plan, std::size_t index);

} // namespace pellucid
