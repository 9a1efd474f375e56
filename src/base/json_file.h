// JSON files as untrusted input: transfer functions, cameras.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace pellucid {

/// The document in a file. Throws FileError with the reason: no such file, wrong JSON, a number that no double holds,
/// values nested more than 64 deep (what works on documents recursively must not run out of stack).
nlohmann::json readJson(const std::string& path);
/// The same of the text of a file, which `path` names in messages.
nlohmann::json parseJson(const std::string& text, const std::string& path);

} // namespace pellucid
