#include "base/text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <iterator>
#include <span>
#include <type_traits>

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

std::string inQuotes(std::string_view text) {
    constexpr std::size_t kMost = 40;
    std::string quote("'");
    quote += text.substr(0, kMost);
    return quote + (text.size() > kMost ? "…'" : "'");
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
