// What a command answers, and how it is written: text for people, one JSON object for programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/round_numbers.h"
#include "volume/volume.h"

namespace pellucid::cli {

using Json = nlohmann::ordered_json; // keys in the order in which the documentation lists them

/// The whole result of a command. Nothing is printed before it is complete, so that stdout is empty after an error.
struct Answer {
    std::string text;                      ///< for people; ends with a newline
    Json json;                             ///< the same for --json
    std::vector<std::string> notices = {}; ///< remarks for stderr
    std::optional<Error> failure = {};     ///< the work is done but does not reach what was demanded: exit status 1
};

/// Aligned columns: the first one to the left, the others to the right.
class Table {
public:
    explicit Table(std::vector<std::string> head) { m_rows.push_back(std::move(head)); }
    void add(std::vector<std::string> row) { m_rows.push_back(std::move(row)); }
    std::string text() const;

private:
    std::vector<std::vector<std::string>> m_rows;
};

/// Aligned "name  value" lines.
std::string listing(const std::vector<std::pair<std::string, std::string>>& lines);

std::string countText(std::size_t value);    ///< "26,470,255"
std::string bytesText(std::size_t bytes);    ///< "12.3 MiB"
std::string vectorText(const Vec3& v);       ///< "0.5 x 0.5 x 1"
std::string rangeText(double lo, double hi); ///< "0 .. 255"
std::string secondsText(double seconds);     ///< "2.10 s", "210.0 ms", "21.0 µs"

Json jsonFromVector(const Vec3& v);
Json jsonFromDims(const Int3& d);
Json jsonFromRange(const ValueRange& r);
/// The object "volume" of measurements: dims, spacing, range.
Json jsonFromVolume(const Volume& volume);

/// One line of JSON. Throws Error where a number in it is not finite (JSON has no such number).
std::string jsonText(const Json& json);

/// Writes to stdout and makes sure that it has arrived; throws Error where it cannot (a full disk).
void writeAnswer(const std::string& text);

/// `text` on one line: line breaks and other control characters become spaces.
std::string oneLine(const std::string& text);

} // namespace pellucid::cli
