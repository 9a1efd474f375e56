// Peaks, multi-Otsu, and the classes that come of them.
#include "tf/value_classes.h"

#include <cmath>
#include <numeric>
#include <random>

#include <catch2/catch.hpp>

using namespace pellucid;

namespace {

/// A density with Gaussians {centre, sigma, weight} over [0,1].
struct Bell {
    double centre, sigma, weight;
};
std::vector<double> densityOf(const std::vector<Bell>& bells) {
    std::vector<double> density(kClassBins, 0);
    for (int i = 0; i < kClassBins; ++i)
        for (const Bell& b : bells) {
            const double d = ((i + 0.5) / kClassBins - b.centre) / b.sigma;
            density[static_cast<std::size_t>(i)] += b.weight / b.sigma * std::exp(-d * d / 2);
        }
    return density;
}

} // namespace

TEST_CASE("smoothing keeps the sum and constants", "[classes]") {
    std::mt19937 random(3);
    std::vector<double> density(64);
    for (double& d : density) d = static_cast<double>(random() % 100);
    const std::vector<double> smooth = smoothed(density, 2.5);
    CHECK(std::accumulate(smooth.begin(), smooth.end(), 0.0) ==
          Approx(std::accumulate(density.begin(), density.end(), 0.0)));
    for (const double s : smoothed(std::vector<double>(64, 3.0), 5)) CHECK(s == Approx(3));
}

TEST_CASE("peaks are told by how far the density falls around them", "[classes]") {
    //                                0  1  2  3  4  5  6  7  8
    const std::vector<double> density{0, 4, 9, 8, 10, 2, 0, 5, 0};
    // From 9 it falls to 8 before 10: by 11 %. From 5 to 0.
    CHECK(prominentPeaks(density, 0.1, 0) == std::vector<int>{2, 4, 7});
    CHECK(prominentPeaks(density, 0.2, 0) == std::vector<int>{4, 7});
    CHECK(prominentPeaks(density, 0.2, 0.2) == std::vector<int>{4}); // 5 of 38 is under a fifth
    CHECK(prominentPeaks(std::vector<double>(9, 0.0), 0.2, 0).empty());
    CHECK(prominentPeaks({1, 1, 1}, 0.2, 0) == std::vector<int>{0}); // the ends are falls
}

TEST_CASE("multi-Otsu finds the best borders of all", "[classes]") {
    std::mt19937 random(7);
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<double> counts(18);
        for (double& c : counts) c = static_cast<double>(random() % 50);
        counts[random() % 18] = 0;
        const int begin = static_cast<int>(random() % 4), end = 18 - static_cast<int>(random() % 4);
        // Σ over classes of weight·(mean − whole mean)², over the whole variance, for every pair of borders.
        const auto sums = [&](int a, int b) {
            double w = 0, m = 0;
            for (int i = a; i < b; ++i)
                w += counts[static_cast<std::size_t>(i)], m += counts[static_cast<std::size_t>(i)] * i;
            return std::pair(w, m);
        };
        const auto [weight, moment] = sums(begin, end);
        double variance = 0;
        for (int i = begin; i < end; ++i)
            variance += counts[static_cast<std::size_t>(i)] * (i - moment / weight) * (i - moment / weight);
        const auto explained = [&, w0 = weight, m0 = moment](int a, int b) {
            double sum = 0;
            for (const auto& [w, m] : {sums(begin, a), sums(a, b), sums(b, end)})
                if (w > 0) sum += w * (m / w - m0 / w0) * (m / w - m0 / w0);
            return sum / variance;
        };
        double best = 0;
        for (int a = begin + 1; a < end; ++a)
            for (int b = a + 1; b < end; ++b) best = std::max(best, explained(a, b));
        const OtsuBorders found = multiOtsu(counts, begin, end, 3);
        REQUIRE(found.borders.size() == 2);
        CHECK(found.explained == Approx(best));
        CHECK(explained(found.borders[0], found.borders[1]) == Approx(best));
    }
}

