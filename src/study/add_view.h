// A view that somebody has in front of him, as a stimulus of a study.
#pragma once

#include <string>

#include "session/session.h"
#include "study/study.h"

namespace pellucid {

/// What of the view is asked about.
struct AskedFeature {
    std::string feature, label; ///< as Stimulus has them
    bool training = false;
};

/// Saves the session beside the study, as NAME-ID.pellucid.json, and adds it to the study, which is made where there is
/// none. Returns the study as it is on the disk now. Throws Error.
Study addViewToStudy(const std::string& studyPath, const Session& session, const AskedFeature& asked);

} // namespace pellucid
