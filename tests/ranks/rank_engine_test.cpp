// Blocks on ranks against the same volume in one piece: the engine samples both as it samples large volumes.
#include <catch2/catch.hpp>

#include <cmath>

#include "base/parallel.h"
#include "ranks/rank_engine.h"
#include "render/cpu/cpu_engine.h"
#include "saliency/saliency_field.h"
#include "saliency/vws.h"
#include "support/random_cases.h"
#include "support/thread_ranks.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// The weights of a block, taken out of those of the whole.
WeightFields partOf(const WeightFields& whole, const VoxelRegion& region, const SaliencyOptions& options) {
    const Int3 dims = region.hi - region.lo;
    WeightFields part = emptyWeightFields(dims, options);
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) {
                const std::uint32_t units =
                    whole.units(voxelIndex(whole.dims(), i + region.lo.x, j + region.lo.y, k + region.lo.z));
                part.store(voxelIndex(dims, i, j, k), &units, 1);
            }
    return part;
}

double largestDifference(const FeatureSums& a, const FeatureSums& b) {
    double most = 0;
    const auto one = featureMeasures(a), other = featureMeasures(b);
    for (std::size_t f = 0; f < one.size(); ++f)
        most = std::max({most, std::abs(one[f].visibility - other[f].visibility), std::abs(one[f].vws - other[f].vws)});
    return most;
}

/// The figures of `c` on so many ranks, from a block with its weights; body(engine, weights) on each rank.
template <class Body>
void onBlocks(const RandomCase& c, int count, const WeightFields& weights, const Body& body) {
    const Decomposition blocks(c.volume->dims(), count);
    onRanks(count, [&](Communicator& ranks) {
        const BlockVolume block = blockOf(c.volume, blocks, ranks.rank(), Int3(kRayGhosts));
        const WeightFields own = block.isEmpty() ? emptyWeightFields({1, 1, 1}, {}) : partOf(weights, block.region, {});
        const auto engine = makeRankEngine(ranks, block);
        body(ranks, block, *engine, own);
    });
}

/// Opacities of the features times `factor`.
TransferFunction scaled(const TransferFunction& tf, double factor) {
    std::vector<double> opacities = featureOpacities(tf);
    for (double& x : opacities) x *= factor;
    return withFeatureOpacities(tf, opacities);
}

} // namespace

TEST_CASE("blocks on ranks measure what one process measures", "[ranks]") {
    // What lies behind the depth at which rays are given up is seen by 1e-3 at most, and the two give up at other
    // slices: where nearly all that is seen is that, in 1 of the 48 cases, figures differ by up to 6e-4.
    int different = 0;
    double most = 0;
    for (std::uint32_t number = 0; number < 48; ++number) {
        const RandomCase c = randomCase(number, 1.5, {number % 3 == 1, number % 4 >= 2, number % 4 == 3});
        INFO(c.describe());
        const WeightFields weights = saliencyFields(*c.volume, c.tf, {});
        const auto whole = makeDraftEngine(c.volume);
        const FeatureSums expected = whole->sums(c.view(), {&c.tf, 1}, &weights)[0];
        // Behind a faint rest that is dense there may be nothing but what rays have been given up for.
        if (!c.clipping.rest.isNone() && expected.allVisibility < 1) continue;
        double ofCase = 0;
        for (const int count : {1, 2, 3, 8})
            onBlocks(c, count, weights,
                     [&](Communicator& ranks, const BlockVolume&, VisibilityEngine& engine, const WeightFields& own) {
                         const FeatureSums sums = engine.sums(c.view(), {&c.tf, 1}, &own)[0];
                         if (ranks.rank() != 0) return;
                         INFO(count << " ranks");
                         const double difference = largestDifference(sums, expected);
                         CHECK(difference < (count == 1 ? 1e-5 : 1e-3));
                         CHECK(sums.allVisibility == Approx(expected.allVisibility).epsilon(2e-3).margin(1e-6));
                         ofCase = std::max(ofCase, difference);
                     });
        different += ofCase >= 1e-4;
        most = std::max(most, ofCase);
    }
    CHECK(different <= 1);
    CHECK(most < 1e-3);
}

