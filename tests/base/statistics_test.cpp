// Correlations: published values, the definitions by brute force, and the ends of their range.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "base/error.h"
#include "base/statistics.h"

using namespace pellucid;

namespace {

using Numbers = std::vector<double>;
constexpr CorrelationKind kAll[] = {CorrelationKind::Pearson, CorrelationKind::Spearman, CorrelationKind::Kendall};

/// τ-b by its definition: each pair of pairs.
double kendallByPairs(const Numbers& x, const Numbers& y) {
    double s = 0, ofX = 0, ofY = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const double dx = (x[i] > x[j]) - (x[i] < x[j]), dy = (y[i] > y[j]) - (y[i] < y[j]);
            s += dx * dy;
            ofX += dx * dx;
            ofY += dy * dy;
        }
    return s / std::sqrt(ofX * ofY);
}

/// The correlation of ranks, which are counted.
double spearmanByCounting(const Numbers& x, const Numbers& y) {
    const auto ranks = [](const Numbers& v) {
        Numbers r;
        for (const double a : v) {
            double below = 0, equal = 0;
            for (const double b : v) {
                below += b < a;
                equal += b == a;
            }
            r.push_back(below + (equal + 1) / 2);
        }
        return r;
    };
    const Numbers a = ranks(x), b = ranks(y);
    const double mean = (static_cast<double>(x.size()) + 1) / 2;
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - mean) * (b[i] - mean);
        aa += (a[i] - mean) * (a[i] - mean);
        bb += (b[i] - mean) * (b[i] - mean);
    }
    return ab / std::sqrt(aa * bb);
}

Numbers someNumbers(std::mt19937& random, std::size_t count, int values) {
    Numbers v;
    for (std::size_t i = 0; i < count; ++i)
        v.push_back(values > 0 ? static_cast<double>(random() % static_cast<unsigned>(values)) : random() * 1e-9);
    return v;
}

} // namespace

TEST_CASE("correlations have the values of textbooks", "[statistics]") {
    SECTION("without ties: Hollander and Wolfe's tuna, as R prints it") {
        const Numbers x{44.4, 45.9, 41.9, 53.3, 44.7, 44.1, 50.7, 45.2, 60.1};
        const Numbers y{2.6, 3.1, 2.5, 5.0, 3.6, 4.0, 5.2, 2.8, 3.8};
        // 26 of 36 pairs are in the same order: τ = (26 − 10)/36; S = 48: ρ = 1 − 6·48/(9·80).
        const Correlation kendall = correlation(CorrelationKind::Kendall, x, y);
        CHECK(kendall.value == Approx(16.0 / 36).epsilon(1e-12));
        CHECK(kendall.p == Approx(0.1194).margin(5e-5));
        const Correlation spearman = correlation(CorrelationKind::Spearman, x, y);
        CHECK(spearman.value == Approx(0.6).epsilon(1e-12));
        CHECK(spearman.p == Approx(0.0968).margin(5e-5));
        const Correlation pearson = correlation(CorrelationKind::Pearson, x, y);
        CHECK(pearson.value == Approx(0.5711816).margin(5e-8));
        CHECK(pearson.p == Approx(0.1082).margin(5e-5));
    }
    SECTION("p is of t, and of the normal distribution with ties, as the documentation of SciPy has them") {
        const Correlation pearson =
            correlation(CorrelationKind::Pearson, Numbers{1, 2, 3, 4, 5}, Numbers{10, 9, 2.5, 6, 4});
        CHECK(pearson.value == Approx(-0.7426106572325057).margin(1e-9));
        CHECK(pearson.p == Approx(0.1505558088534455).margin(1e-9));
        const Correlation spearman =
            correlation(CorrelationKind::Spearman, Numbers{1, 2, 3, 4, 5}, Numbers{5, 6, 7, 8, 7});
        CHECK(spearman.value == Approx(0.8207826816681233).margin(1e-9));
        CHECK(spearman.p == Approx(0.08858700531354381).margin(1e-9));
        const Correlation kendall =
            correlation(CorrelationKind::Kendall, Numbers{12, 2, 1, 12, 2}, Numbers{1, 4, 7, 1, 0});
        CHECK(kendall.value == Approx(-0.47140452079103173).margin(1e-9));
        CHECK(kendall.p == Approx(0.2827454599327748).margin(1e-9));
    }
    SECTION("few pairs in perfect order: two orders of n! are as extreme") {
        const Numbers x{1, 2, 3, 4}, y{10, 20, 30, 40};
        CHECK(correlation(CorrelationKind::Spearman, x, y).p == Approx(2.0 / 24));
        CHECK(correlation(CorrelationKind::Kendall, x, y).p == Approx(2.0 / 24));
        CHECK(correlation(CorrelationKind::Pearson, x, y).p == Approx(0).margin(1e-12));
    }
}

