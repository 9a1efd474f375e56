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

/// Rays that are asked for, of those that pass through the block's own reach.
struct Asked {
    SweepReach where; ///< those that pass through this, too, …
    SweepRect among;  ///< … and are in this
    int entry = -1;   ///< where they enter this one of BlockRays::entries; −1: on their whole way
};

RaySpan common(const RaySpan& a, const RaySpan& b) { return {std::max(a.first, b.first), std::min(a.end, b.end)}; }

/// Where rays are on the first sample plane inside `around`: at most one slice's way behind a side that they cross
/// inwards. Planes are at most a slice apart.
std::vector<SweepReach> entrances(const SweepReach& around, const SweepSlopes& slopes) {
    std::vector<SweepReach> all{around};
    all[0].hi[2] = std::min(around.hi[2], around.lo[2] + 1);
    for (int axis = 0; axis < 2; ++axis) {
        if (slopes.hi[axis] > 0) {
            all.push_back(around);
            all.back().hi[axis] = std::min(around.hi[axis], around.lo[axis] + slopes.hi[axis]);
        }
        if (slopes.lo[axis] < 0) {
            all.push_back(around);
            all.back().lo[axis] = std::max(around.lo[axis], around.hi[axis] + slopes.lo[axis]);
        }
    }
    return all;
}

/// Takes rays in.
void widen(SweepRect& rect, int row, const RaySpan& rays) {
    if (rays.first >= rays.end) return;
    if (rect.rays() == 0) {
        rect = {row, row + 1, rays.first, rays.end};
        return;
    }
    rect = {std::min(rect.firstRow, row), std::max(rect.endRow, row + 1), std::min(rect.firstCol, rays.first),
            std::max(rect.endCol, rays.end)};
}

} // namespace

RayGroups::RayGroups(const SweepRect& rect) : m_rect(rect) {
    if (rect.rays() == 0) return;
    m_perRow = static_cast<std::size_t>((rect.endCol - rect.firstCol + kBlockSize - 1) / kBlockSize);
    m_askedFor.resize(m_perRow * static_cast<std::size_t>(rect.endRow - rect.firstRow), 0);
}

RayGroups::Groups RayGroups::groups(int row, const RaySpan& rays) const {
    if (rays.first >= rays.end) return {};
    const auto groupOf = [&](int ray) { return static_cast<std::size_t>((ray - m_rect.firstCol) / kBlockSize); };
    const std::size_t begin = static_cast<std::size_t>(row - m_rect.firstRow) * m_perRow;
    return {begin + groupOf(rays.first), begin + groupOf(rays.end - 1) + 1};
}

void RayGroups::add(int row, const RaySpan& rays, std::uint8_t askedFor) {
    const Groups among = groups(row, rays);
    for (std::size_t i = among.first; i < among.end; ++i) m_askedFor[i] |= askedFor;
}

bool RayGroups::any(const SweepRect& part, std::uint8_t askedFor) const {
    for (int row = part.firstRow; row < part.endRow; ++row) {
        const Groups among = groups(row, {part.firstCol, part.endCol});
        for (std::size_t i = among.first; i < among.end; ++i)
            if ((m_askedFor[i] & askedFor) != 0) return true;
    }
    return false;
}

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
    if (inside.rays() == 0) return rays;
    const SweepSlopes slopes = slopesOf(pass, layer, inside);
    std::vector<Asked> asked;
    bool isBehind = false;
    for (const int b : order) {
        isBehind = isBehind || b == own;
        const VoxelRegion& other = blocks.blocks()[static_cast<std::size_t>(b)];
        if (b == own || isEmpty(other)) continue;
        const SweepBox box = boxOf(other, axes, dims);
        const SweepReach theirs = ownReach(box, whole);
        // What a ray has met here is asked for by those who hand it over later: blocks behind this one that it reaches.
        const SweepRect onTheirWay = isBehind ? common(inside, raysThrough(pass, layer, theirs)) : SweepRect{};
        if (onTheirWay.rays() > 0) asked.push_back({theirs, onTheirWay});
        if (const auto left = common(rays.around, theirs)) {
            const SweepRect entering = common(raysThrough(pass, layer, *left), rays.wanted);
            if (entering.rays() > 0) rays.entering.push_back(entering);
        }
        const SweepReach around = reachAround(box);
        const auto entry = static_cast<int>(rays.entries.size());
        const SweepRect wanted = common(inside, raysAroundBox(box));
        if (wanted.rays() == 0) continue;
        for (const SweepReach& entrance : entrances(around, slopes))
            if (const auto here = common(entrance, rays.reach)) asked.push_back({*here, wanted, entry});
        if (!asked.empty() && asked.back().entry == entry) rays.entries.push_back({b, around, {}});
    }
    // What is asked for of each row, one after the other.
    std::vector<RaySpan> spans;
    SweepRect carried;
    for (int row = inside.firstRow; row < inside.endRow; ++row) {
        const RaySpan here = raysThrough(pass, layer, rays.reach, row, inside);
        for (const Asked& one : asked) {
            RaySpan& span = spans.emplace_back();
            if (row < one.among.firstRow || row >= one.among.endRow) continue;
            span = common(here, raysThrough(pass, layer, one.where, row, one.among));
            widen(carried, row, span);
            if (one.entry >= 0) widen(rays.entries[static_cast<std::size_t>(one.entry)].rays, row, span);
        }
    }
    std::erase_if(rays.entries, [](const BlockEntry& entry) { return entry.rays.rays() == 0; });
    if (carried.rays() > 0)
        carried.firstCol -= (carried.firstCol - inside.firstCol) % kBlockSize; // in the same groups as everywhere
    rays.carried = RayGroups(carried);
    auto span = spans.begin();
    for (int row = inside.firstRow; row < inside.endRow; ++row)
        for (const Asked& one : asked)
            rays.carried.add(row, *span++, one.entry < 0 ? RayGroups::kBehind : RayGroups::kBeside);
    return rays;
}

} // namespace pellucid
