// Refinement by the published profile, against sums by hand and against a search that is written down anew.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "optimize/refine/refine.h"
#include "optimize/refine/refine_edges.h"
#include "optimize/refine/refine_features.h"
#include "support/refine_cases.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

Histogram histogramOf(std::vector<std::uint64_t> counts) {
    Histogram h;
    h.counts = std::move(counts);
    for (const std::uint64_t c : h.counts) h.total += c;
    return h;
}

constexpr Profile kPublished = Profile::Published;

RefineOptions published() {
    RefineOptions options;
    options.profile = kPublished;
    options.stepDown = kPublishedStep;
    options.stepUp = kPublishedStep;
    return options;
}

/// Tents as the thesis's files have them: two points of opacity 0 about each peak.
TransferFunction threeTents() {
    TransferFunction tf;
    const double places[3][3] = {{20, 40, 60}, {80.5, 100, 130}, {150, 201, 255}}; // of 255
    const double peaks[] = {26, 77, 153};                                          // likewise
    for (std::size_t t = 0; t < 3; ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const Rgb color = rgbFromHsv(10 + 120.0 * static_cast<double>(t), 1, 1);
            tf.points.push_back({places[t][i] / 255, i == 1 ? peaks[t] / 255 : 0, color, i != 1, {}});
        }
    tf.features = deriveFeatures(tf);
    return tf;
}

Histogram unevenHistogram(int seed) {
    std::vector<std::uint64_t> counts;
    for (int b = 0; b < 256; ++b)
        counts.push_back(static_cast<std::uint64_t>(1000 * std::abs(std::sin(0.37 * b + seed)) * std::exp(-b / 90.0)));
    return histogramOf(counts);
}

/// One edge: Σ over the whole values v with x0 ≤ v/255 < x1 of d α (−p ln p), α and d linear.
double edgeSum(const Histogram& h, const ControlPoint& p, const ControlPoint& q, double d0, double d1) {
    double sum = 0;
    for (int v = 0; v < 256; ++v) {
        const double x = v / 255.0;
        if (x < p.x - 1e-12 || x >= q.x - 1e-12) continue;
        const double share = static_cast<double>(h.counts[static_cast<std::size_t>(v)]) / static_cast<double>(h.total);
        if (share == 0) continue;
        const double t = (x - p.x) / (q.x - p.x);
        sum -= (p.opacity + (q.opacity - p.opacity) * t) * (d0 + (d1 - d0) * t) * share * std::log(share);
    }
    return sum;
}

std::vector<double> edgeSums(const Histogram& h, const std::vector<ControlPoint>& points,
                             const std::vector<double>& factors) {
    std::vector<double> edges;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        edges.push_back(edgeSum(h, points[i], points[i + 1], factors[i], factors[i + 1]));
    return edges;
}

double variance(const std::vector<double>& all, const std::vector<std::size_t>& which) {
    double mean = 0, sum = 0;
    for (const std::size_t i : which) mean += all[i] / static_cast<double>(which.size());
    for (const std::size_t i : which) sum += (all[i] - mean) * (all[i] - mean);
    return sum;
}

/// The search as it reads, all sums anew in each iteration. Points with the ends, opacities refined.
std::vector<ControlPoint> searched(const Histogram& h, const TransferFunction& tf, const std::vector<double>& factors,
                                   int most) {
    std::vector<ControlPoint> points = tf.pointsWithEnds();
    const auto significance = [&](std::size_t i) {
        const auto v = static_cast<std::size_t>(std::floor(points[i].x * 255 + 1e-9));
        const double share = static_cast<double>(h.counts[v]) / static_cast<double>(h.total);
        return share > 0 ? -points[i].opacity * share * std::log(share) : 0;
    };
    const auto endOf = [&](std::size_t edge, bool larger) {
        if (points[edge].fixed) return edge + 1;
        if (points[edge + 1].fixed) return edge;
        const double a = significance(edge), b = significance(edge + 1);
        return (larger ? b > a : b < a) ? edge + 1 : edge;
    };
    std::vector<std::size_t> part; // edges that take part
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        if ((!points[i].fixed || !points[i + 1].fixed) && points[i].opacity > 0) part.push_back(i);
    std::vector<ControlPoint> best = points;
    double least = variance(edgeSums(h, points, factors), part);
    for (int n = 0, since = 0; n < most && since < 2 * static_cast<int>(points.size() - 1); ++n, ++since) {
        const std::vector<double> edges = edgeSums(h, points, factors);
        std::size_t heavy = edges.size(), light = edges.size();
        for (const std::size_t i : part) {
            if (points[i].opacity == 0) continue;
            if (heavy == edges.size() || edges[i] > edges[heavy]) heavy = i;
            if (light == edges.size() || edges[i] < edges[light]) light = i;
        }
        if (heavy == edges.size()) break;
        const std::size_t down = endOf(heavy, true), up = endOf(light, false);
        points[down].opacity = std::max(0.0, points[down].opacity - 1.0 / 255);
        points[up].opacity = std::min(1.0, points[up].opacity + 1.0 / 255);
        if (const double energy = variance(edgeSums(h, points, factors), part); energy < least) {
            least = energy;
            best = points;
            since = -1;
        }
    }
    return best;
}

} // namespace

