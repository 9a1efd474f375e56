#include "output.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace pellucid::cli {

namespace {

/// Columns that a terminal needs for UTF-8 text: every byte that does not continue a character.
std::size_t width(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padding(const std::string& text, std::size_t columns) {
    const std::size_t used = width(text);
    return std::string(columns > used ? columns - used : 0, ' ');
}

void requireFinite(const Json& json, const std::string& place) {
    if (json.is_number_float() && !std::isfinite(json.get<double>()))
        throw Error("a result is not a finite number", place, "check the volume's values and the options");
    if (!json.is_structured()) return;
    for (const auto& [key, value] : json.items()) {
        std::string inner = place;
        if (!inner.empty()) inner += "/";
        requireFinite(value, inner += key);
    }
}

} // namespace

std::string Table::text() const {
    std::vector<std::size_t> widths;
    for (const auto& row : m_rows)
        for (std::size_t c = 0; c < row.size(); ++c) {
            if (c == widths.size()) widths.push_back(0);
            widths[c] = std::max(widths[c], width(row[c]));
        }
    std::string text;
    for (const auto& row : m_rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c)
            line += c == 0 ? row[c] + padding(row[c], widths[c]) : "  " + padding(row[c], widths[c]) + row[c];
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string listing(const std::vector<std::pair<std::string, std::string>>& lines) {
    std::size_t columns = 0;
    for (const auto& [name, value] : lines) columns = std::max(columns, width(name));
    std::string text;
    for (const auto& [name, value] : lines)
        text.append(name).append(padding(name, columns)).append("  ").append(value).append("\n");
    return text;
}

std::string countText(std::size_t value) {
    std::string text = std::to_string(value);
    for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
    return text;
}

std::string bytesText(std::size_t bytes) {
    constexpr std::array<const char*, 4> kUnits{"KiB", "MiB", "GiB", "TiB"};
    if (bytes < 1024) return std::to_string(bytes) + " B";
    double value = static_cast<double>(bytes) / 1024;
    std::size_t unit = 0;
    while (value >= 1024 && unit + 1 < kUnits.size()) {
        value /= 1024;
        ++unit;
    }
    return fixedText(value, 1) + " " + kUnits[unit];
}

std::string vectorText(const Vec3& v) { return plainText(v.x) + " x " + plainText(v.y) + " x " + plainText(v.z); }
std::string rangeText(double lo, double hi) { return plainText(lo) + " .. " + plainText(hi); }
std::string secondsText(double seconds) {
    if (seconds < 1e-3) return fixedText(seconds * 1e6, 1) + " µs";
    if (seconds < 1) return fixedText(seconds * 1e3, 1) + " ms";
    return fixedText(seconds, 2) + " s";
}

Json jsonFromVector(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json jsonFromDims(const Int3& d) { return Json::array({d.x, d.y, d.z}); }
Json jsonFromRange(const ValueRange& r) { return Json::array({r.lo, r.hi}); }

Json jsonFromVolume(const Volume& volume) {
    return {{"dims", jsonFromDims(volume.dims())},
            {"spacing", jsonFromVector(volume.geometry().spacing)},
            {"range", jsonFromRange(volume.range())}};
}

std::string jsonText(const Json& json) {
    requireFinite(json, "");
    // A file name need not be UTF-8; JSON must be.
    return printableJson(json.dump(-1, ' ', false, Json::error_handler_t::replace)) + "\n";
}

void writeAnswer(const std::string& text) {
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (!written || std::fflush(stdout) != 0)
        throw Error(std::string("cannot write the answer (") + std::strerror(errno) + ")", "standard output",
                    "check where it goes, and the space there");
}

std::string oneLine(const std::string& text) {
    std::string line = printable(text);
    line.erase(line.find_last_not_of(' ') + 1);
    return line;
}

} // namespace pellucid::cli
