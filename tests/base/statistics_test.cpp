// Correlations: published values, the definitions by brute force, and the ends of their range.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
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
    SECTION("the exact distribution of Spearman's Σd², from the tables of permutations") {
        // How many of the 5! orders have Σd² = 0, 2, 4, …, 40 (OEIS A175929): p is twice the share of the nearer tail.
        const std::vector<int> orders{1, 4, 3, 6, 7, 6, 4, 10, 6, 10, 6, 10, 6, 10, 4, 6, 7, 6, 3, 4, 1};
        std::vector<double> y{1, 2, 3, 4, 5};
        const Numbers x = y;
        do {
            std::size_t half = 0; // Σd²/2
            for (std::size_t i = 0; i < 5; ++i) half += static_cast<std::size_t>((x[i] - y[i]) * (x[i] - y[i]));
            half /= 2;
            const auto upTo = [&](std::size_t end) {
                return std::accumulate(orders.begin(), orders.begin() + static_cast<std::ptrdiff_t>(end), 0);
            };
            const int nearer = std::min(upTo(half + 1), 120 - upTo(half));
            const Correlation found = correlation(CorrelationKind::Spearman, x, y, {.resamples = 0});
            CHECK(found.value == Approx(1 - 2 * static_cast<double>(half) / 20).margin(1e-12));
            CHECK(found.p == Approx(std::min(1.0, 2.0 * nearer / 120)).epsilon(1e-12));
        } while (std::next_permutation(y.begin(), y.end()));
    }
    SECTION("with ties, as R has them: miles per gallon and weight of its 32 cars (mtcars)") {
        const Numbers mpg{21,   21,   22.8, 21.4, 18.7, 18.1, 14.3, 24.4, 22.8, 19.2, 17.8,
                          16.4, 17.3, 15.2, 10.4, 10.4, 14.7, 32.4, 30.4, 33.9, 21.5, 15.5,
                          15.2, 13.3, 19.2, 27.3, 26,   30.4, 15.8, 19.7, 15,   21.4};
        const Numbers weight{2.62,  2.875, 2.32,  3.215, 3.44,  3.46,  3.57, 3.19,  3.15,  3.44,  3.44,
                             4.07,  3.73,  3.78,  5.25,  5.424, 5.345, 2.2,  1.615, 1.835, 2.465, 3.52,
                             3.435, 3.84,  3.845, 1.935, 2.14,  1.513, 3.17, 2.77,  3.57,  2.78};
        // cor.test() prints ρ −0.886422 with p 1.488e-11, τ −0.7278321 with p 6.706e-09 and r −0.8676594 with p
        // 1.294e-10; the further digits of the first two are of exact fractions.
        const Correlation spearman = correlation(CorrelationKind::Spearman, mpg, weight);
        CHECK(spearman.value == Approx(-0.8864220332702978).margin(1e-9));
        CHECK(spearman.p == Approx(1.488e-11).epsilon(4e-4));
        const Correlation kendall = correlation(CorrelationKind::Kendall, mpg, weight);
        CHECK(kendall.value == Approx(-0.727832149528431).margin(1e-9));
        CHECK(kendall.p == Approx(6.705770405595861e-09).epsilon(1e-9));
        const Correlation pearson = correlation(CorrelationKind::Pearson, mpg, weight);
        CHECK(pearson.value == Approx(-0.8676594).margin(5e-8));
        CHECK(pearson.p == Approx(1.294e-10).epsilon(4e-4));
    }
}

