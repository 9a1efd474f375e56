// One of several transfer functions in a file.
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

/// Their names, as distinctNames() has them. Throws Error where there is none.
std::vector<std::string> presetNames(const ForeignFile& file, bool (*isPreset)(const nlohmann::json&));

/// Names by which each can be asked for: what has none is "preset 2", counted from 1, and a second "a" is "a (2)".
std::vector<std::string> distinctNames(std::vector<std::string> names);

/// The same as presetOf() of distinct names alone: which one is meant. `notices` gets what is to be said.
std::size_t presetNamed(const std::vector<std::string>& names, const ForeignFile& file,
                        std::vector<std::string>& notices);

} // namespace pellucid
