#include "ranks/sweep_traffic.h"

#include <algorithm>

#include "ranks/depth_exchange.h"
#include "render/cpu/sweep_run.h"

namespace pellucid {

namespace {

std::uint64_t bytesOf(const SweepRect& rays, int lanes) {
    return sizeof(DepthPartHead) + rays.rays() * static_cast<std::uint64_t>(lanes) * sizeof(float);
}

/// Whether a ray of `part` enters `around` on its way through `own`. Rays go from a block to those behind it; the
/// surroundings of one before it they can only enter around an edge.
bool isEntered(const SweepInput& in, const SweepLayer& layer, const SweepRect& part, const SweepReach& around,
               const SweepReach& own, bool isBehind) {
    constexpr double kWithin = 0.05; // slices; more than stretches are widened by
    for (int b = part.firstRow; b < part.endRow; ++b)
        for (int a = part.firstCol; a < part.endCol; ++a) {
            const SweepStretch there = stretchIn(in, layer, a, b, around);
            if (there.enter > there.leave) continue;
            if (isBehind) return true;
            const SweepStretch here = stretchIn(in, layer, a, b, own);
            if (there.enter > here.enter + kWithin && there.enter < here.leave - kWithin) return true;
        }
    return false;
}

} // namespace

Traffic expectedTraffic(const Geometry& whole, const Decomposition& blocks, const Camera& view, int lanes) {
    const Camera camera = sweepCamera(view, whole);
    const int count = static_cast<int>(blocks.blocks().size());
    const std::vector<int> order = sweepOrder(camera, whole, blocks);
    std::vector<int> placeOf(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) placeOf[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
    std::vector<std::uint64_t> sent(order.size(), 0);
    Traffic traffic;
    for (const SweepPass& pass : sweepPasses(camera, whole)) {
        SweepInput in;
        setSweepRays(in, camera, pass, whole, SweepCare::Large);
        for (const SweepLayer& layer : sweepLayers(in)) {
            for (int own = 0; own < count; ++own) {
                const auto from = static_cast<std::size_t>(own);
                const BlockRays rays = blockRays(in, layer, pass, whole.dims, blocks, order, own);
                const DepthTiles tiles(rays.all, count);
                if (own == 0 && tiles.count() > 0)
                    traffic.rounds += 2 * static_cast<std::uint64_t>((tiles.count() + tiles.perRound(lanes) - 1) /
                                                                     tiles.perRound(lanes));
                for (int tile = 0; tile < tiles.count(); ++tile) {
                    const int to = tiles.rankOf(tile);
                    const SweepRect through = common(tiles.at(tile), rays.carried.rect());
                    if (to != own && through.rays() > 0 && rays.carried.any(through, RayGroups::kBehind))
                        sent[from] += bytesOf(through, lanes);
                    for (const BlockEntry& entry : rays.entries) {
                        const SweepRect part = common(tiles.at(tile), entry.rays);
                        const bool isBehind = placeOf[static_cast<std::size_t>(entry.block)] > placeOf[from];
                        if (part.rays() == 0 || !isEntered(in, layer, part, entry.around, rays.reach, isBehind))
                            continue;
                        if (to != own) sent[from] += bytesOf(part, lanes);
                        if (to != entry.block) sent[static_cast<std::size_t>(to)] += bytesOf(part, lanes);
                    }
                }
            }
        }
    }
    traffic.bytes = std::ranges::max(sent);
    return traffic;
}

} // namespace pellucid
