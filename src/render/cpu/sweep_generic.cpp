// The sweep for any processor, and what all instruction sets share.
#include <algorithm>
#include <cmath>
#include <memory>

#include "render/cpu/sweep_kernel.inl"

namespace pellucid {

void* SweepScratch::bytes(Slot slot, std::size_t count) {
    constexpr std::size_t kAlignment = 64;
    auto& v = m_memory[slot];
    if (v.size() < count + kAlignment) v.resize(count + kAlignment);
    void* p = v.data();
    std::size_t space = v.size();
    return std::align(kAlignment, count, p, space);
}

namespace {

/// The rows of rays of a piece: one more is computed twice. Small volumes get more pieces than that asks for, so that
/// no thread waits long for the last one.
constexpr int kFewestRows = 6, kMostRows = 12, kPiecesWanted = 32;
/// Slices nearer to the eye than this share their rays: there are few.
constexpr double kNearest = 8;

constexpr double kNearly = 0.01; ///< voxels that stretches of rays are widened by

/// Where rays of a layer meet the plane w: ray i at base + i·scale.
struct RayAxis {
    double base, scale;
    double indexAt(double x) const { return (x - base) / scale; }
};
RayAxis rowsAt(const SweepInput& in, const SweepLayer& layer, double w) {
    if (in.perspective) return {in.eyeV, layer.slopeStep * (w - in.eyeW)};
    return {in.slopeV * w, in.raySpacing};
}
RayAxis colsAt(const SweepInput& in, const SweepLayer& layer, double w) {
    if (in.perspective) return {in.eyeU, layer.slopeStep * (w - in.eyeW)};
    return {in.slopeU * w, in.raySpacing};
}

RayAxis raysAt(const SweepInput& in, const SweepLayer& layer, int axis, double w) {
    return axis == 0 ? colsAt(in, layer, w) : rowsAt(in, layer, w);
}

/// Where a ray lies along an axis: at start + slope·w.
struct RayLine {
    double start, slope;
};
RayLine lineOf(const SweepInput& in, const SweepLayer& layer, int axis, int ray) {
    const auto at = [&](double w) {
        const RayAxis rays = raysAt(in, layer, axis, w);
        return rays.base + ray * rays.scale;
    };
    const double start = at(0);
    return {start, at(1) - start};
}

/// The first and last voxel along an axis of those of [first, last] that a pyramid leaves of a slice.
void leavePyramid(const SweepInput& in, double eye, double away, double& first, double& last) {
    if (!in.pyramid) return;
    first = std::max(first, eye - away);
    last = std::min(last, eye + away);
    if (first <= last) return;
    first = eye - away; // none on this slice: any may come in between
    last = eye + away;
}

} // namespace

std::vector<SweepLayer> sweepLayers(const SweepInput& in) {
    if (!in.perspective) return {{0, in.nw, 0}};
    std::vector<SweepLayer> layers;
    const int first = std::max(0, static_cast<int>(std::floor(in.eyeW)) + 1);
    for (int end = in.nw; end > first;) {
        const double away = end - 1 - in.eyeW;
        const int begin =
            away <= kNearest ? first : std::max(first, static_cast<int>(std::floor(in.eyeW + away / 2)) + 1);
        layers.push_back({begin, end, in.raySpacing / away});
        end = begin;
    }
    return layers;
}

namespace {

SweepRect raysAroundWindow(const SweepInput& in, const SweepLayer& layer) {
    const int begin = std::max(layer.begin, in.window.lo[2]), end = std::min(layer.end, in.window.hi[2]);
    if (begin >= end || in.window.lo[0] >= in.window.hi[0] || in.window.lo[1] >= in.window.hi[1]) return {};
    double lo[2] = {1e30, 1e30}, hi[2] = {-1e30, -1e30};
    for (const int k : {begin, end - 1}) // monotone in w: the extremes are at the ends
        for (int axis = 0; axis < 2; ++axis) {
            const RayAxis rays = raysAt(in, layer, axis, k);
            double first = in.window.lo[axis], last = in.window.hi[axis] - 1;
            leavePyramid(in, axis == 0 ? in.eyeU : in.eyeV, k - in.eyeW, first, last);
            lo[axis] = std::min(lo[axis], rays.indexAt(first));
            hi[axis] = std::max(hi[axis], rays.indexAt(last));
        }
    const auto floored = [](double v) { return static_cast<int>(std::floor(v)); };
    return {floored(lo[1]), floored(hi[1]) + 2, floored(lo[0]), floored(hi[0]) + 2};
}

SweepRect raysAroundAll(SweepInput in, const SweepLayer& layer) {
    in.window = {{0, 0, 0}, {in.nu, in.nv, in.nw}};
    return raysAroundWindow(in, layer);
}

/// Rays go together in groups along a row: in the same ones as those of the whole volume.
int groupOf(int ray, const SweepRect& all) { return all.firstCol + (ray - all.firstCol) / kBlockSize * kBlockSize; }

} // namespace

SweepRect raysAround(const SweepInput& in, const SweepLayer& layer) {
    SweepRect rect = raysAroundWindow(in, layer);
    if (rect.rays() > 0) rect.firstCol = groupOf(rect.firstCol, raysAroundAll(in, layer));
    return rect;
}

namespace {

struct Interval {
    double lo, hi;
};

/// The slices that rays have of a reach along w, from the front of the box or from the eye on.
Interval slicesOf(const SweepInput& in, const SweepReach& reach) {
    return {std::max(in.perspective && in.eyeW > -0.5 ? in.eyeW : -0.5, reach.lo[2]), reach.hi[2]};
}
/// The same as far as a layer goes.
Interval slicesOf(const SweepInput& in, const SweepLayer& layer, const SweepReach& reach) {
    const Interval slices = slicesOf(in, reach);
    return {slices.lo, std::min<double>(layer.end - 1, slices.hi)};
}

/// Leaves those slices in which a ray is nearly within `sides`; lo > hi: none.
void keepWithin(Interval& slices, const RayLine& ray, const Interval& sides) {
    const double low = sides.lo - kNearly, high = sides.hi + kNearly;
    if (ray.slope == 0) {
        if (ray.start < low || ray.start > high) slices = {1, 0};
        return;
    }
    const double w0 = (low - ray.start) / ray.slope, w1 = (high - ray.start) / ray.slope;
    slices.lo = std::max(slices.lo, std::min(w0, w1));
    slices.hi = std::min(slices.hi, std::max(w0, w1));
}

/// A reach along u or v. Nobody asks for rays that have gone far beyond the volume's sides.
Interval sidesOf(const SweepInput& in, const SweepReach& reach, int axis) {
    return {std::max(reach.lo[axis], -kRayMargin - 1),
            std::min(reach.hi[axis], (axis == 0 ? in.nu : in.nv) + kRayMargin)};
}

/// Where rays lie, as indices along an axis, that are in `reach` anywhere between two planes.
Interval indicesIn(const SweepInput& in, const SweepLayer& layer, const SweepReach& reach, int axis,
                   const Interval& slices) {
    Interval sides = sidesOf(in, reach, axis);
    sides.lo -= kNearly;
    sides.hi += kNearly;
    Interval indices{1e30, -1e30};
    for (const double w : {slices.lo, slices.hi}) {
        const RayAxis rays = raysAt(in, layer, axis, w);
        if (!(rays.scale > 0)) return {-1e30, 1e30}; // at the eye all rays are in one place
        indices.lo = std::min(indices.lo, rays.indexAt(sides.lo));
        indices.hi = std::max(indices.hi, rays.indexAt(sides.hi));
    }
    return indices;
}

/// The rays whose indices are in an interval, of those from `first` to before `end`.
RaySpan raysIn(const Interval& indices, int first, int end) {
    const auto clamped = [&](double v) {
        return static_cast<int>(std::clamp(v, static_cast<double>(first), static_cast<double>(end)));
    };
    return {clamped(std::floor(indices.lo)), clamped(std::floor(indices.hi) + 1)};
}

} // namespace

SweepRect raysThrough(const SweepInput& in, const SweepLayer& layer, const SweepReach& reach) {
    const SweepRect all = raysAroundAll(in, layer);
    const Interval slices = slicesOf(in, layer, reach);
    if (slices.lo > slices.hi) return {};
    const RaySpan cols = raysIn(indicesIn(in, layer, reach, 0, slices), all.firstCol, all.endCol),
                  rows = raysIn(indicesIn(in, layer, reach, 1, slices), all.firstRow, all.endRow);
    return {rows.first, rows.end, groupOf(cols.first, all), cols.end};
}

RaySpan raysThrough(const SweepInput& in, const SweepLayer& layer, const SweepReach& reach, int b,
                    const SweepRect& among) {
    Interval slices = slicesOf(in, layer, reach);
    const Interval sides = sidesOf(in, reach, 1);
    if (sides.lo > sides.hi) return {}; // beside all that is asked for
    keepWithin(slices, lineOf(in, layer, 1, b), sides);
    if (slices.lo > slices.hi) return {};
    const Interval indices = indicesIn(in, layer, reach, 0, slices);
    return raysIn({indices.lo - 1, indices.hi + 1}, among.firstCol, among.endCol);
}

SweepSlopes slopesOf(const SweepInput& in, const SweepLayer& layer, const SweepRect& rect) {
    return {{lineOf(in, layer, 0, rect.firstCol).slope, lineOf(in, layer, 1, rect.firstRow).slope},
            {lineOf(in, layer, 0, rect.endCol - 1).slope, lineOf(in, layer, 1, rect.endRow - 1).slope}};
}

SweepStretch stretchIn(const SweepInput& in, const SweepLayer& layer, int a, int b, const SweepReach& reach) {
    Interval slices = slicesOf(in, reach);
    keepWithin(slices, lineOf(in, layer, 0, a), {reach.lo[0], reach.hi[0]});
    keepWithin(slices, lineOf(in, layer, 1, b), {reach.lo[1], reach.hi[1]});
    return {slices.lo, slices.hi};
}

bool passes(const SweepInput& in, const SweepLayer& layer, int a, int b, const SweepReach& reach) {
    const SweepStretch stretch = stretchIn(in, layer, a, b, reach);
    return stretch.enter <= stretch.leave;
}

std::vector<SweepPiece> sweepPieces(const SweepInput& in, const SweepLayer& layer) {
    const bool carried = in.endDepths != nullptr;
    const SweepRect rays = carried ? in.endRect : raysAround(in, layer);
    std::vector<SweepPiece> pieces;
    if (rays.rays() == 0) return pieces;
    // Voxels lie between rows of rays, the last of which is that of the next piece.
    const int lastRow = carried ? rays.endRow : rays.endRow - 1;
    const int begin = carried ? layer.begin : std::max(layer.begin, in.window.lo[2]),
              end = carried ? layer.end : std::min(layer.end, in.window.hi[2]);
    const int rows = std::clamp((lastRow - rays.firstRow) / kPiecesWanted, kFewestRows, kMostRows);
    for (int b = rays.firstRow; b < lastRow; b += rows)
        pieces.push_back({begin, end, layer.slopeStep, b, std::min(lastRow, b + rows), rays.firstCol, rays.endCol - 1,
                          b == rays.firstRow, b + rows >= lastRow});
    return pieces;
}

std::vector<SweepPiece> sweepPieces(const SweepInput& in) {
    std::vector<SweepPiece> pieces;
    for (const SweepLayer& layer : sweepLayers(in)) {
        const auto more = sweepPieces(in, layer);
        pieces.insert(pieces.end(), more.begin(), more.end());
    }
    return pieces;
}

void sweepGeneric(const SweepInput& in, const SweepPiece& piece, SweepScratch& scratch, double* sums) {
    sweepPiece(in, piece, scratch, sums);
}

std::span<const SweepKernel> sweepKernels() {
    static const std::vector<SweepKernel> kernels = [] {
        std::vector<SweepKernel> all{sweepGeneric};
#ifdef PELLUCID_HAVE_AVX2_SWEEP
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) all.insert(all.begin(), sweepAvx2);
#endif
        return all;
    }();
    return kernels;
}

} // namespace pellucid