TEST_CASE("published edge weights are sums over whole bins", "[refine][published]") {
    // Bins 0 to 4 stand for 0, 1/4, 1/2, 3/4 and 1. p = 1/8, 1/16, 1/16, 1/4, 1/2; with L = ln 2 −p ln p is
    // 3L/8, L/4, L/4, L/2, L/2. Edges: [0, 1/4) has bin 0 and no opacity; [1/4, 3/4) bin 1 at opacity 0 and bin 2 at
    // 0.4: 0.4·L/4; [3/4, 1) bin 3 at 0.8: 0.8·L/2. The bin of 1 belongs to no edge.
    TransferFunction tf;
    tf.points = {{0.25, 0, {}, true, {}}, {0.75, 0.8, {}, false, {}}};
    const Histogram h = histogramOf({4, 2, 2, 8, 16});
    const double L = std::log(2.0);
    const auto edges = edgeWeights(h, tf, {}, kPublished);
    REQUIRE(edges.size() == 3);
    CHECK(edges[0] == 0);
    CHECK(edges[1] == Approx(0.1 * L));
    CHECK(edges[2] == Approx(0.4 * L));
    // Edges that begin at opacity 0 take no part: the last one alone has nothing to differ from.
    const RefineResult r = refine(h, tf, published());
    CHECK(r.energyMovableBefore == 0);
    CHECK(r.energyBefore == Approx(L * L * (0.01 + 0.16 - 0.25 / 3))); // Σe² − (Σe)²/3
    const auto parts = refineEdges(tf, published());
    CHECK_FALSE(parts[1].participates);
    CHECK(parts[2].participates);
    // value/255 is a whole bin, whatever rounding made of it.
    for (int v = 0; v < 256; ++v) CHECK(wholeBin(v / 255.0, 256) == v);
    CHECK(wholeBin(80.5 / 255, 256) == Approx(80.5));
}

TEST_CASE("published distances are over their sum, and hues are not wrapped", "[refine][published]") {
    TransferFunction tf;
    tf.points = {{0.2, 0.5, rgbFromHsv(350, 1, 1), false, {}},
                 {0.5, 0.5, rgbFromHsv(10, 0.7, 0.4), false, {}},
                 {0.8, 0.5, {0.5, 0.5, 0.5}, false, {}}};
    RefinePriority priority;
    priority.intensity = 0.5; // distances 0.5, 0.3, 0, 0.3, 0.5 of the points with their ends: 1.6 together
    const auto near = pointFactors(tf, priority, kPublished);
    const double distances[] = {0.5, 0.3, 0, 0.3, 0.5};
    REQUIRE(near.size() == 5);
    for (std::size_t i = 0; i < 5; ++i) CHECK(near[i] == Approx(distances[i] / 1.6).margin(1e-15));
    // One pixel of hue 10 and two of hue 350: from 350 it is 340/360 + 0, from 10 0 + 2·340/360, and grey is 1 from
    // any. The ends have their neighbours' colours.
    priority = {};
    priority.region = {{rgbFromHsv(10, 1, 1), 1}, {rgbFromHsv(350, 0.5, 1), 2}};
    const double turn = 340.0 / 360, sums[] = {turn, turn, 2 * turn, 3, 3};
    const auto far = pointFactors(tf, priority, kPublished);
    for (std::size_t i = 0; i < 5; ++i) CHECK(far[i] == Approx(sums[i] / (4 * turn + 6)));
    // All alike, and no priority.
    priority = {};
    priority.region = {{rgbFromHsv(40, 1, 1), 3}};
    for (ControlPoint& p : tf.points) p.color = rgbFromHsv(40, 0.3, 0.9);
    CHECK(pointFactors(tf, priority, kPublished)[2] == Approx(1.0 / 5).margin(1e-12));
    CHECK(pointFactors(tf, {}, kPublished) == std::vector<double>(5, 1.0));
}

TEST_CASE("the published search takes the steps of one that is written down anew", "[refine][published]") {
    for (const int seed : {1, 2, 3}) {
        const Histogram h = unevenHistogram(seed);
        for (const TransferFunction& tf : {threeTents(), tents(4), ramp(6)})
            for (const std::optional<double>& x0 : {std::optional<double>(), std::optional<double>(0.4)}) {
                RefineOptions options = published();
                options.priority.intensity = x0;
                const auto factors = pointFactors(tf, options.priority, kPublished);
                const RefineResult r = refine(h, tf, options);
                const auto expected = searched(h, tf, factors, options.maxIterations);
                const auto points = r.tf.pointsWithEnds();
                REQUIRE(points.size() == expected.size());
                for (std::size_t i = 0; i < points.size(); ++i)
                    CHECK(points[i].opacity == Approx(expected[i].opacity).margin(1e-12));
                const auto edges = edgeSums(h, expected, factors);
                for (std::size_t i = 0; i < edges.size(); ++i)
                    CHECK(r.edgesAfter[i] == Approx(edges[i]).epsilon(1e-9).margin(1e-15));
                CHECK(r.energyMovableAfter < r.energyMovableBefore);
                CHECK(refineReference(h, tf, options).tf == r.tf);
            }
    }
}

TEST_CASE("published refinement moves points, and exact is never worse at its total", "[refine][published]") {
    const Histogram h = unevenHistogram(5);
    TransferFunction touching; // two features that share a border at opacity 0.5
    touching.points = {
        {0.1, 0, {}, true, {}}, {0.3, 0.5, {}, false, {}}, {0.6, 0.5, {}, false, {}}, {0.9, 0, {}, true, {}}};
    touching.features = {{"a", 0.1, 0.45, {}, {}}, {"b", 0.45, 0.9, {}, {}}};
    CHECK(movesFeatures(touching));
    CHECK_FALSE(movesFeatures(touching, published()));
    for (const TransferFunction& tf : {threeTents(), tents(4), touching}) {
        RefineOptions options = published();
        options.priority.intensity = 0.4;
        const RefineComparison c = compareMethods(h, tf, options);
        CHECK(c.exactEnergy <= c.greedyEnergy * (1 + 1e-9));
        CHECK(movableOpacity(c.exact) == Approx(c.total));
        CHECK(c.greedyEnergy == refine(h, tf, options).energyMovableAfter);
    }
}