TEST_CASE("quantiles of Student's t are those of tables", "[statistics]") {
    // One degree of freedom is Cauchy's distribution, two have a closed form: t = (2p − 1)/√(2p(1 − p)).
    for (const double p : {0.01, 0.2, 0.5, 0.7, 0.975, 0.9995}) {
        CAPTURE(p);
        CHECK(studentQuantile(p, 1) == Approx(std::tan(M_PI * (p - 0.5))).epsilon(1e-12).margin(1e-12));
        CHECK(studentQuantile(p, 2) == Approx((2 * p - 1) / std::sqrt(2 * p * (1 - p))).epsilon(1e-12).margin(1e-12));
    }
    // The tables of textbooks have 2.262, 2.048, 4.032; the further digits are of Abramowitz and Stegun 26.7.3
    // and 26.7.4.
    CHECK(studentQuantile(0.975, 9) == Approx(2.262157162798205).epsilon(1e-12));
    CHECK(studentQuantile(0.975, 28) == Approx(2.048407141795245).epsilon(1e-12));
    CHECK(studentQuantile(0.995, 5) == Approx(4.032142983555212).epsilon(1e-12));
    CHECK(studentQuantile(0.975, 1e6) == Approx(1.959966356713).epsilon(1e-9)); // nearly the normal distribution's
}

TEST_CASE("means have their interval, medians their middle", "[statistics]") {
    // The extra sleep under the second drug (Student 1908): mean 2.33, standard deviation 2.002249; R's t.test():
    // 0.8976775 to 3.7623225.
    const Numbers extra{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
    const Mean mean = meanOf(extra);
    CHECK(mean.count == 10);
    CHECK(mean.value == Approx(2.33));
    CHECK(mean.deviation == Approx(2.002249).margin(5e-7));
    CHECK(mean.interval.low == Approx(0.8976775).margin(5e-8));
    CHECK(mean.interval.high == Approx(3.7623225).margin(5e-8));
    // Scores 2 and 4: 3 ± 12.7062·√2/√2.
    CHECK(meanOf(Numbers{2, 4}).interval.high == Approx(3 + 12.706204736174698).epsilon(1e-12));
    CHECK(meanOf(Numbers{2, 4}, 0.5).interval.high == Approx(4).epsilon(1e-12)); // t of 0.75 is 1
    CHECK(meanOf(Numbers{3}).value == 3);
    CHECK(std::isnan(meanOf(Numbers{3}).interval.low));
    CHECK(std::isnan(meanOf({}).value));
    CHECK(median(Numbers{3, 1, 2}) == 2);
    CHECK(median(Numbers{4, 1, 2, 10}) == 3);
    CHECK(std::isnan(median({})));
}

TEST_CASE("a bootstrap draws as many as there are, and takes percentiles of what it finds", "[statistics]") {
    std::size_t calls = 0, longest = 0;
    double sum = 0;
    const auto mean = [&](std::span<const std::size_t> drawn) {
        ++calls;
        longest = std::max(longest, drawn.size());
        double of = 0;
        for (const std::size_t i : drawn) of += static_cast<double>(i) / 100;
        sum += of;
        return of;
    };
    // The mean of 0 … 99 with replacement: 49.5, deviation √(9999/12)/10 = 2.887; 95 %: ± 1.96 of these.
    const Interval interval = bootstrapInterval(100, mean);
    CHECK(calls == 2000);
    CHECK(longest == 100);
    CHECK(sum / 2000 == Approx(49.5).margin(0.2));
    CHECK(interval.low == Approx(49.5 - 1.96 * 2.887).margin(0.4));
    CHECK(interval.high == Approx(49.5 + 1.96 * 2.887).margin(0.4));
    CHECK(std::isnan(bootstrapInterval(3, [](auto) { return std::nan(""); }).low));
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
        CHECK((a.interval.low < a.value && a.value < a.interval.high));
        CHECK((b.interval.low < b.value && b.value < b.interval.high));
        // 16 times the pairs: about a quarter of the width.
        CHECK(b.interval.high - b.interval.low < (a.interval.high - a.interval.low) / 2);
        if (kind == CorrelationKind::Pearson) CHECK(b.interval.contains(0.8));
        const Correlation again = correlation(kind, few.first, few.second);
        CHECK((again.interval.low == a.interval.low && again.interval.high == a.interval.high));
        CHECK(correlation(kind, few.first, few.second, {.seed = 2}).interval.low != a.interval.low);
        CHECK(std::isnan(correlation(kind, few.first, few.second, {.resamples = 0}).interval.low));
    }
}
