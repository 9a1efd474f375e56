// A participant who presses keys as fast as he may, in a process of its own that tests can kill.
#pragma once

#include "study/study.h"

namespace pellucid::gui {

/// First argument of the test program: it plays the study of a folder (2nd) as a participant (3rd), and ends.
inline constexpr const char* kPlayStudy = "--play-study";

/// What he answers.
inline int scoreOf(const Stimulus& stimulus) { return 1 + static_cast<int>(stimulus.id.back() - '0') % 5; }

/// The exit status.
int playStudy(const std::string& folder, const std::string& participant);

} // namespace pellucid::gui
