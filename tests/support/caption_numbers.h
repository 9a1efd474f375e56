// The numbers of a caption, read from its sentences, for comparing them with what was measured.
#pragma once

#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

namespace pellucid::test {

/// What a caption says of features whose names are one lower-case word each; numbers as they stand there: "1.2 %".
struct SaidNumbers {
    struct Shares {
        std::string vws, visibility;
    };
    std::map<std::string, Shares> shares; ///< by the name of the feature
    std::vector<std::string> order;       ///< these names, as the sentence has them
    std::optional<Shares> others;         ///< of those without a name
    int otherCount = 0;
    std::optional<std::string> coverage;
    struct Hiding {
        std::string hider, part, hidden;
    };
    std::vector<Hiding> hides;
    int numbers = 0; ///< all that were read; as many as the caption has percent signs
};

inline SaidNumbers numbersIn(const std::string& caption) {
    const auto matches = [&](const std::string& pattern) {
        static const std::string kNumber = "((?:< )?[0-9.]+ %)";
        std::string full;
        for (const char c : pattern) full += c == '#' ? kNumber : std::string(1, c);
        const std::regex regex(full);
        return std::vector<std::smatch>(std::sregex_iterator(caption.begin(), caption.end(), regex), {});
    };
    const auto named = [](std::string word) { // at the beginning of a sentence it has a capital
        word.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(word.front())));
        return word;
    };
    SaidNumbers said;
    const auto addShares = [&](const std::string& name, const std::string& vws, const std::string& visibility) {
        said.order.push_back(name);
        said.shares[name] = {vws, visibility};
        said.numbers += 2;
    };
    for (const auto& m : matches("(\\w+) has # of the saliency and # of what is visible"))
        addShares(named(m[1]), m[2], m[3]);
    for (const auto& m : matches("; (\\w+) # and #")) addShares(m[1], m[2], m[3]);
    for (const auto& m : matches("; ([0-9]+) others together # and #")) {
        said.otherCount = std::stoi(m[1]);
        said.others = {m[2], m[3]};
        said.numbers += 2;
    }
    for (const auto& m : matches("the picture is # opaque")) {
        said.coverage = m[1];
        ++said.numbers;
    }
    for (const auto& m : matches("(\\w+) hides # of (\\w+)")) {
        said.hides.push_back({named(m[1]), m[2], m[3]});
        ++said.numbers;
    }
    return said;
}

/// Shares are said in whole per cent, below 10 % in tenths: no more than half of that away from what was measured.
inline void checkSaid(const std::string& number, double share) {
    INFO("'" << number << "' of a share of " << share);
    if (number.front() == '<') {
        CHECK(number == "< 0.1 %");
        CHECK(share > 0);
        CHECK(share < 0.0005);
        return;
    }
    const bool tenths = number.find('.') != std::string::npos;
    CHECK(std::abs(std::stod(number) - 100 * share) <= (tenths ? 0.05 : 0.5) + 1e-9);
    CHECK(tenths == (share > 0 && share < 0.0995));
}

} // namespace pellucid::test
