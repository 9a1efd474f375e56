// Parts of a text, counted.
#pragma once

#include <string>

namespace pellucid::test {

/// How often `part` stands in `text`, overlapping places too.
inline std::size_t timesIn(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace pellucid::test
