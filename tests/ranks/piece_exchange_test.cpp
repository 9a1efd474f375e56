// Voxels that other pieces hold come to where they are wanted.
#include <catch2/catch.hpp>

#include <array>
#include <cstring>
#include <numeric>

#include "ranks/decomposition.h"
#include "ranks/piece_exchange.h"
#include "ranks/piece_volume.h"
#include "support/thread_ranks.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

constexpr Int3 kDims(20, 24, 33);

/// What a voxel of the volume holds: its place.
std::uint32_t valueAt(int i, int j, int k) { return static_cast<std::uint32_t>(voxelIndex(kDims, i, j, k)); }

std::vector<std::byte> valuesOf(const VoxelRegion& region) {
    std::vector<std::byte> bytes;
    for (int k = region.lo.z; k < region.hi.z; ++k)
        for (int j = region.lo.y; j < region.hi.y; ++j)
            for (int i = region.lo.x; i < region.hi.x; ++i) appendBytes(bytes, valueAt(i, j, k));
    return bytes;
}

} // namespace

TEST_CASE("pieces along z that share their last planes become blocks with what lies around them, and go back",
          "[ranks]") {
    constexpr int kRanks = 4;
    const Decomposition blocks(kDims, kRanks);
    // Planes 0 to 10, 10 to 20, …: as programs cut that keep points, so that neighbours share a plane. The last rank
    // has nothing.
    const std::array<VoxelRegion, kRanks> pieces{
        {{{0, 0, 0}, {20, 24, 11}}, {{0, 0, 10}, {20, 24, 21}}, {{0, 0, 20}, {20, 24, 33}}, {{0, 0, 0}, {0, 0, 0}}}};
    std::array<bool, kRanks> came{}, went{}; // one per rank, each written by its own
    onRanks(kRanks, [&](Communicator& ranks) {
        const auto rank = static_cast<std::size_t>(ranks.rank());
        const VoxelRegion &piece = pieces[rank], block = widened(blocks.blocks()[rank], Int3(4), kDims);
        const auto here = exchangeVoxels(ranks, piece, valuesOf(piece), block, sizeof(std::uint32_t));
        came[rank] = here == valuesOf(block);
        const VoxelRegion& own = blocks.blocks()[rank];
        const auto back = exchangeVoxels(ranks, own, valuesOf(own), piece, sizeof(std::uint32_t));
        went[rank] = back == valuesOf(piece);
    });
    for (std::size_t rank = 0; rank < kRanks; ++rank) {
        INFO("rank " << rank);
        CHECK(came[rank]);
        CHECK(went[rank]);
    }
}

TEST_CASE("voxels that no piece holds are missed", "[ranks]") {
    const VoxelRegion half{{0, 0, 0}, {20, 24, 16}}, all{{0, 0, 0}, kDims};
    const auto wanting = [&](const VoxelRegion& wanted) {
        onRanks(2, [&](Communicator& ranks) {
            exchangeVoxels(ranks, half, valuesOf(half), ranks.rank() == 1 ? wanted : half, sizeof(std::uint32_t));
        });
    };
    CHECK_NOTHROW(wanting(half));
    CHECK_THROWS_AS(wanting(all), Error);
}

TEST_CASE("a volume in pieces of another program is the volume, in blocks or as a whole", "[ranks]") {
    constexpr int kRanks = 3;
    Geometry whole;
    whole.dims = kDims;
    whole.spacing = {1, 2, 0.5};
    whole.origin = {5, -3, 7};
    const std::array<VoxelRegion, kRanks> pieces{
        {{{0, 0, 0}, {20, 13, 33}}, {{0, 12, 0}, {20, 24, 17}}, {{0, 12, 16}, {20, 24, 33}}}};
    for (const std::size_t smallest : {std::size_t{1}, std::size_t{1} << 20}) {
        INFO("blocks from " << smallest << " voxels on");
        std::array<bool, kRanks> inBlocks{}, sameValues{}, samePlaces{}, fieldCame{};
        onRanks(kRanks, [&](Communicator& ranks) {
            const auto rank = static_cast<std::size_t>(ranks.rank());
            const std::vector<std::byte> samples = valuesOf(pieces[rank]);
            const auto volume =
                volumeOfPieces(ranks, {whole, SampleType::U32, pieces[rank], samples}, 4, {.smallest = smallest});
            inBlocks[rank] = volume->elsewhere() != nullptr;
            const auto* elsewhere = volume->elsewhere();
            const VoxelRegion stored = elsewhere ? elsewhere->stored() : VoxelRegion{{0, 0, 0}, kDims},
                              own = elsewhere ? elsewhere->own() : stored;
            const Volume& here = elsewhere ? *volume->here() : *volume;
            const Int3 dims = stored.hi - stored.lo;
            Grid<float> field(dims); // of what is another rank's nothing is known
            bool values = here.dims() == dims;
            for (int k = stored.lo.z; k < stored.hi.z; ++k)
                for (int j = stored.lo.y; j < stored.hi.y; ++j)
                    for (int i = stored.lo.x; i < stored.hi.x; ++i) {
                        const std::size_t at = voxelIndex(dims, i - stored.lo.x, j - stored.lo.y, k - stored.lo.z);
                        values &= here.value(at) == valueAt(i, j, k);
                        const bool mine = i >= own.lo.x && i < own.hi.x && j >= own.lo.y && j < own.hi.y &&
                                          k >= own.lo.z && k < own.hi.z;
                        field[at] = mine ? static_cast<float>(valueAt(i, j, k)) : -1.0f;
                    }
            sameValues[rank] = values;
            samePlaces[rank] = here.geometry().origin == whole.worldFromVoxel(Vec3(stored.lo)) &&
                               volume->geometry().origin == whole.origin && volume->dims() == kDims &&
                               volume->dataRange() == ValueRange{0, static_cast<double>(voxelCount(kDims) - 1)};
            const std::vector<float> back = valuesOnPiece(ranks, *volume, field, pieces[rank]);
            std::vector<float> expected;
            ByteReader reader(samples);
            while (!reader.atEnd()) expected.push_back(static_cast<float>(reader.take<std::uint32_t>()));
            fieldCame[rank] = back == expected;
        });
        for (std::size_t rank = 0; rank < kRanks; ++rank) {
            INFO("rank " << rank);
            CHECK(inBlocks[rank] == (smallest == 1));
            CHECK(sameValues[rank]);
            CHECK(samePlaces[rank]);
            CHECK(fieldCame[rank]);
        }
    }
}