TEST_CASE("eight candidates and derivatives on ranks are those of one process", "[ranks]") {
    int different = 0;
    for (std::uint32_t number = 100; number < 124; ++number) {
        const RandomCase c = randomCase(number, 1.5, {number % 3 == 1, number % 4 >= 2, number % 4 == 3});
        INFO(c.describe());
        const WeightFields weights = saliencyFields(*c.volume, c.tf, {});
        const auto whole = makeDraftEngine(c.volume);
        std::vector<TransferFunction> tfs;
        for (int n = 0; n < 8; ++n) tfs.push_back(scaled(c.tf, 1.0 / (n + 1)));
        const auto expected = whole->sums(c.view(), tfs, &weights);
        const SumsJacobian jacobian = whole->jacobian(c.view(), c.tf, &weights);
        const auto slopes = vwsJacobian(jacobian);
        double largest = 0; // of the derivatives
        for (const auto& row : slopes)
            for (const double d : row) largest = std::max(largest, std::abs(d));
        bool differs = false;
        onBlocks(c, 4, weights,
                 [&](Communicator& ranks, const BlockVolume&, VisibilityEngine& engine, const WeightFields& own) {
                     const auto sums = engine.sums(c.view(), tfs, &own);
                     const auto found = vwsJacobian(engine.jacobian(c.view(), c.tf, &own));
                     if (ranks.rank() != 0) return;
                     for (std::size_t n = 0; n < tfs.size(); ++n) {
                         CHECK(largestDifference(sums[n], expected[n]) < 1e-3);
                         differs |= largestDifference(sums[n], expected[n]) >= 1e-4;
                     }
                     for (std::size_t i = 0; i < slopes.size(); ++i)
                         for (std::size_t j = 0; j < slopes.size(); ++j) {
                             CHECK(std::abs(found[i][j] - slopes[i][j]) < 5e-3 * largest + 1e-7);
                             differs |= std::abs(found[i][j] - slopes[i][j]) >= 1e-3 * largest + 1e-7;
                         }
                 });
        different += differs;
    }
    CHECK(different <= 1);
}

TEST_CASE("the field of visibility is made block by block", "[ranks]") {
    for (const std::uint32_t number : {3u, 11u, 20u}) {
        const RandomCase c = randomCase(number, 1.5);
        INFO(c.describe());
        const VisibilityField expected = makeDraftEngine(c.volume)->field(c.view(), c.tf);
        Grid<float> found(c.volume->dims(), -1.0f);
        onBlocks(c, 5, saliencyFields(*c.volume, c.tf, {}),
                 [&](Communicator&, const BlockVolume& block, VisibilityEngine& engine, const WeightFields&) {
                     const VisibilityField field = engine.field(c.view(), c.tf);
                     if (isEmpty(block.block())) return;
                     for (int k = block.block().lo.z; k < block.block().hi.z; ++k)
                         for (int j = block.block().lo.y; j < block.block().hi.y; ++j)
                             for (int i = block.block().lo.x; i < block.block().hi.x; ++i)
                                 found.at(i, j, k) = field.values.at(i - block.region.lo.x, j - block.region.lo.y,
                                                                     k - block.region.lo.z);
                 });
        double most = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
            most = std::max(most, static_cast<double>(std::abs(found[i] - expected.values[i])));
        CHECK(most < 2e-3); // 1e-3 behind the depth at which rays are given up
    }
}

TEST_CASE("the same blocks have the same bits for any number of threads", "[ranks]") {
    const RandomCase c = randomCase(17, 1.5);
    const WeightFields weights = saliencyFields(*c.volume, c.tf, {});
    std::vector<FeatureSums> found;
    for (const int threads : {1, 3}) {
        setThreadCount(threads);
        onBlocks(c, 3, weights,
                 [&](Communicator& ranks, const BlockVolume&, VisibilityEngine& engine, const WeightFields& own) {
                     const FeatureSums sums = engine.sums(c.view(), {&c.tf, 1}, &own)[0];
                     if (ranks.rank() == 1) found.push_back(sums);
                 });
    }
    setThreadCount(0);
    CHECK(found[0].visibility == found[1].visibility);
    CHECK(found[0].weighted == found[1].weighted);
}
