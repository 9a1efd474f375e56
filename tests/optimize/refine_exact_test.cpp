// The incremental greedy against its reference, and against the constrained optimum.
#include <cmath>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "optimize/refine/refine_features.h"
#include "optimize/solve/least_variance.h"
#include "support/refine_cases.h"
#include "volume/loader.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

double energyAt(const LeastVariance& p, const Vector& x) {
    const Vector e = p.rows * x + p.constants;
    return (e.array() - e.mean()).square().sum();
}

/// Of variables within 0 and 1.
LeastVariance problemOf(const Matrix& rows, const Vector& constants, double total) {
    return {rows, constants, Vector::Zero(rows.cols()), Vector::Ones(rows.cols()), total};
}

/// Coefficients over several orders of magnitude, as common and rare intensities have.
LeastVariance randomProblem(std::uint32_t seed, std::size_t n) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    LeastVariance p = problemOf(Matrix::Zero(n + 1, n), Vector::Zero(n + 1), 0);
    for (std::size_t i = 0; i <= n; ++i) { // edge i between points i − 1 and i, as on a ramp
        if (i > 0) p.rows(i, i - 1) = std::pow(10, -3 * unit(random));
        if (i < n) p.rows(i, i) = random() % 8 == 0 ? 0.0 : std::pow(10, -3 * unit(random));
        if (random() % 3 == 0) p.constants[i] = 0.1 * unit(random);
    }
    p.total = unit(random) * static_cast<double>(n);
    return p;
}

/// The optimality conditions of a convex program with bounds and one sum, from central differences of the energy (exact
/// for a quadratic but for rounding): with some λ, the derivative by each x between the bounds is λ, at 0 not below it,
/// at 1 not above it.
void checkOptimal(const LeastVariance& p, const Vector& x) {
    constexpr double kStep = 1e-3, kTolerance = 1e-9;
    double freeLeast = 1e300, freeMost = -1e300, lowerLeast = 1e300, upperMost = -1e300;
    for (Eigen::Index v = 0; v < x.size(); ++v) {
        REQUIRE(x[v] >= 0);
        REQUIRE(x[v] <= 1);
        Vector more = x, less = x;
        more[v] += kStep;
        less[v] -= kStep;
        const double slope = (energyAt(p, more) - energyAt(p, less)) / (2 * kStep);
        if (x[v] > 0 && x[v] < 1) {
            freeLeast = std::min(freeLeast, slope);
            freeMost = std::max(freeMost, slope);
        } else if (x[v] == 0) {
            lowerLeast = std::min(lowerLeast, slope);
        } else {
            upperMost = std::max(upperMost, slope);
        }
    }
    CHECK(x.sum() == Approx(p.total).margin(1e-9));
    CHECK(std::max(freeMost, upperMost) <= std::min(freeLeast, lowerLeast) + kTolerance);
}

} // namespace

TEST_CASE("the incremental greedy has the bits of the one that integrates every edge anew", "[refine][reference]") {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        RefineCase c = randomRefineCase(seed);
        if (seed % 4 == 0) c.options.stepUp.reset();
        if (seed % 5 == 0) {
            c.options.untilStable = false;
            c.options.maxIterations = 500;
        }
        INFO("case " << seed);
        const RefineResult fast = refine(c.histogram, c.tf, c.options);
        const RefineResult slow = refineReference(c.histogram, c.tf, c.options);
        CHECK(fast.tf == slow.tf);
        CHECK(fast.iterations == slow.iterations);
        CHECK(fast.edgesAfter == slow.edgesAfter);
        CHECK(fast.energyMovableAfter == slow.energyMovableAfter);
        CHECK(fast.energyCurve == slow.energyCurve);
        if (!c.options.untilStable && fast.iterations > 0) CHECK(fast.iterations == 500);
    }
}

TEST_CASE("the energy curve has every iteration, and of many every second, every fourth", "[refine]") {
    const RefineCase c = randomRefineCase(2);
    RefineOptions options;
    options.untilStable = false;
    for (const int n : {0, 1, 998, 999, 1000, 1999, 2000, 5000}) {
        options.maxIterations = n;
        const RefineResult r = refine(c.histogram, tents(4), options);
        REQUIRE(r.iterations == n);
        CHECK(r.energyCurve.front() == r.energyMovableBefore);
        CHECK(r.energyCurve.size() <= 1000);
        CHECK(r.energyCurve.size() == static_cast<std::size_t>(n / r.energyCurveStride + 1));
        CHECK((r.energyCurveStride == 1) == (n < 1000));
        options.maxIterations = (n / r.energyCurveStride) * r.energyCurveStride;
        // The curve of fewer iterations is the beginning of that of more; its least value is the answer's.
        if (n < 1000) CHECK(*std::min_element(r.energyCurve.begin(), r.energyCurve.end()) == r.energyMovableAfter);
    }
}

