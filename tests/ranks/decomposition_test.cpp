#include <catch2/catch.hpp>

#include "ranks/decomposition.h"
#include "support/random_cases.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

bool contains(const VoxelRegion& r, const Int3& v) {
    return v.x >= r.lo.x && v.y >= r.lo.y && v.z >= r.lo.z && v.x < r.hi.x && v.y < r.hi.y && v.z < r.hi.z;
}

/// The blocks that hold a voxel: one, if all is well.
std::vector<std::size_t> blocksWith(const Decomposition& blocks, const Int3& voxel) {
    std::vector<std::size_t> found;
    for (std::size_t b = 0; b < blocks.blocks().size(); ++b)
        if (contains(blocks.blocks()[b], voxel)) found.push_back(b);
    return found;
}

} // namespace

TEST_CASE("each voxel lies in one block", "[decomposition]") {
    Random random(1);
    for (int n = 0; n < 30; ++n) {
        const Int3 dims(1 + random.below(90), 1 + random.below(90), 1 + random.below(90));
        const int count = 1 + random.below(17);
        Grid<double> work(Int3(5, 4, 3));
        for (double& w : work) w = random.chance(0.3) ? 0 : random.unit();
        const Decomposition blocks(dims, count, n % 2 == 0 ? &work : nullptr);
        REQUIRE(blocks.blocks().size() == static_cast<std::size_t>(count));
        std::size_t all = 0;
        for (const VoxelRegion& block : blocks.blocks())
            if (!isEmpty(block)) all += voxelCount(block.hi - block.lo);
        CHECK(all == voxelCount(dims));
        for (int i = 0; i < 50; ++i) {
            const Int3 voxel(random.below(dims.x), random.below(dims.y), random.below(dims.z));
            CHECK(blocksWith(blocks, voxel).size() == 1);
        }
    }
}

TEST_CASE("cuts lie at multiples of 8 and share the work", "[decomposition]") {
    // Without work: halves. 64 voxels in 4 blocks along the longest axis first.
    const Decomposition even({64, 16, 16}, 4);
    CHECK(even.blocks()[0].hi.x == 16);
    CHECK(even.blocks()[2].lo.x == 32);
    // Three blocks: a third and two thirds, 63 → 21 and 42, at 24 (the nearest multiple of 8).
    CHECK(Decomposition({63, 8, 8}, 3).blocks()[0].hi.x == 24);
    // All work in the last eighth of x: half of it lies at 120.
    Grid<double> work(Int3(8, 1, 1), 0.0);
    work.at(7, 0, 0) = 1;
    CHECK(Decomposition({128, 8, 8}, 2, &work).blocks()[0].hi.x == 120);
}

TEST_CASE("no block hides one that stands before it in the order", "[decomposition]") {
    // A ray that leaves a block for another one goes on in the order: stepped through in small steps.
    Random random(2);
    for (int n = 0; n < 40; ++n) {
        const Int3 dims(20 + random.below(60), 20 + random.below(60), 20 + random.below(60));
        const Decomposition blocks(dims, 2 + random.below(12));
        const bool parallel = random.chance(0.5);
        const Vec3 inside(random.between(0, dims.x), random.between(0, dims.y), random.between(0, dims.z));
        const Vec3 eye = inside + 200.0 * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)),
                   direction = inside - eye;
        const auto order = parallel ? blocks.orderAlong(direction) : blocks.orderFrom(eye);
        std::vector<int> place(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
        int last = -1;
        for (double t = 0; t < 3; t += 0.001) {
            const Vec3 at = eye + t * direction;
            const Int3 voxel(static_cast<int>(std::floor(at.x + 0.5)), static_cast<int>(std::floor(at.y + 0.5)),
                             static_cast<int>(std::floor(at.z + 0.5)));
            if (!contains({Int3(0), dims}, voxel)) continue;
            const int now = place[blocksWith(blocks, voxel).at(0)];
            CHECK(now >= last);
            last = now;
        }
    }
}
