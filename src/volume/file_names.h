// Files that are named together: by numbers, by wildcards, or by the folder they are in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// A path with a number in it.
struct NumberedName {
    std::string before, after;
    int width = 0;     ///< digits at least
    bool zeros = true; ///< filled with zeros up to `width`, else with blanks
    std::string with(std::int64_t number) const;
};

/// "f%03d.raw": one conversion d, i or u, with a width or none; "%%" is a percent sign. Empty for everything else.
std::optional<NumberedName> numberedName(const std::string& path);

/// The path of a "file:" URL, as other programs copy them; any other text as it is.
std::string pathOfUrl(const std::string& text);

/// Whether a path has a wildcard: * (any characters), ? (one), [abc], [a-z] (one of these), [!a-z] (none of these).
bool isGlob(const std::string& path);
bool matchesGlob(const std::string& pattern, const std::string& name);

/// The files that exist, in no order; none where the folder cannot be read. Hidden ones only for a pattern with a dot.
std::vector<std::string> filesNumbered(const NumberedName& pattern);
std::vector<std::string> filesMatching(const std::string& glob);
std::vector<std::string> filesIn(const std::string& folder);
/// Whether found() is true of a file in a folder, or in up to eight folders below each other, in no order; what follows
/// that file is not looked at.
bool anyFileBelow(const std::string& folder, const std::function<bool(const std::filesystem::directory_entry&)>& found);

/// Paths that differ in one number, ascending.
struct NumberedNames {
    NumberedName name;
    std::vector<std::int64_t> numbers;
};
/// Of sorted paths; empty where they differ in more than one number.
std::optional<NumberedNames> numberedNames(const std::vector<std::string>& paths);
/// Of sorted paths that `name` has made.
std::optional<NumberedNames> numberedBy(const NumberedName& name, const std::vector<std::string>& paths);

/// Numbers that are missing between those that rise in steps of `step`.
struct NumberGaps {
    std::int64_t step = 1;
    std::uint64_t missing = 0;
};
/// Of ascending numbers; empty where none is missing, or they rise unevenly.
std::optional<NumberGaps> gapsIn(const std::vector<std::int64_t>& numbers);
/// The names of files, without their folders: "a, b, c, d and 4 more".
std::string someNames(const std::vector<std::string>& paths);

/// ".nii.gz", ".raw": in lower case, with the dot; empty where there is none.
std::string volumeSuffix(const std::string& path);

/// Whether `a` comes before `b`, numbers in them counting as numbers: "f9" before "f10".
bool countsBefore(const std::string& a, const std::string& b);

} // namespace pellucid