TEST_CASE("the stopping rule costs next to nothing against 50 000 iterations", "[refine]") {
    // How far the greedy answer is above the best that 50 000 iterations find, of each case.
    const auto excess = [](const Histogram& h, const TransferFunction& tf, RefineOptions options) {
        const double stopped = refine(h, tf, options).energyMovableAfter;
        options.untilStable = false;
        options.maxIterations = 50000;
        const double best = refine(h, tf, options).energyMovableAfter;
        return best > 0 ? stopped / best - 1 : 0.0;
    };
    VolumeSource source;
    source.path = "sample:knee";
    source.sampleSize = 96;
    const Histogram knee = makeHistogram(loadVolume(source));
    for (const TransferFunction& tf : {tents(3), tents(6), tents(12), ramp(6), ramp(16)})
        for (const double x0 : {-1.0, 0.1, 0.4, 0.9}) {
            RefineOptions options;
            if (x0 >= 0) options.priority.intensity = x0;
            CHECK(excess(knee, tf, options) <= 0.02);
        }
    // Of random cases one in some hundred stops on the way over a hill (docs/method.md).
    int above = 0;
    constexpr int kCases = 200;
    for (std::uint32_t seed = 0; seed < kCases; ++seed) {
        const RefineCase c = randomRefineCase(seed);
        if (excess(c.histogram, c.tf, c.options) > 0.02) ++above;
    }
    CHECK(above <= kCases / 100);
}

TEST_CASE("least variance: two numbers that can be made equal are", "[refine][exact]") {
    // e = (x0, 3 x1), x0 + x1 = 1: equal at x0 = ¾. Under a total of 1.6 that would be x0 = 1.2: it stays at 1.
    LeastVariance p = problemOf(Matrix{{1, 0}, {0, 3}}, Vector::Zero(2), 1);
    const auto even = solve(p, Vector{{0.5, 0.5}});
    CHECK(even.x[0] == Approx(0.75));
    CHECK(even.x[1] == Approx(0.25));
    CHECK(even.energy == Approx(0).margin(1e-20));
    p.total = 1.6;
    const auto bound = solve(p, Vector{{0.8, 0.8}});
    CHECK(bound.x[0] == 1);
    CHECK(bound.x[1] == Approx(0.6));
    CHECK(bound.energy == Approx(2 * 0.4 * 0.4)); // e = (1, 1.8), each 0.4 off the mean
}

TEST_CASE("least variance: nothing is moved where nothing depends on it", "[refine][exact]") {
    const LeastVariance flat = problemOf(Matrix::Zero(2, 2), Vector{{1, 2}}, 1);
    CHECK(solve(flat, Vector{{0.3, 0.7}}).x == Vector{{0.3, 0.7}});
    // The second variable weighs nothing: it takes what the first one gives up.
    const LeastVariance half = problemOf(Matrix{{1, 0}, {0, 0}}, Vector::Zero(2), 1);
    const auto x = solve(half, Vector{{0.5, 0.5}}).x;
    CHECK(x[0] == Approx(0).margin(1e-12));
    CHECK(x[1] == Approx(1));
}

TEST_CASE("least variance: a total beyond the bounds is the nearest possible", "[refine][exact]") {
    const LeastVariance full = problemOf(Matrix{{1, 0, 0}, {0, 2, 0}}, Vector::Zero(2), 7);
    CHECK(solve(full, Vector{{0.1, 0.2, 0.3}}).x == Vector::Ones(3));
    LeastVariance none = full;
    none.total = 0;
    CHECK(solve(none, Vector{{0.1, 0.2, 0.3}}).x == Vector::Zero(3));
}

