// Which engine is asked for, and how carefully it is to work: settings that say nothing of how.
#pragma once

#include <string>

#include "render/visibility.h"

namespace pellucid {

enum class EngineChoice { Auto, Gl, Cpu, Slices, Reference };

const char* name(EngineChoice choice);                      ///< "auto", "gl", "cpu", "slices", "reference"
EngineChoice engineChoiceFromName(const std::string& name); ///< throws UsageError

const char* name(Quality quality);                ///< "normal", "high"
Quality qualityFromName(const std::string& name); ///< throws UsageError

} // namespace pellucid
