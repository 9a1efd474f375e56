// Blocks that have as much to do as each other.
#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <array>

#include "ranks/block_balance.h"
#include "ranks/rank_engine.h"
#include "ranks/rank_volume.h"
#include "render/cpu/cpu_engine.h"
#include "saliency/saliency_field.h"
#include "saliency/vws.h"
#include "support/temp_folder.h"
#include "support/thread_ranks.h"
#include "volume/loader.h"
#include "volume/voxel_loops.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

constexpr int kRanks = 4;
const Int3 kDims(128, 64, 64);

/// A ball of values 128 to 255 about `middle`, else 0.
Volume ballAbout(const Vec3& middle, double radius) {
    Geometry geometry;
    geometry.dims = kDims;
    std::vector<std::uint8_t> values(voxelCount(kDims));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double r = glm::length(Vec3(voxelAt(kDims, i)) - middle) / radius;
        values[i] = r < 1 ? static_cast<std::uint8_t>(255 - 127 * r) : 0;
    }
    return Volume(geometry, SampleArray<std::uint8_t>(std::move(values)));
}

/// Nothing below 0.4 of the range, all above.
TransferFunction solid() {
    TransferFunction tf;
    const Rgb color{0.8, 0.6, 0.4};
    tf.points = {{0, 0, color, false, {}},
                 {0.4, 0, color, false, {}},
                 {0.41, 0.3, color, false, {}},
                 {1, 0.3, color, false, {}}};
    tf.features = {{"ball", 0.4, 1, color, {}}};
    tf.range = ValueRange{0, 255};
    return tf;
}

/// Of each block: its part of the work, counted voxel by voxel.
std::vector<double> workIn(const std::vector<VoxelRegion>& blocks, const Volume& volume) {
    std::vector<double> work;
    double all = 0;
    for (const VoxelRegion& block : blocks) {
        double& count = work.emplace_back(0);
        for (int k = block.lo.z; k < block.hi.z; ++k)
            for (int j = block.lo.y; j < block.hi.y; ++j)
                for (int i = block.lo.x; i < block.hi.x; ++i)
                    count += volume.value(voxelIndex(kDims, i, j, k)) > 0.4 * 255 ? 1 : kEmptyWork;
        all += count;
    }
    for (double& part : work) part /= all;
    return work;
}

VolumeSource written(const TempFolder& folder, const Volume& volume) {
    VolumeSource source;
    source.path = folder.path("v.nrrd");
    writeNrrd(volume, source.path);
    return source;
}

RankLayout small() { return {.smallest = 1}; }

} // namespace

TEST_CASE("blocks are cut anew where a transfer function shows what few of them have", "[ranks][balance]") {
    const TempFolder folder;
    const Volume whole = ballAbout({20, 32, 32}, 26);
    const VolumeSource source = written(folder, whole);
    const TransferFunction tf = solid();
    const auto shared = std::make_shared<const Volume>(whole.withRange({0, 255}));
    const WeightFields weights = saliencyFields(*shared, tf);
    const Camera camera = cameraFromView(whole.geometry(), 40, 20, 1, Projection::Perspective);
    const View view{camera, {}};
    const auto expected = featureMeasures(makeDraftEngine(shared)->sums(view, {&tf, 1}, &weights)[0]);
    std::array<RankLayout, kRanks> layouts;
    layouts.fill(small());
    std::array<int, kRanks> cut{}, again{};
    std::array<std::vector<FeatureMeasures>, kRanks> measured;
    std::vector<double> before, after;
    onRanks(kRanks, [&](Communicator& ranks) {
        const auto rank = static_cast<std::size_t>(ranks.rank());
        RankLayout& layout = layouts[rank];
        Volume v = loadOnRanks(ranks, source, layout).withRange({0, 255});
        const auto blocksOf = [&] { return dynamic_cast<const RankVoxels&>(*v.elsewhere()).blocks().blocks(); };
        if (rank == 0) before = workIn(blocksOf(), whole);
        cut[rank] = cutByWork(v, tf, {}, {});
        v = loadOnRanks(ranks, source, layout).withRange({0, 255});
        if (rank == 0) after = workIn(blocksOf(), whole);
        again[rank] = cutByWork(v, tf, {}, {});
        const auto volume = std::make_shared<const Volume>(v);
        const WeightFields own = saliencyFields(v, tf);
        measured[rank] =
            featureMeasures(makeEngineOnRanks(ranks, volume, Quality::Normal)->sums(view, {&tf, 1}, &own)[0]);
    });
    for (std::size_t rank = 0; rank < kRanks; ++rank) {
        INFO("rank " << rank);
        CHECK(cut[rank]);
        CHECK_FALSE(again[rank]); // nothing is left to gain
        REQUIRE(measured[rank].size() == expected.size());
        for (std::size_t f = 0; f < expected.size(); ++f) { // what is measured stays the same
            CHECK(measured[rank][f].visibility == Approx(expected[f].visibility).margin(1e-4));
            CHECK(measured[rank][f].vws == Approx(expected[f].vws).margin(1e-4));
        }
    }
    // Equal blocks are cut at x = 64 and z = 32: two have half of the ball each, 0.068 of all voxels (its volume is
    // 4/3 π 26³, less a cap of (1 − h)²(2 + h)/4 with h = 20.5/26), two have nothing. With 0.15 for the others the
    // fullest has (0.068 + 0.182 · 0.15)/(0.136 + 0.864 · 0.15) = 0.36 of the work. Cuts lie at multiples of 8 voxels.
    CHECK(std::ranges::max(before) == Approx(0.36).margin(0.02));
    CHECK(std::ranges::max(after) == Approx(0.25).margin(0.05));
}

TEST_CASE("equal blocks stay where nothing is gained, or memory is short", "[ranks][balance]") {
    const TempFolder folder;
    MemoryUse huge;
    huge.doing = "measuring";
    huge.bytesPerVoxel = huge.leanBytesPerVoxel = 1e13;
    struct Case {
        Vec3 middle;
        double radius;
        MemoryUse then;
    };
    // All is drawn; or the corner, but there is no memory.
    for (const Case& c : {Case{{64, 32, 32}, 500, {}}, Case{{20, 32, 32}, 26, huge}}) {
        const VolumeSource source = written(folder, ballAbout(c.middle, c.radius));
        std::array<RankLayout, kRanks> layouts;
        layouts.fill(small());
        std::array<int, kRanks> cut{};
        onRanks(kRanks, [&](Communicator& ranks) {
            const auto rank = static_cast<std::size_t>(ranks.rank());
            const Volume v = loadOnRanks(ranks, source, layouts[rank]).withRange({0, 255});
            cut[rank] = cutByWork(v, solid(), {}, c.then);
        });
        for (std::size_t rank = 0; rank < kRanks; ++rank) {
            CHECK_FALSE(cut[rank]);
            CHECK_FALSE(layouts[rank].cut.has_value());
        }
    }
}

TEST_CASE("what is cut away is no work", "[ranks][balance]") {
    const Volume v = ballAbout({64, 32, 32}, 500).withRange({0, 255});
    Clipping clipping;
    clipping.hi.x = 0.25;
    const Grid<double> all = sweepWork(v, solid(), {}, kRanks), kept = sweepWork(v, solid(), clipping, kRanks);
    const auto drawn = [](const Grid<double>& work) { return std::ranges::count(work, 1.0); };
    CHECK(drawn(all) == static_cast<std::ptrdiff_t>(all.size()));
    CHECK(static_cast<double>(drawn(kept)) / static_cast<double>(all.size()) == Approx(0.25).margin(0.02));
}
