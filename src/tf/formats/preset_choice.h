// One of several transfer functions in a JSON file.
#pragma once

#include <string>
#include <vector>

#include "base/json_value.h"

namespace pellucid {

class ForeignFile;

struct PresetChoice {
    JsonValue preset;
    std::vector<std::string> notices; ///< which of how many it is, where nobody has asked for it by name
};

/// The preset called ForeignFile::part() of those that `isPreset`, or the first: of a list, or the document itself.
/// Throws Error naming all where none is called so.
PresetChoice presetOf(const ForeignFile& file, bool (*isPreset)(const nlohmann::json&));

/// The same of names alone: which one is meant. `notices` gets what is to be said.
std::size_t presetNamed(const std::vector<std::string>& names, const ForeignFile& file,
                        std::vector<std::string>& notices);

} // namespace pellucid
