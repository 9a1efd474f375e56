// What programs print beside what documents show of it.
#pragma once

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

namespace pellucid::test {

using Lines = std::vector<std::string>;
Lines linesOf(const std::string& text);
std::string textOf(const std::filesystem::path& path); ///< of a file; empty where there is none

/// A number and s, ms or µs.
extern const std::regex kTime;
std::string timeless(const std::string& line); ///< with all times the same

/// Times are not compared; other numbers are the same, and those with decimals may differ by one in the last digit.
bool sameLine(const std::string& shown, const std::string& printed);

} // namespace pellucid::test
