#include "ranks/piece_exchange.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "ranks/decomposition.h"

namespace pellucid {

namespace {

VoxelRegion common(const VoxelRegion& a, const VoxelRegion& b) { return {max(a.lo, b.lo), min(a.hi, b.hi)}; }

/// Calls body(place, bytes) for the rows of `part`: where in the values of `region` they begin, and how long they are.
template <class Body>
void forRows(const VoxelRegion& region, const VoxelRegion& part, std::size_t bytesEach, const Body& body) {
    const Int3 dims = region.hi - region.lo;
    const auto bytes = static_cast<std::size_t>(part.hi.x - part.lo.x) * bytesEach;
    for (int k = part.lo.z; k < part.hi.z; ++k)
        for (int j = part.lo.y; j < part.hi.y; ++j)
            body(voxelIndex(dims, part.lo.x - region.lo.x, j - region.lo.y, k - region.lo.z) * bytesEach, bytes);
}

} // namespace

std::vector<std::byte> exchangeVoxels(Communicator& ranks, const VoxelRegion& from, std::span<const std::byte> values,
                                      const VoxelRegion& to, std::size_t bytesEach) {
    PELLUCID_CHECK(isEmpty(from) || values.size() == voxelCount(from.hi - from.lo) * bytesEach);
    struct Regions {
        VoxelRegion from, to;
    };
    const std::vector<Regions> all = gatherValues(ranks, Regions{from, to});
    std::vector<RankMessage> out;
    for (int r = 0; r < ranks.size(); ++r) {
        const VoxelRegion part = common(from, all[static_cast<std::size_t>(r)].to);
        if (isEmpty(part)) continue;
        RankMessage& message = out.emplace_back();
        message.rank = r;
        message.bytes.reserve(voxelCount(part.hi - part.lo) * bytesEach);
        forRows(from, part, bytesEach, [&](std::size_t at, std::size_t bytes) {
            const auto row = values.subspan(at, bytes);
            message.bytes.insert(message.bytes.end(), row.begin(), row.end());
        });
    }
    const std::vector<RankMessage> received = ranks.exchange(std::move(out));
    const std::size_t count = isEmpty(to) ? 0 : voxelCount(to.hi - to.lo);
    std::vector<std::byte> result(count * bytesEach);
    std::vector<bool> known(count);
    for (const RankMessage& message : received) {
        const VoxelRegion part = common(all[static_cast<std::size_t>(message.rank)].from, to);
        const std::byte* next = message.bytes.data();
        forRows(to, part, bytesEach, [&](std::size_t at, std::size_t bytes) {
            std::memcpy(result.data() + at, next, bytes);
            next += bytes;
            const auto first = known.begin() + static_cast<std::ptrdiff_t>(at / bytesEach);
            std::fill(first, first + static_cast<std::ptrdiff_t>(bytes / bytesEach), true);
        });
    }
    if (std::ranges::find(known, false) != known.end())
        throw Error("the pieces of the volume leave some of its voxels out", "the volume", "give all of its pieces");
    return result;
}

} // namespace pellucid
