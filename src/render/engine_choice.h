// Which engine is asked for, and how carefully it is to work: settings that say nothing of how.
#pragma once

#include "base/enum_names.h"
#include "render/visibility.h"

namespace pellucid {

enum class EngineChoice { Auto, Gl, Cpu, Slices, Reference };

template <>
inline constexpr auto kNamesOf<EngineChoice> = enumNames("engine", "auto", "gl", "cpu", "slices", "reference");

template <>
inline constexpr auto kNamesOf<Quality> = enumNames("quality", "normal", "high");

} // namespace pellucid
