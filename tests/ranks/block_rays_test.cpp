// Which rays a block carries, against each ray followed by itself.
#include <catch2/catch.hpp>

#include <random>
#include <set>
#include <utility>

#include "ranks/block_rays.h"
#include "support/view_cases.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

Geometry box(const Int3& dims) {
    Geometry geometry;
    geometry.dims = dims;
    return geometry;
}

/// The last two from close by.
std::vector<Camera> viewsOf(const Geometry& whole) {
    std::vector<Camera> views = viewCases(whole, 0.6);
    views.push_back(viewCases(whole, 0.3).back());
    return views;
}

/// Between which slices of the layer a ray is in a reach and no farther beside the volume than anybody asks for.
SweepStretch stretchNear(const SweepInput& in, const SweepLayer& layer, int a, int b, SweepReach reach) {
    const int size[2] = {in.nu, in.nv};
    for (int axis = 0; axis < 2; ++axis) {
        reach.lo[axis] = std::max(reach.lo[axis], -kRayMargin);
        reach.hi[axis] = std::min(reach.hi[axis], size[axis] - 1 + kRayMargin);
    }
    reach.hi[2] = std::min<double>(reach.hi[2], layer.end - 1);
    return stretchIn(in, layer, a, b, reach);
}

/// Calls body(input with the rays set, pass, layer) for each layer of a view.
template <class Body>
void forEachLayer(const Geometry& whole, const Camera& view, const Body& body) {
    const Camera camera = sweepCamera(view, whole);
    for (const SweepPass& pass : sweepPasses(camera, whole)) {
        SweepInput in;
        setSweepRays(in, camera, pass, whole, SweepCare::Large);
        for (const SweepLayer& layer : sweepLayers(in)) body(in, pass, layer);
    }
}

} // namespace

TEST_CASE("a row of rays knows which of them pass through a reach", "[ranks][rays]") {
    const Geometry whole = box({90, 70, 80});
    std::mt19937 random(7);
    const auto between = [&](double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); };
    std::size_t passing = 0, spanned = 0;
    for (const Camera& view : viewsOf(whole))
        forEachLayer(whole, view, [&](const SweepInput& in, const SweepPass&, const SweepLayer& layer) {
            const SweepRect all = raysThrough(in, layer, {{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}});
            for (int n = 0; n < 20; ++n) {
                SweepReach reach;
                const int size[3] = {in.nu, in.nv, in.nw};
                for (int a = 0; a < 3; ++a) {
                    reach.lo[a] = between(-3, size[a]);
                    reach.hi[a] = std::min(reach.lo[a] + between(0.5, 40), size[a] + kRayMargin);
                }
                reach.hi[2] = std::min<double>(reach.hi[2], layer.end - 1); // the layer ends there
                for (int b = all.firstRow; b < all.endRow; ++b) {
                    const RaySpan span = raysThrough(in, layer, reach, b, all);
                    spanned += static_cast<std::size_t>(std::max(0, span.end - span.first));
                    for (int a = all.firstCol; a < all.endCol; ++a) {
                        if (!passes(in, layer, a, b, reach)) continue;
                        ++passing;
                        CAPTURE(a, b, n, span.first, span.end);
                        REQUIRE(span.first <= a);
                        REQUIRE(a < span.end);
                    }
                }
            }
        });
    CHECK(passing > 40000);
    // A ray more on either side of each row, and no more.
    CHECK(spanned < passing * 1.3);
}

TEST_CASE("blocks carry the rays that others ask for", "[ranks][rays]") {
    const Geometry whole = box({96, 64, 80});
    const Decomposition blocks(whole.dims, 8);
    std::size_t carried = 0, asked = 0; // groups of rays
    for (const Camera& view : viewsOf(whole)) {
        const std::vector<int> order = sweepOrder(sweepCamera(view, whole), whole, blocks);
        forEachLayer(whole, view, [&](const SweepInput& in, const SweepPass& pass, const SweepLayer& layer) {
            std::vector<BlockRays> of;
            for (int b = 0; b < 8; ++b) of.push_back(blockRays(in, layer, pass, whole.dims, blocks, order, b));
            // What goes on from the last block from the eye, nobody asks for.
            const RayGroups& last = of[static_cast<std::size_t>(order.back())].carried;
            CHECK_FALSE(last.any(last.rect(), RayGroups::kBehind));
            for (std::size_t i = 0; i < order.size(); ++i) {
                const BlockRays& rays = of[static_cast<std::size_t>(order[i])];
                const SweepRect& rect = rays.carried.rect();
                const auto isAskedFor = [&](int a, int b, std::uint8_t what) {
                    return rect.holds(a, b) && rays.carried.any({b, b + 1, a, a + 1}, what);
                };
                std::set<std::pair<int, int>> groups; // that a ray was found to be asked for in
                for (int b = rect.firstRow; b < rect.endRow; ++b)
                    for (int a = rect.firstCol; a < rect.endCol; a += kBlockSize)
                        carried += isAskedFor(a, b, RayGroups::kBehind | RayGroups::kBeside);
                for (int b = rays.all.firstRow; b < rays.all.endRow; ++b)
                    for (int a = rays.all.firstCol; a < rays.all.endCol; ++a) {
                        const auto found = [&](std::uint8_t what) {
                            groups.insert({b, (a - rays.all.firstCol) / kBlockSize});
                            return isAskedFor(a, b, what);
                        };
                        const SweepStretch own = stretchNear(in, layer, a, b, rays.reach);
                        if (own.enter > own.leave) continue;
                        CAPTURE(order[i], a, b);
                        // Whoever is behind and has a stretch of the ray wants to know all that it has met before.
                        for (std::size_t behind = i + 1; behind < order.size(); ++behind) {
                            const SweepReach& theirs = of[static_cast<std::size_t>(order[behind])].reach;
                            const SweepStretch there = stretchNear(in, layer, a, b, theirs);
                            if (there.enter <= there.leave) REQUIRE(found(RayGroups::kBehind));
                        }
                        // A ray is handed over where it enters another's surroundings amid the own stretch.
                        for (std::size_t other = 0; other < order.size(); ++other) {
                            if (other == i) continue;
                            const BlockRays& theirs = of[static_cast<std::size_t>(order[other])];
                            const SweepStretch there = stretchNear(in, layer, a, b, theirs.around);
                            const bool enters = there.enter <= there.leave && there.enter > own.enter + 0.05 &&
                                                there.enter < own.leave - 0.05;
                            if (enters && theirs.wanted.holds(a, b)) REQUIRE(found(RayGroups::kBeside));
                        }
                    }
                asked += groups.size();
            }
        });
    }
    // Not many more: strips along sides are a ray or two wider than they have to be.
    CHECK(asked > 10000);
    CHECK(carried < asked * 1.3);
}