TEST_CASE("multi-Otsu of few bins, empty bins and one class", "[classes]") {
    CHECK(multiOtsu({1, 1}, 0, 2, 5).borders == std::vector<int>{1});
    CHECK(multiOtsu({5, 0, 0, 5}, 0, 4, 1).borders.empty());
    CHECK(multiOtsu({0, 0, 0, 0}, 0, 4, 2).borders.size() == 1);
    CHECK(multiOtsu({5, 0, 0, 5}, 0, 4, 2).explained == Approx(1));
}

TEST_CASE("materials are classes about their peaks with borders half-way", "[classes]") {
    ClassEvidence e{densityOf({{0.02, 0.01, 10}, {0.3, 0.02, 3}, {0.7, 0.02, 1}}),
                    densityOf({{0.3, 0.015, 1}, {0.7, 0.015, 0.5}})};
    const ValueClasses found = findClasses(e, BackgroundValues{-0.02, 0.02, 0.06});
    CHECK(found.byPeaks);
    REQUIRE(found.classes.size() == 2);
    CHECK(found.backgroundLo == 0);
    CHECK(found.backgroundHi == Approx(0.16).margin(0.005)); // (0.02 + 0.3) / 2
    CHECK(found.classes[0].lo == found.backgroundHi);
    CHECK(found.classes[0].hi == Approx(0.5).margin(0.005));
    CHECK(found.classes[1].lo == found.classes[0].hi);
    CHECK(found.classes[1].hi == 1);
    CHECK(found.fit > 0.95);
    // A background whose noise reaches farther keeps it.
    CHECK(findClasses(e, BackgroundValues{-0.2, 0.02, 0.2}).backgroundHi == Approx(0.2));
}

TEST_CASE("a background between materials leaves both sides", "[classes]") {
    const ClassEvidence e{densityOf({{0.5, 0.01, 10}, {0.2, 0.02, 1}, {0.8, 0.02, 1}}),
                          densityOf({{0.2, 0.015, 1}, {0.8, 0.015, 1}})};
    const ValueClasses found = findClasses(e, BackgroundValues{0.46, 0.5, 0.54});
    REQUIRE(found.classes.size() == 2);
    CHECK(found.classes[0].lo == 0);
    CHECK(found.classes[0].hi == Approx(0.35).margin(0.005));
    CHECK(found.backgroundLo == found.classes[0].hi);
    CHECK(found.backgroundHi == found.classes[1].lo);
    CHECK(found.classes[1].lo == Approx(0.65).margin(0.005));
}

TEST_CASE("values without peaks are divided by multi-Otsu", "[classes]") {
    // An even density: n equal classes explain 1 − 1/n² of the variance: 0.94 by 4.
    const std::vector<double> even(kClassBins, 1.0);
    const ValueClasses found = findClasses({even, even}, {});
    CHECK_FALSE(found.byPeaks);
    REQUIRE(found.classes.size() == 4);
    for (std::size_t k = 0; k < 4; ++k) {
        CHECK(found.classes[k].lo == Approx(0.25 * static_cast<double>(k)).margin(0.01));
        CHECK(found.classes[k].mode == Approx(0.25 * static_cast<double>(k) + 0.125).margin(0.01));
    }
    CHECK(found.fit == Approx(1 - 1.0 / 16).margin(0.001));
}

TEST_CASE("where everything is background, what stands out is one class", "[classes]") {
    std::vector<double> spike(kClassBins, 0.0);
    spike[3] = 100;
    const ValueClasses found =
        findClasses({spike, std::vector<double>(kClassBins, 0.0)}, BackgroundValues{0.0137, 0.0137, 0.0137});
    REQUIRE(found.classes.size() == 1);
    CHECK(found.classes[0].lo == found.backgroundHi);
    CHECK(found.classes[0].hi == 1);
}