TEST_CASE("the nearest opacities of a total are shifted alike until they meet a bound", "[refine][exact]") {
    // (0.1, 0.5, 0.9) to 2: by 0.2 were (0.3, 0.7, 1.1); the last stays at 1, so that the others go up by 0.2 each.
    const Vector x = nearestOfTotal(Vector{{0.1, 0.5, 0.9}}, 2, Vector::Zero(3), Vector::Ones(3));
    CHECK(x[0] == Approx(0.3));
    CHECK(x[1] == Approx(0.7));
    CHECK(x[2] == 1);
}

TEST_CASE("least variance: no point of a fine grid is better", "[refine][exact]") {
    for (std::uint32_t seed = 0; seed < 30; ++seed) {
        LeastVariance p = randomProblem(seed, 3);
        const auto found = solve(p, Vector::Constant(3, 0.5));
        INFO("case " << seed);
        double best = 1e300;
        constexpr int kSteps = 300;
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; j <= kSteps; ++j) {
                const double a = i / double{kSteps}, b = j / double{kSteps}, c = p.total - a - b;
                if (c >= 0 && c <= 1) best = std::min(best, energyAt(p, Vector{{a, b, c}}));
            }
        CHECK(found.energy <= best + 1e-15);
        CHECK(found.energy == Approx(energyAt(p, found.x)));
        CHECK(found.energy >= best - 1e-2); // the grid is as near as its steps
    }
}

TEST_CASE("least variance: the answer meets the conditions of an optimum", "[refine][exact]") {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const std::size_t n = seed < 50 ? 2 + seed % 20 : 60 + 14 * (seed - 50);
        const LeastVariance p = randomProblem(100 + seed, n);
        INFO("case " << seed << ", " << n << " variables");
        const auto answer = solve(p, Vector::Constant(n, 0.5));
        checkOptimal(p, answer.x);
    }
}

TEST_CASE("the exact method is never worse than greedy at equal total opacity", "[refine][exact]") {
    int better = 0;
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        const RefineCase c = randomRefineCase(seed);
        INFO("case " << seed);
        const RefineComparison both = compareMethods(c.histogram, c.tf, c.options);
        CHECK(both.exactEnergy <= both.greedyEnergy);
        CHECK(both.greedyEnergy == refine(c.histogram, c.tf, c.options).energyMovableAfter);
        CHECK(movableOpacity(both.exact) == Approx(both.total).margin(1e-9));
        better += both.exactEnergy < 0.9 * both.greedyEnergy;
    }
    CHECK(better > 100);
}

TEST_CASE("the exact method keeps the start's total opacity, and all that is fixed", "[refine][exact]") {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        RefineCase c = randomRefineCase(seed);
        c.options.method = RefineMethod::Exact;
        INFO("case " << seed);
        const RefineResult r = refine(c.histogram, c.tf, c.options);
        CHECK(r.energyMovableAfter <= r.energyMovableBefore);
        if (movesFeatures(c.tf, c.options)) { // tents of which one is chosen: what stays is their part of Σ α·p
            const auto amount = [&](const TransferFunction& tf) {
                return FeatureLine(c.histogram, tf, c.options.priority).movableAmount();
            };
            CHECK(amount(r.tf) == Approx(amount(c.tf)).margin(1e-9));
            continue;
        }
        CHECK(movableOpacity(r.tf) == Approx(movableOpacity(c.tf)).margin(1e-9));
        CHECK(r.edgesAfter == edgeWeights(c.histogram, r.tf, c.options.priority));
        CHECK(r.energyCurve == std::vector<double>{r.energyMovableBefore, r.energyMovableAfter});
        for (std::size_t i = 0; i < c.tf.points.size(); ++i) {
            CHECK(r.tf.points[i].opacity >= 0);
            CHECK(r.tf.points[i].opacity <= 1);
            CHECK(r.tf.points[i].x == c.tf.points[i].x);
            if (c.tf.points[i].fixed) CHECK(r.tf.points[i].opacity == c.tf.points[i].opacity);
        }
        c.options.total = 0.25;
        if (r.tf != c.tf) CHECK(movableOpacity(refine(c.histogram, c.tf, c.options).tf) == Approx(0.25).margin(1e-9));
    }
    RefineOptions options;
    options.total = -1;
    CHECK_THROWS_AS(options.validate(), UsageError);
}

TEST_CASE("methods have names", "[refine]") {
    for (const RefineMethod method : {RefineMethod::Greedy, RefineMethod::Exact})
        CHECK(findNamed<RefineMethod>(name(method)) == method);
    CHECK_FALSE(findNamed<RefineMethod>("best"));
}
