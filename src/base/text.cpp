#include "base/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <iterator>
#include <span>
#include <type_traits>

#include "base/utf8.h"

namespace pellucid {

std::string describeBytes(std::uint64_t bytes) {
    static constexpr const char* kUnits[] = {"kB", "MB", "GB", "TB", "PB", "EB"};
    if (bytes < 1000) return std::to_string(bytes) + " bytes";
    double value = static_cast<double>(bytes) / 1000;
    std::size_t unit = 0;
    for (; value >= 999.5 && unit + 1 < std::size(kUnits); ++unit) value /= 1000;
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return std::string(text) + " " + kUnits[unit];
}

namespace {

/// Of the C0 and C1 sets, or ends a line.
bool isControl(std::uint32_t code) {
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x2028 || code == 0x2029;
}
/// Marks, embeddings, overrides and isolates of the bidirectional algorithm.
bool turnsDirection(std::uint32_t code) {
    return code == 0x61c || code == 0x200e || code == 0x200f || (code >= 0x202a && code <= 0x202e) ||
           (code >= 0x2066 && code <= 0x2069);
}

/// Calls keep(bytes) for what can be shown, change(character) for the rest.
template <class Keep, class Change>
void forEachCharacter(std::string_view text, const Keep& keep, const Change& change) {
    while (!text.empty()) {
        const Character c = firstCharacter(text);
        if (c.isValid && !isControl(c.code) && !turnsDirection(c.code))
            keep(text.substr(0, c.bytes));
        else
            change(c);
        text.remove_prefix(c.bytes);
    }
}

std::string shown(std::string_view text, bool keepsLines) {
    std::string result;
    result.reserve(text.size());
    forEachCharacter(
        text, [&](std::string_view bytes) { result += bytes; },
        [&](const Character& c) {
            const bool isOfLines = c.isValid && (c.code == '\n' || c.code == '\t');
            if (keepsLines && isOfLines)
                result += static_cast<char>(c.code);
            else
                result += c.isValid && isControl(c.code) ? " " : "\uFFFD";
        });
    return result;
}

} // namespace

std::string printable(std::string_view text) { return shown(text, false); }
std::string printableLines(std::string_view text) { return shown(text, true); }

std::string printableJson(std::string_view json) {
    std::string result;
    result.reserve(json.size());
    forEachCharacter(
        json, [&](std::string_view bytes) { result += bytes; },
        [&](const Character& c) {
            if (!c.isValid) {
                result += "\uFFFD";
            } else if (c.code < 0x20) { // between values; in texts they are escaped already
                result += static_cast<char>(c.code);
            } else {
                std::array<char, 8> escaped{};
                // All controls and marks of direction have 16 bits.
                std::snprintf(escaped.data(), escaped.size(), "\\u%04x", static_cast<unsigned>(c.code & 0xffff));
                result += escaped.data();
            }
        });
    return result;
}

std::string percentDecoded(std::string_view text) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    };
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool isCode = text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
        plain += isCode ? static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2])) : text[i];
        if (isCode) i += 2;
    }
    return plain;
}

std::string inQuotes(std::string_view text) {
    constexpr std::size_t kMost = 40;
    std::size_t end = std::min(kMost, text.size());
    while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80)
        --end; // whole letters
    return "'" + std::string(text.substr(0, end)) + (text.size() > end ? "…'" : "'");
}

std::string anyOf(const std::vector<std::string>& words) {
    if (words.size() < 2) return joined(words);
    return joined(std::span(words).first(words.size() - 1)) + " or " + words.back();
}

std::vector<std::string> splitWords(std::string_view text) {
    std::vector<std::string> words;
    const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    for (auto it = text.begin(); it != text.end();) {
        const auto begin = std::find_if_not(it, text.end(), blank);
        it = std::find_if(begin, text.end(), blank);
        if (begin != it) words.emplace_back(begin, it);
    }
    return words;
}

std::vector<std::string> splitAt(char separator, std::string_view text) {
    std::vector<std::string> parts;
    if (text.empty()) return parts;
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = text.find(separator, begin)) != std::string_view::npos; begin = end + 1)
        parts.emplace_back(text.substr(begin, end - begin));
    parts.emplace_back(text.substr(begin));
    return parts;
}

std::string trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\n";
    const std::size_t begin = text.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return {};
    return std::string(text.substr(begin, text.find_last_not_of(kBlank) - begin + 1));
}

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower;
}

namespace {

/// Of a number beyond the range of its type: whether it is too small, rather than too large.
bool isTiny(std::string_view text) {
    const std::size_t exponent = text.find_first_of("eE");
    if (exponent != std::string_view::npos) return text.substr(exponent + 1).starts_with('-');
    return text.substr(0, text.find('.')).find_first_of("123456789") == std::string_view::npos;
}

template <class Number>
bool parseWhole(std::string_view text, Number& value) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size()) return false;
    if (std::is_floating_point_v<Number> && error == std::errc::result_out_of_range && isTiny(text)) {
        value = 0; // nearer to 0 than any number of the type
        return true;
    }
    return error == std::errc{};
}

} // namespace

bool parseNumber(std::string_view text, std::int64_t& value) { return parseWhole(text, value); }
bool parseNumber(std::string_view text, double& value) { return parseWhole(text, value); }

} // namespace pellucid