TEST_CASE("correlations of ranks are what their definitions say, with and without ties", "[statistics]") {
    std::mt19937 random(5);
    for (const int values : {0, 2, 4, 10})
        for (const std::size_t n : {2, 3, 7, 20, 61}) {
            CAPTURE(values, n);
            const Numbers x = someNumbers(random, n, values), y = someNumbers(random, n, values);
            const double kendall = kendallByPairs(x, y), found = coefficient(CorrelationKind::Kendall, x, y);
            CHECK(std::isnan(found) == std::isnan(kendall));
            if (!std::isnan(kendall)) CHECK(found == Approx(kendall).margin(1e-12));
            const double spearman = spearmanByCounting(x, y), ofRanks = coefficient(CorrelationKind::Spearman, x, y);
            CHECK(std::isnan(ofRanks) == std::isnan(spearman));
            if (!std::isnan(spearman)) CHECK(ofRanks == Approx(spearman).margin(1e-12));
        }
}

TEST_CASE("exact and approximate p of Kendall agree where one takes over from the other", "[statistics]") {
    // 49 pairs: exact. One more, far out and in order, makes it 50; the p of 49 and of 50 differ little.
    std::mt19937 random(3);
    Numbers x = someNumbers(random, 49, 0), y;
    for (const double v : x) y.push_back(v + 4 * someNumbers(random, 1, 0)[0]);
    const double exact = correlation(CorrelationKind::Kendall, x, y).p;
    x.push_back(100);
    y.push_back(0.5 * y[7] + 0.5 * y[8]);
    const double normal = correlation(CorrelationKind::Kendall, x, y).p;
    CHECK(exact == Approx(normal).epsilon(0.35));
}

TEST_CASE("what a correlation cannot be told of", "[statistics]") {
    for (const CorrelationKind kind : kAll) {
        CHECK(std::isnan(correlation(kind, Numbers{}, Numbers{}).value));
        CHECK(std::isnan(correlation(kind, Numbers{1}, Numbers{2}).value));
        CHECK(std::isnan(correlation(kind, Numbers{1, 1, 1}, Numbers{1, 2, 3}).value));
        const Correlation two = correlation(kind, Numbers{1, 2}, Numbers{5, 3});
        CHECK(two.value == Approx(-1));
        CHECK(std::isnan(two.p));
        CHECK_THROWS_AS(correlation(kind, Numbers{1, 2}, Numbers{1}), Error);
        CHECK_THROWS_AS(correlation(kind, Numbers{1, 2}, Numbers{1, std::numeric_limits<double>::infinity()}), Error);
        // Neither unit nor size matters.
        const Numbers x{1e300, 3e300, 2e300, -4e300}, y{1e-300, 2e-300, 5e-300, -1e-300};
        const Numbers small{1, 3, 2, -4}, other{1, 2, 5, -1};
        CHECK(coefficient(kind, x, y) == Approx(coefficient(kind, small, other)));
    }
}

TEST_CASE("an interval holds the coefficient, is the same again, and narrows with more pairs", "[statistics]") {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    const auto planted = [&](std::size_t n) { // ρ = 0.8
        std::pair<Numbers, Numbers> pairs;
        for (std::size_t i = 0; i < n; ++i) {
            const double a = normal(random), b = normal(random);
            pairs.first.push_back(a);
            pairs.second.push_back(0.8 * a + 0.6 * b);
        }
        return pairs;
    };
    const auto few = planted(20), many = planted(320);
    for (const CorrelationKind kind : kAll) {
        const Correlation a = correlation(kind, few.first, few.second), b = correlation(kind, many.first, many.second);
        CHECK((a.low < a.value && a.value < a.high));
        CHECK((b.low < b.value && b.value < b.high));
        // 16 times the pairs: about a quarter of the width.
        CHECK(b.high - b.low < (a.high - a.low) / 2);
        if (kind == CorrelationKind::Pearson) CHECK((b.low < 0.8 && 0.8 < b.high));
        const Correlation again = correlation(kind, few.first, few.second);
        CHECK((again.low == a.low && again.high == a.high));
        CHECK(correlation(kind, few.first, few.second, {.seed = 2}).low != a.low);
        CHECK(std::isnan(correlation(kind, few.first, few.second, {.resamples = 0}).low));
    }
}
