// Draws the pictures of a study, and measures what it asks about, before anyone sits down.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "render/engine_choice.h"
#include "study/study.h"

namespace pellucid {

struct PreparedStudy {
    Study study;
    std::vector<std::string> notices; ///< remarks of sessions and volumes, each with its stimulus
};

/// Draws each stimulus in the study's size before its background, measures VWS, feature visibility and 2D feature
/// saliency of its feature in that picture, and writes study.json and pictures/ID.png into the folder, which is made
/// where it is missing. Nothing is written before all is drawn. `engine`: in place of the sessions'. Throws Error with
/// the stimulus that is wrong, also where the folder has answers: they are to the pictures that are there. Throws
/// Cancelled.
PreparedStudy prepareStudy(const Study& study, const std::string& folder, std::optional<EngineChoice> engine = {},
                           const JobControl& job = {});

/// Throws Error where prepareStudy() would because of the folder.
void requireNoAnswers(const std::string& folder);

} // namespace pellucid
