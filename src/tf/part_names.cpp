#include "tf/part_names.h"

#include <vector>

#include "base/text.h"

namespace pellucid {

namespace {

/// A name, and the values from which and to which it says that the feature reaches; empty: it does not say.
struct PartName {
    std::string base, from, to;

    std::string text() const {
        if (base.empty() && !from.empty() && !to.empty()) return from + " to " + to;
        const std::string which =
            from.empty() ? (to.empty() ? "" : "up to " + to) : "from " + from + (to.empty() ? "" : " to " + to);
        return base + (base.empty() || which.empty() ? "" : " ") + which;
    }
};

bool isNumber(const std::string& word) {
    double value = 0;
    return !word.starts_with('+') && parseNumber(word, value);
}

PartName read(const std::string& name) {
    const std::vector<std::string> words = splitAt(' ', name);
    const std::size_t n = words.size();
    const auto word = [&](std::size_t fromEnd) { return fromEnd <= n ? words[n - fromEnd] : std::string(); };
    PartName part;
    std::size_t used = 0; // words at the end that tell values
    if (isNumber(word(1)) && word(2) == "from") {
        part.from = word(1);
        used = 2;
    } else if (isNumber(word(1)) && word(2) == "to" && word(3) == "up") {
        part.to = word(1);
        used = 3;
    } else if (isNumber(word(1)) && word(2) == "to" && isNumber(word(3)) && (n == 3 || word(4) == "from")) {
        part.from = word(3);
        part.to = word(1);
        used = n == 3 ? 3 : 4;
    }
    for (std::size_t i = 0; i + used < n; ++i) part.base += (i > 0 ? " " : "") + words[i];
    if (part.base.empty() && (part.from.empty() || part.to.empty())) return {name, {}, {}}; // "from 3", or ""
    return part;
}

} // namespace

std::pair<std::string, std::string> namesOfParts(const std::string& name, const std::string& border) {
    const PartName whole = read(name);
    return {PartName{whole.base, whole.from, border}.text(), PartName{whole.base, border, whole.to}.text()};
}

std::string nameOfWhole(const std::string& lower, const std::string& upper) {
    const PartName low = read(lower), high = read(upper);
    if (low.base != high.base || low.to.empty() || low.to != high.from) return lower + " + " + upper;
    return PartName{low.base, low.from, high.to}.text();
}

} // namespace pellucid
