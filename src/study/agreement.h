// How far people who score the same things agree.
#pragma once

#include <limits>
#include <optional>
#include <vector>

namespace pellucid {

/// A row per thing, in it a score per rater; empty: not scored. Rows are of one length.
using ScoreTable = std::vector<std::vector<std::optional<double>>>;

/// Intraclass correlations of a two-way model in which things and raters are random, of absolute agreement: ICC(2,1)
/// and ICC(2,k) of Shrout and Fleiss, "Intraclass correlations: uses in assessing rater reliability", 1979.
struct IntraclassCorrelation {
    std::size_t raters = 0, things = 0;                       ///< that were counted
    double single = std::numeric_limits<double>::quiet_NaN(); ///< how far one rater's scores can be relied upon, ≤ 1
    double mean = std::numeric_limits<double>::quiet_NaN();   ///< how far the means over all raters can, ≤ 1
};
/// Of those raters who scored everything that anybody scored. NaN of fewer than two of them or two things, and where
/// all scores are equal.
IntraclassCorrelation intraclassCorrelation(const ScoreTable& scores);

/// Krippendorff's α for ordered categories, which may have gaps: 1 where all agree, 0 where they do as by chance.
/// NaN where no thing has two scores, or all scores are equal. (Krippendorff, "Computing Krippendorff's
/// alpha-reliability", 2011.)
double krippendorffAlpha(const ScoreTable& scores);

} // namespace pellucid
