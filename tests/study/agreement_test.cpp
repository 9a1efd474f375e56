// How far raters agree: published tables, and tables whose answer is plain.
#include <catch2/catch.hpp>

#include <cmath>

#include "study/agreement.h"

using namespace pellucid;

namespace {

constexpr auto kGap = std::nullopt;

} // namespace

TEST_CASE("intraclass correlations are those of Shrout and Fleiss", "[study]") {
    // "Intraclass correlations: uses in assessing rater reliability", 1979, table 2; six targets, four judges. Their
    // table 4 has ICC(2,1) = .29 and ICC(2,4) = .62; the further digits are of exact fractions.
    const ScoreTable published{{9, 2, 5, 8}, {6, 1, 3, 2}, {8, 4, 6, 8}, {7, 1, 2, 6}, {10, 5, 6, 9}, {6, 2, 4, 7}};
    const IntraclassCorrelation icc = intraclassCorrelation(published);
    CHECK(icc.raters == 4);
    CHECK(icc.things == 6);
    CHECK(icc.single == Approx(0.289763779527559).epsilon(1e-12));
    CHECK(icc.mean == Approx(0.620050547598989).epsilon(1e-12));

    // A fifth judge who left one out, and a target that nobody has judged, change nothing.
    ScoreTable withGaps = published;
    for (auto& row : withGaps) row.emplace_back(5);
    withGaps[3][4] = kGap;
    withGaps.insert(withGaps.begin() + 2, std::vector<std::optional<double>>(5));
    CHECK(intraclassCorrelation(withGaps).single == icc.single);
    CHECK(intraclassCorrelation(withGaps).raters == 4);
}

TEST_CASE("intraclass correlations of plain tables", "[study]") {
    const IntraclassCorrelation same = intraclassCorrelation({{1, 1}, {3, 3}, {5, 5}});
    CHECK(same.single == Approx(1));
    CHECK(same.mean == Approx(1));
    // One is always two points higher. Mean squares: things 2·Σ(1,3,5 around 3)² / 2 = 8, raters 3·(1 + 1)/1 = 6, rest
    // 0: (8 − 0)/(8 + 0 + 2·6/3) = 2/3.
    CHECK(intraclassCorrelation({{0, 2}, {2, 4}, {4, 6}}).single == Approx(2.0 / 3));
    CHECK(std::isnan(intraclassCorrelation({{1}, {2}}).single));
    CHECK(std::isnan(intraclassCorrelation({{1, 2}}).single));
    CHECK(std::isnan(intraclassCorrelation({{2, 2}, {2, 2}}).single));
    CHECK(std::isnan(intraclassCorrelation(ScoreTable(10, {3, 3, 3})).mean)); // ten times 3/10 is not 3
    CHECK(std::isnan(intraclassCorrelation({{2, kGap}, {kGap, 3}, {1, 4}}).single));
    CHECK(std::isnan(intraclassCorrelation({}).single));
}

TEST_CASE("alpha is Krippendorff's", "[study]") {
    // "Computing Krippendorff's alpha-reliability", 2011, section C: twelve units, four observers, ordinal 0.815.
    const ScoreTable published{{1, 1, kGap, 1}, {2, 2, 3, 2},    {3, 3, 3, 3},       {3, 3, 3, 3},
                               {2, 2, 2, 2},    {1, 2, 3, 4},    {4, 4, 4, 4},       {1, 1, 2, 1},
                               {2, 2, 2, 2},    {kGap, 5, 5, 5}, {kGap, kGap, 1, 1}, {kGap, 3, kGap, kGap}};
    CHECK(krippendorffAlpha(published) == Approx(0.8153875037548813).epsilon(1e-12));

    CHECK(krippendorffAlpha({{1, 1}, {3, 3}}) == Approx(1));
    // 1 2 and 2 1: pairs always differ, by chance two in three do (1 with one of the two 2s, not with the other 1):
    // 1 − 1/(2/3) = −1/2.
    CHECK(krippendorffAlpha({{1, 2}, {2, 1}}) == Approx(-0.5));
    CHECK(std::isnan(krippendorffAlpha({{3, 3}, {3, 3}})));
    CHECK(std::isnan(krippendorffAlpha({{1, kGap}, {kGap, 2}})));
    CHECK(std::isnan(krippendorffAlpha({})));
}
