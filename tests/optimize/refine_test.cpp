#include <catch2/catch.hpp>

#include <cmath>
#include <numeric>

#include "base/error.h"
#include "optimize/refine/refine.h"

using namespace pellucid;

namespace {

Histogram histogramOf(std::vector<std::uint64_t> counts) {
    Histogram h;
    h.total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    h.counts = std::move(counts);
    return h;
}

Histogram uneven(int bins = 256) {
    std::vector<std::uint64_t> counts;
    for (int b = 0; b < bins; ++b)
        counts.push_back(static_cast<std::uint64_t>(2000 * std::exp(-0.03 * b) + 10 * (b % 7)));
    return histogramOf(counts);
}

} // namespace

TEST_CASE("edge weights are exact integrals of −α p ln p", "[refine]") {
    // Two bins, p = ¾ and ¼: g = −p ln p on [0,½) and [½,1]. One point (½, 1): α rises 2x, falls 2(1 − x).
    // e(0) = g0·∫ 2x = g0/4, e(1) = g1/4.
    TransferFunction tf;
    tf.points = {{0.5, 1.0, {}, false, {}}};
    const double g0 = -0.75 * std::log(0.75), g1 = -0.25 * std::log(0.25);
    const auto edges = edgeWeights(histogramOf({3, 1}), tf);
    REQUIRE(edges.size() == 2);
    CHECK(edges[0] == Approx(g0 / 4).epsilon(1e-12));
    CHECK(edges[1] == Approx(g1 / 4).epsilon(1e-12));
    // Their mean is m; E = 2·((e0 − e1)/2)².
    CHECK(edgeEnergy(edges) == Approx(2 * std::pow((g0 - g1) / 8, 2)).epsilon(1e-9));
}

TEST_CASE("an edge may end inside a bin", "[refine]") {
    // One point (¼, 1) over the same bins: e(1) covers [¼,½) of bin 0 and all of bin 1; α = (1 − x)/¾ there.
    // ∫_¼^½ (1 − x) = (9/16 − 4/16)/2 = 5/32; ∫_½^1 = 1/8.
    TransferFunction tf;
    tf.points = {{0.25, 1.0, {}, false, {}}};
    const double g0 = -0.75 * std::log(0.75), g1 = -0.25 * std::log(0.25);
    const auto edges = edgeWeights(histogramOf({3, 1}), tf);
    CHECK(edges[0] == Approx(g0 / 8).epsilon(1e-12));
    CHECK(edges[1] == Approx((g0 * 5 / 32 + g1 / 8) / 0.75).epsilon(1e-12));
}

TEST_CASE("the exact integral agrees with a fine sum", "[refine]") {
    const Histogram h = uneven();
    const TransferFunction tf = tents(6);
    const auto edges = edgeWeights(h, tf);
    const auto points = tf.pointsWithEnds();
    for (std::size_t i = 0; i < edges.size(); ++i) {
        constexpr int kSteps = 200000;
        double sum = 0;
        for (int n = 0; n < kSteps; ++n) {
            const double x = points[i].x + (points[i + 1].x - points[i].x) * (n + 0.5) / kSteps;
            const double p = h.p(static_cast<std::size_t>(histogramBin(x, 256)));
            sum += -tf.opacity(x) * p * std::log(p);
        }
        CHECK(edges[i] == Approx(sum * (points[i + 1].x - points[i].x) / kSteps).epsilon(1e-5).margin(1e-12));
    }
}

TEST_CASE("empty bins and a single full one weigh nothing", "[refine]") {
    // p = 1 in one bin: ln p = 0; p = 0 in the others: 0·ln 0 = 0.
    for (const double e : edgeWeights(histogramOf({0, 7, 0, 0}), tents(3))) CHECK(e == 0);
}

