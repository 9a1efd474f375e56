#include "volume/formats/text_header.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "volume/outside_files.h"

namespace pellucid {

TextHeader::TextHeader(const std::string& path, const std::function<bool(TextHeader&, const std::string& line)>& take)
    : m_path(path) {
    constexpr std::size_t kMostBytes = 1u << 20;
    const std::string head = fileHead(path, kMostBytes);
    std::size_t begin = 0;
    bool ended = false;
    while (!ended && begin < head.size()) {
        const std::size_t end = std::min(head.find('\n', begin), head.size());
        ended = !take(*this, trimmed(std::string_view(head).substr(begin, end - begin)));
        begin = std::min(end + 1, head.size());
    }
    if (!ended && begin == kMostBytes)
        fail("the header does not end within " + describeBytes(kMostBytes),
             "correct the header, or copy the file again");
    m_dataStart = begin;
}

std::string TextHeader::get(const std::string& name) const {
    const auto field = m_fields.find(name);
    return field == m_fields.end() ? std::string() : field->second;
}

std::int64_t TextHeader::wholeNumber(const std::string& name, std::int64_t otherwise) const {
    std::int64_t value = otherwise;
    const std::string text = get(name);
    if (!text.empty() && !parseNumber(text, value))
        fail("the header's field " + inQuotes(name) + " is " + inQuotes(text) + ", not a whole number");
    return value;
}

std::vector<std::int64_t> TextHeader::sizes(const std::string& name, const std::string& dimension,
                                            std::int64_t mostAxes) const {
    std::vector<std::int64_t> sizes;
    for (const std::string& word : splitWords(get(name)))
        if (!parseNumber(word, sizes.emplace_back()))
            fail("the header's field " + inQuotes(name) + " has " + inQuotes(word) + ", which is not a whole number");
    const std::int64_t axes = wholeNumber(dimension, 0);
    if (axes < 1 || axes > mostAxes || sizes.size() != static_cast<std::size_t>(axes))
        fail("the header gives " + std::to_string(sizes.size()) + " sizes for " + dimension + " " +
             std::to_string(axes));
    return sizes;
}

std::string TextHeader::dataPath(const std::string& file) const {
    if (file.size() > 1000) fail("the name of the data file is too long");
    requireInside(m_path, file);
    return (std::filesystem::path(m_path).parent_path() / file).string();
}

void TextHeader::fail(const std::string& what, const std::string& toDo) const { throw FileError(what, m_path, toDo); }

double numberIn(const std::string& word) {
    double value = 0;
    return parseNumber(word, value) ? value : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> finiteNumbers(const std::string& text, const std::string& what, const std::string& path) {
    std::vector<double> numbers;
    for (const std::string& word : splitWords(text)) {
        numbers.push_back(numberIn(word));
        if (!std::isfinite(numbers.back()))
            throw FileError("there is " + inQuotes(word) + " among the numbers of " + what, path, "correct the header");
    }
    return numbers;
}

void requireSpacing(double spacing, std::size_t axis, const std::string& text, const std::string& path) {
    if (!(spacing > 0) || !std::isfinite(spacing))
        throw FileError("the spacing of axis " + std::to_string(axis) + " is " + inQuotes(text) +
                            ", it must be positive and finite",
                        path, "correct the header");
}

} // namespace pellucid
