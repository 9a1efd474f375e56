// Blocks of the volume and how far off the next one is that may be seen.
#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

#include <glm/common.hpp>

#include "render/cpu/ray_packets.h"
#include "render/ray_blocks.h"
#include "support/volumes.h"
#include "volume/intensity_grid.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("blocks know how far off the next opaque one is, over faces, edges and corners", "[render]") {
    // One voxel of value 1 among zeros is in one, two, four or eight blocks; all pairs of blocks are compared.
    std::mt19937 random(11);
    for (const Int3 dims : {Int3(83, 21, 9), Int3(9, 90, 14), Int3(6, 5, 97), Int3(2, 2, 2)}) {
        std::vector<double> values(voxelCount(dims), 0);
        std::uniform_int_distribution<std::size_t> anywhere(0, values.size() - 1);
        for (int n = 0; n < 3; ++n) values[anywhere(random)] = 1;
        const auto volume =
            volumeFrom(geometryOf(dims), [&](int i, int j, int k) { return values[voxelIndex(dims, i, j, k)]; });
        const RayBlocks blocks(makeIntensityGrid(*volume));
        const auto isOpaque = [](int, int high) { return high > 1000; };
        const std::vector<std::uint8_t> distances = blocks.distances(isOpaque);
        const Int3 n = blocks.dims();
        const auto at = [&](const Int3& b) { return voxelIndex(n, b.x, b.y, b.z); };
        std::vector<Int3> all;
        for (int z = 0; z < n.z; ++z)
            for (int y = 0; y < n.y; ++y)
                for (int x = 0; x < n.x; ++x) all.emplace_back(x, y, z);
        std::size_t wrong = 0, opaque = 0;
        for (const Int3& from : all) {
            int nearest = kMostBlockDistance;
            for (const Int3& to : all) {
                if (static_cast<std::uint32_t>(blocks.ranges()[at(to)]) >> 16 <= 1000) continue;
                const Int3 way = glm::abs(to - from);
                nearest = std::min(nearest, std::max({way.x, way.y, way.z}));
            }
            wrong += distances[at(from)] != nearest;
            opaque += nearest == 0;
        }
        INFO(dims.x << " x " << dims.y << " x " << dims.z);
        CHECK(wrong == 0);
        CHECK(opaque > 0);
    }
}