TEST_CASE("one iteration lowers the heavier edge's end and raises the lighter one's", "[refine]") {
    // Four bins: all weight in the first two. Points at ¼ (in bin 1) and ¾ (in bin 3, empty: significance 0).
    TransferFunction tf;
    tf.points = {{0.25, 0.5, {}, false, {}}, {0.75, 0.5, {}, false, {}}};
    RefineOptions options;
    options.maxIterations = 1;
    const Histogram h = histogramOf({5, 5, 0, 0});
    // e(0) = g·½·¼·½ over bin 0; e(1) covers bin 1 at α = ½: twice that; e(2) = 0.
    const auto edges = edgeWeights(h, tf);
    REQUIRE(edges[1] > edges[0]);
    REQUIRE(edges[2] == 0);
    const RefineResult r = refine(h, tf, options);
    CHECK(r.iterations == 1);
    CHECK(r.tf.points[0].opacity == Approx(0.5 - 1.0 / 256)); // heaviest edge 1: the end of larger significance
    CHECK(r.tf.points[1].opacity == Approx(0.5 + 1.0 / 256)); // lightest edge 2: its other end is fixed
    CHECK(r.energyMovableAfter < r.energyMovableBefore);
}

TEST_CASE("a fixed end gives way to the other end", "[refine]") {
    TransferFunction tf;
    tf.points = {{0.25, 0.5, {}, true, {}}, {0.75, 0.5, {}, false, {}}};
    RefineOptions options;
    options.maxIterations = 50;
    const RefineResult r = refine(uneven(), tf, options);
    CHECK(r.tf.points[0].opacity == 0.5);
}

TEST_CASE("refinement lowers the energy of tents and of ramps and moves only movable opacities", "[refine]") {
    for (const TransferFunction& tf : {tents(6), ramp(6), tents(3, 1.0), tents(3, 0.0)}) {
        const RefineResult r = refine(uneven(), tf);
        CHECK(r.energyMovableAfter < r.energyMovableBefore + (r.energyMovableBefore == 0 ? 1e-30 : 0));
        CHECK(r.edgesAfter == edgeWeights(uneven(), r.tf));
        CHECK(r.energyAfter == Approx(edgeEnergy(r.edgesAfter)));
        REQUIRE(r.tf.points.size() == tf.points.size());
        for (std::size_t i = 0; i < tf.points.size(); ++i) {
            CHECK(r.tf.points[i].x == tf.points[i].x);
            CHECK(r.tf.points[i].color == tf.points[i].color);
            if (tf.points[i].fixed) CHECK(r.tf.points[i].opacity == tf.points[i].opacity);
            CHECK(r.tf.points[i].opacity >= 0);
            CHECK(r.tf.points[i].opacity <= 1);
        }
        CHECK(r.iterations <= 5000);
    }
}

TEST_CASE("the best transfer function seen is the answer, not the last", "[refine]") {
    // With these coarse steps the search soon jumps about; more iterations can only help.
    RefineOptions coarse;
    coarse.stepDown = 0.4;
    coarse.stepUp = 0.4;
    double last = 1e300;
    for (const int n : {0, 1, 2, 5, 20, 200}) {
        coarse.maxIterations = n;
        const double energy = refine(uneven(), tents(5), coarse).energyMovableAfter;
        CHECK(energy <= last);
        last = energy;
    }
}

TEST_CASE("with nothing to move nothing moves", "[refine]") {
    TransferFunction tf = tents(3);
    for (ControlPoint& p : tf.points) p.fixed = true;
    const RefineResult r = refine(uneven(), tf);
    CHECK(r.iterations == 0);
    CHECK(r.tf == tf);
    CHECK(refine(histogramOf(std::vector<std::uint64_t>(256, 0)), tents(3)).tf == tents(3)); // no valid voxel
}

TEST_CASE("the step up can follow the significances", "[refine]") {
    RefineOptions options;
    options.stepUp.reset();
    const RefineResult r = refine(uneven(), tents(4), options);
    CHECK(r.energyMovableAfter < r.energyMovableBefore);
}

TEST_CASE("impossible refinement options are refused", "[refine]") {
    RefineOptions options;
    options.stepDown = 0;
    CHECK_THROWS_AS(refine(uneven(), tents(3), options), UsageError);
    options = {};
    options.stepUp = 2;
    CHECK_THROWS_AS(refine(uneven(), tents(3), options), UsageError);
    options = {};
    options.maxIterations = -1;
    CHECK_THROWS_AS(refine(uneven(), tents(3), options), UsageError);
}
