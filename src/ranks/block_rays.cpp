#include "ranks/block_rays.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace pellucid {

namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

/// A region in the coordinates of a pass.
SweepBox boxOf(const VoxelRegion& region, const SweepPass& pass, const Int3& dims) {
    const Int3 lo = pass.permuted(region.lo), hi = pass.permuted(region.hi);
    SweepBox box{{lo.x, lo.y, lo.z}, {hi.x, hi.y, hi.z}};
    if (!pass.flipped) return box;
    const int nw = dims[pass.w];
    box.lo[2] = nw - hi.z;
    box.hi[2] = nw - lo.z;
    return box;
}

SweepReach ownReach(const SweepBox& box, const Int3& whole) {
    SweepReach reach;
    for (int a = 0; a < 3; ++a) {
        reach.lo[a] = box.lo[a] == 0 ? -kEverywhere : box.lo[a] - 0.5;
        reach.hi[a] = box.hi[a] == whole[a] ? kEverywhere : box.hi[a] - 0.5;
    }
    return reach;
}

/// Where rays go on their last way to the voxels of a block: as far as those around its voxels lie off, up to the slice
/// in front of the last one.
SweepReach reachAround(const SweepBox& box) {
    SweepReach reach;
    for (int a = 0; a < 2; ++a) {
        reach.lo[a] = box.lo[a] - kRayMargin;
        reach.hi[a] = box.hi[a] - 1 + kRayMargin;
    }
    reach.lo[2] = box.lo[2] - 1;
    reach.hi[2] = box.hi[2] - 1;
    reach.fromInside = true;
    return reach;
}

/// What both have; nothing where they do not meet.
std::optional<SweepReach> common(const SweepReach& a, const SweepReach& b) {
    SweepReach both;
    for (int axis = 0; axis < 3; ++axis) {
        both.lo[axis] = std::max(a.lo[axis], b.lo[axis]);
        both.hi[axis] = std::min(a.hi[axis], b.hi[axis]);
        if (!(both.lo[axis] < both.hi[axis])) return {};
    }
    return both;
}

/// The smallest rectangle around both.
SweepRect spanning(const SweepRect& a, const SweepRect& b) {
    if (a.rays() == 0) return b;
    if (b.rays() == 0) return a;
    return {std::min(a.firstRow, b.firstRow), std::max(a.endRow, b.endRow), std::min(a.firstCol, b.firstCol),
            std::max(a.endCol, b.endCol)};
}

} // namespace

SweepRect common(const SweepRect& a, const SweepRect& b) {
    return {std::max(a.firstRow, b.firstRow), std::min(a.endRow, b.endRow), std::max(a.firstCol, b.firstCol),
            std::min(a.endCol, b.endCol)};
}

std::vector<int> sweepOrder(const Camera& camera, const Geometry& whole, const Decomposition& blocks) {
    return camera.projection == Projection::Perspective ? blocks.orderFrom(sweepEye(camera, whole))
                                                        : blocks.orderAlong(whole.indexFromWorld() * camera.forward());
}

BlockRays blockRays(const SweepInput& pass, const SweepLayer& layer, const SweepPass& axes, const Int3& dims,
                    const Decomposition& blocks, const std::vector<int>& order, int own) {
    const Int3 whole = axes.permuted(dims);
    const auto raysAroundBox = [&](const SweepBox& box) {
        SweepInput in = pass;
        in.window = box;
        return raysAround(in, layer);
    };
    const VoxelRegion& region = blocks.blocks()[static_cast<std::size_t>(own)];
    BlockRays rays;
    rays.box = boxOf(region, axes, dims);
    rays.reach = ownReach(rays.box, whole);
    rays.around = reachAround(rays.box);
    rays.all = raysAroundBox({{0, 0, 0}, {whole.x, whole.y, whole.z}});
    rays.wanted = raysAroundBox(rays.box);
    if (isEmpty(region)) return rays;
    const SweepRect inside = raysThrough(pass, layer, rays.reach);
    bool isBehind = false;
    for (const int b : order) {
        isBehind = isBehind || b == own;
        const VoxelRegion& other = blocks.blocks()[static_cast<std::size_t>(b)];
        if (b == own || isEmpty(other)) continue;
        const SweepBox box = boxOf(other, axes, dims);
        const SweepReach theirs = ownReach(box, whole);
        // What a ray has met here is asked for by those who hand it over later: blocks behind this one that it reaches.
        if (isBehind) rays.through = spanning(rays.through, common(inside, raysThrough(pass, layer, theirs)));
        if (const auto left = common(rays.around, theirs)) {
            const SweepRect entering = common(raysThrough(pass, layer, *left), rays.wanted);
            if (entering.rays() > 0) rays.entering.push_back(entering);
        }
        const SweepReach around = reachAround(box);
        const auto entered = common(around, rays.reach);
        if (!entered) continue;
        const SweepRect entering = common(raysThrough(pass, layer, *entered), raysAroundBox(box));
        if (entering.rays() == 0) continue;
        rays.entries.push_back({b, around, entering});
        rays.through = spanning(rays.through, common(inside, entering));
    }
    return rays;
}

} // namespace pellucid
