#include "study/agreement.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace pellucid {

namespace {

using Scores = std::vector<double>;

bool isScored(const std::vector<std::optional<double>>& row) {
    return std::ranges::any_of(row, [](const auto& score) { return score.has_value(); });
}

/// Things × raters without gaps: without the raters who have one.
std::vector<Scores> completeOf(const ScoreTable& table) {
    std::vector<Scores> complete;
    for (const auto& row : table)
        if (isScored(row)) complete.emplace_back();
    const std::size_t raters = table.empty() ? 0 : table.front().size();
    for (std::size_t rater = 0; rater < raters; ++rater) {
        const auto scored = [&](const auto& row) { return !isScored(row) || row[rater].has_value(); };
        if (!std::ranges::all_of(table, scored)) continue;
        auto thing = complete.begin();
        for (const auto& row : table)
            if (isScored(row)) (thing++)->push_back(*row[rater]);
    }
    return complete;
}

double meanOfAll(const Scores& scores) {
    double sum = 0;
    for (const double score : scores) sum += score;
    return sum / static_cast<double>(scores.size());
}

/// Σ (x − mean)².
double squaresAround(double mean, const Scores& scores) {
    double squares = 0;
    for (const double score : scores) squares += (score - mean) * (score - mean);
    return squares;
}

/// Of each thing the scores that can be compared: those with a second one.
std::vector<Scores> pairable(const ScoreTable& table) {
    std::vector<Scores> units;
    for (const auto& row : table) {
        Scores scores;
        for (const auto& score : row)
            if (score) scores.push_back(*score);
        if (scores.size() > 1) units.push_back(scores);
    }
    return units;
}

/// The ordinal metric: how many scores lie between two, counting half of those at either end; squared.
class OrdinalDistance {
public:
    explicit OrdinalDistance(const std::map<double, double>& counts) {
        double below = 0;
        for (const auto& [score, count] : counts) {
            m_middle[score] = below + count / 2;
            below += count;
        }
    }
    double squared(double a, double b) const {
        const double d = m_middle.at(a) - m_middle.at(b);
        return d * d;
    }

private:
    std::map<double, double> m_middle; ///< of each score: the scores below it and half of those equal to it
};

} // namespace

IntraclassCorrelation intraclassCorrelation(const ScoreTable& table) {
    const std::vector<Scores> scores = completeOf(table);
    IntraclassCorrelation icc{.raters = scores.empty() ? 0 : scores.front().size(), .things = scores.size()};
    if (icc.raters < 2 || icc.things < 2) return icc;
    const auto n = static_cast<double>(icc.things), k = static_cast<double>(icc.raters);
    Scores all, ofThings, ofRaters(icc.raters, 0.0);
    for (const Scores& row : scores) {
        all.insert(all.end(), row.begin(), row.end());
        ofThings.push_back(meanOfAll(row));
        for (std::size_t r = 0; r < row.size(); ++r) ofRaters[r] += row[r];
    }
    for (double& mean : ofRaters) mean /= n; // once: where all scores are equal, so are these, to the bit
    // Mean squares between things, between raters, and of what is left.
    const double mean = meanOfAll(all), things = k * squaresAround(mean, ofThings),
                 raters = n * squaresAround(mean, ofRaters);
    const double bms = things / (n - 1), jms = raters / (k - 1),
                 ems = (squaresAround(mean, all) - things - raters) / ((n - 1) * (k - 1));
    icc.single = (bms - ems) / (bms + (k - 1) * ems + k * (jms - ems) / n);
    icc.mean = (bms - ems) / (bms + (jms - ems) / n);
    return icc;
}

double krippendorffAlpha(const ScoreTable& table) {
    const std::vector<Scores> units = pairable(table);
    std::map<double, double> counts;
    double total = 0;
    for (const Scores& unit : units)
        for (const double score : unit) {
            ++counts[score];
            ++total;
        }
    const OrdinalDistance distance(counts);
    double observed = 0, expected = 0;
    for (const Scores& unit : units)
        for (const double a : unit)
            for (const double b : unit) observed += distance.squared(a, b) / static_cast<double>(unit.size() - 1);
    for (const auto& [a, countOfA] : counts)
        for (const auto& [b, countOfB] : counts) expected += countOfA * countOfB * distance.squared(a, b);
    return 1 - observed * (total - 1) / expected; // 0/0 where all are equal
}

} // namespace pellucid
