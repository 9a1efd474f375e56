// Texts of files and messages: words, numbers, sizes.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pellucid {

/// "512 bytes", "1.50 GB" (powers of 1000).
std::string describeBytes(std::uint64_t bytes);

/// A text from somewhere else as it can be shown on a line: control characters become blanks; bytes that are no UTF-8
/// and characters that turn the direction of writing become U+FFFD. Else a name could steer a terminal, or read as
/// another.
std::string printable(std::string_view text);
/// The same, with line ends and tabs as they are.
std::string printableLines(std::string_view text);
/// Of JSON: the same characters, escaped, so that it still says what it said.
std::string printableJson(std::string_view json);

/// "%20" and the like replaced by the bytes that they stand for.
std::string percentDecoded(std::string_view text);

/// A text out of a header, in quotes and cut to 40 bytes: a damaged one may go on for long.
std::string inQuotes(std::string_view text);
/// The texts of all with another text between each two: "a, b, c". `textOf`: a function or a member.
template <class Range, class Text = std::identity>
std::string joined(const Range& all, std::string_view between = ", ", const Text& textOf = {}) {
    std::string text;
    for (bool isFirst = true; const auto& one : all) {
        if (!std::exchange(isFirst, false)) text += between;
        text += std::invoke(textOf, one);
    }
    return text;
}
/// What a text may be, one of them or more: "a, b or c".
std::string anyOf(const std::vector<std::string>& words);
/// Blank-separated words.
std::vector<std::string> splitWords(std::string_view text);
/// What stands between separators, empty parts too; of an empty text none.
std::vector<std::string> splitAt(char separator, std::string_view text);
std::string trimmed(std::string_view text);
std::string lowerCase(std::string_view text);
/// Numbers independent of the locale; the whole text must be the number. Return false otherwise, and where it is too
/// large for the type; what is nearer to 0 than any number of the type is 0.
bool parseNumber(std::string_view text, std::int64_t& value);
bool parseNumber(std::string_view text, double& value);

} // namespace pellucid
