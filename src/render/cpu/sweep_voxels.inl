// From rays to voxels: the optical depth in front of each voxel of a slice. Eight neighbours of a row, a block, are
// measured together; Voxels::measureBlock() has the steps. Implements of docs/method.md, "The cpu engine": the
// interpolation in "Rays are fixed lines through all slices", "The last stretch is the voxel's own line" and "Where the
// light along the four rays differs".
//
// Two kinds of lines meet here: the rays, which lie around voxels, and each voxel's *own line*, which runs from the
// voxel toward the eye. A depth is begun on the rays and ended on the own line, d0/2 in front of the voxel.
#pragma once

#include "render/cpu/sweep_rays.inl"

namespace pellucid {
namespace {

template <SweepMode kMode>
class Accounts; // sweep_accounts.inl: what becomes of the depths

// ==== Slices and blocks of voxels ==========================================================================

/// The voxels of a slice that are visited, u0 … u1 and v0 … v1; none where u1 < u0 or v1 < v0.
struct Extent {
    int u0, u1, v0, v1;
};
/// All of the window, or those of the pyramid: no farther from the eye along u and v than along w.
inline Extent extentOf(const SweepInput& in, int k) {
    Extent e{in.window.lo[0], in.window.hi[0] - 1, in.window.lo[1], in.window.hi[1] - 1};
    if (!in.pyramid) return e;
    const double away = k - in.eyeW;
    const auto cut = [&](double eye, bool ownsTie, int& first, int& last) {
        const int lo = ceilInt(eye - away), hi = floorInt(eye + away);
        first = larger(first, lo == eye - away && !ownsTie ? lo + 1 : lo);
        last = smaller(last, hi == eye + away && !ownsTie ? hi - 1 : hi);
    };
    cut(in.eyeU, in.ownsTieU, e.u0, e.u1);
    cut(in.eyeV, in.ownsTieV, e.v0, e.v1);
    return e;
}

/// A slice of voxels and the rays that have come up to it.
struct Slice {
    int k;          ///< the plane w of the voxels
    int at;         ///< the sample plane that the rays have come to, a slice distance in front or at the start
    LinePlane rays; ///< the rays, were they to go on to the voxels
    Extent extent;
};

/// Eight voxels of a row, u … u + 7, and where they lie among the rays.
struct VoxelBlock {
    int u = 0, v = 0, k = 0;
    std::uint16_t codes[kWide]; ///< of the eight
    std::ptrdiff_t field = 0;   ///< index of the first in weights and field
    int list[kWide];            ///< those that count, 0 … 7 …
    int listed = 0;             ///< … so many

    const float* below; ///< depths of the row of rays below along v, [ray][lanes]
    const float* above; ///< and of the one above
    float fractionV;    ///< of the way from below to above; [0,1), beyond it outside the outermost rows
    Int8 ray;           ///< the ray before each voxel along u, in its row
    Vec8 fraction;      ///< of the way from it to the next, as fractionV
};

/// Depths of the four rays around a voxel, or around each of eight: below or above along v, left or right along u.
struct Corners {
    Vec8 belowLeft, belowRight, aboveLeft, aboveRight;
};

/// The rays around the voxels of a block; what the two lane policies do differently.
template <class Lanes>
class RaysAround;

/// Eight voxels in the lanes: eight neighbouring rays are read at once and interpolated, first along u.
template <>
class RaysAround<LinePerLane> {
public:
    explicit RaysAround(const VoxelBlock& block) : m_fraction(block.fraction), m_fractionV(block.fractionV) {
        pairsAt(block.below, block.ray, m_corners.belowLeft, m_corners.belowRight);
        pairsAt(block.above, block.ray, m_corners.aboveLeft, m_corners.aboveRight);
    }
    const Corners& corners(int /*group*/, int /*part*/) const { return m_corners; }
    Vec8 between(const Corners& c, int /*group*/) const {
        const Vec8 below = c.belowLeft + m_fraction * (c.belowRight - c.belowLeft),
                   above = c.aboveLeft + m_fraction * (c.aboveRight - c.aboveLeft);
        return below + m_fractionV * (above - below);
    }

private:
    Corners m_corners;
    Vec8 m_fraction;
    float m_fractionV;
};

/// A voxel at a time: all lanes of a ray have the same weight.
template <int kCount>
class RaysAround<FunctionPerLane<kCount>> {
public:
    explicit RaysAround(const VoxelBlock& block)
        : m_below(block.below), m_above(block.above),
          m_rays(block.ray), m_weights{(1.0f - block.fraction) * (1.0f - block.fractionV),
                                       block.fraction * (1.0f - block.fractionV),
                                       (1.0f - block.fraction) * block.fractionV, block.fraction * block.fractionV} {}
    Corners corners(int voxel, int part) const {
        const std::ptrdiff_t left = static_cast<std::ptrdiff_t>(m_rays[voxel]) * kCount + part * kWide,
                             right = left + kCount;
        return {load(m_below + left), load(m_below + right), load(m_above + left), load(m_above + right)};
    }
    Vec8 between(const Corners& c, int voxel) const {
        return m_weights.belowLeft[voxel] * c.belowLeft + m_weights.belowRight[voxel] * c.belowRight +
               m_weights.aboveLeft[voxel] * c.aboveLeft + m_weights.aboveRight[voxel] * c.aboveRight;
    }

private:
    const float *m_below, *m_above;
    Int8 m_rays;
    Corners m_weights; ///< [0,1], of the eight voxels
};

// ==== Depths in front of voxels ============================================================================

template <SweepMode kMode, CodeKind kCodes>
class Voxels {
    static constexpr bool kInvalid = kCodes == CodeKind::WideSomeInvalid;
    using Lanes = LanesOf<kMode>;
    static constexpr int kGroups = Lanes::kGroups, kVectors = Lanes::kVectors;
    static constexpr int kLookEvery = 8; ///< stretches of an own line between looks for light
    static constexpr float kDark = 10;   ///< times the depth at which rays are given up: exp(−60) at most

public:
    Voxels(const SweepInput& in, const Lines<kCodes>& lines, SweepScratch& scratch, Accounts<kMode>& accounts)
        : m_in(in), m_lines(lines), m_accounts(accounts), m_scale(depthScaleOf<kMode>(in)),
          m_follows(in.tolerance < 1e30f) {
        const auto planes = static_cast<std::size_t>(in.nw + 2);
        m_near.planes =
            memory<OwnPlane>(scratch, SweepScratch::Near, planes * static_cast<std::size_t>(in.stepsPerSlice));
        m_far.planes = memory<OwnPlane>(scratch, SweepScratch::Far, planes * static_cast<std::size_t>(in.ownSteps));
    }

    /// Measures the voxels (…, v) of a slice that lie among the rays of a strip, at `fractionV` between its two rows.
    /// Blocks are passed over that are transparent, or that no light reaches, in every lane.
    void measureRow(const Slice& slice, int v, const Strip& strip, float fractionV) {
        const SweepSpan& living = strip.living;
        if (living.last < living.first) return;
        const int k = slice.k;
        const Extent& extent = slice.extent;
        const auto opaque = m_lines.opaqueRow(v, k);
        int firstBlock = larger(extent.u0 / kWide, opaque.span.first),
            lastBlock = smaller(extent.u1 / kWide, opaque.span.last);
        // Where rays are exhausted voxels need not be looked at; a ray more, since places are rounded.
        if (living.first > 0)
            firstBlock = larger(firstBlock, floorInt(slice.rays.u(strip.first + living.first * kWide - 2)) / kWide);
        if ((living.last + 1) * kWide < strip.last)
            lastBlock = smaller(lastBlock, floorInt(slice.rays.u(strip.first + (living.last + 1) * kWide + 1)) / kWide);
        if (firstBlock > lastBlock) return;
        VoxelBlock block;
        block.v = v;
        block.k = k;
        block.fractionV = fractionV;
        block.below = strip.below;
        block.above = strip.above;
        const std::ptrdiff_t field = v * m_in.fieldStrides.v + k * m_in.fieldStrides.w;
        const double raysPerVoxel = 1 / slice.rays.scale;
        m_near.ready = m_far.ready = false;
        for (int i = firstBlock; i <= lastBlock; ++i) {
            const unsigned opaqueHere = opaque.blocks[i * m_in.opaqueStrides.u];
            if (opaqueHere == 0) continue;

            // Does light come here, in a lane that could show anything?
            block.u = i * kWide;
            const double a = (block.u - slice.rays.baseU) * raysPerVoxel - strip.first;
            const int firstRay = clampTo(static_cast<int>(a), 0, strip.last - 1),
                      lastRay = clampTo(static_cast<int>(a + raysPerVoxel * (kWide - 1)) + 1, 0, strip.last);
            unsigned lanes = 0;
            for (int r = firstRay / kWide; r <= lastRay / kWide; ++r)
                lanes |= strip.aliveBelow[r] | strip.aliveAbove[r];
            if ((opaqueHere & lanes) == 0) continue;

            // Which voxels count?
            m_lines.codesAt(block.u, v, k, block.codes);
            block.listed = 0;
            const int end = smaller(kWide, extent.u1 + 1 - block.u);
            const unsigned kept = m_lines.clips() || m_lines.isFaint() ? m_lines.keptVoxels(block.u, v, k) : ~0u;
            for (int n = larger(0, extent.u0 - block.u); n < end; ++n) {
                block.list[block.listed] = n;
                block.listed += m_in.featureOfCode[block.codes[n]] != kTransparent && (kept >> n & 1) != 0;
            }
            if (block.listed == 0) continue;
            block.field = field + block.u * m_in.fieldStrides.u;

            // Where do they lie among the rays?
            const Vec8 index = static_cast<float>(a) + kIota * static_cast<float>(raysPerVoxel);
            const Int8 zero = {}, last = zero + (strip.last - 1);
            Int8 ray = toInt(index);
            ray = ray > zero ? ray : zero;
            block.ray = ray < last ? ray : last;
            block.fraction = index - toFloat(block.ray);

            if (!m_near.ready) startNear(v, k, slice.at);
            measureBlock(block);
        }
    }

private:
    /// Calls body(i, n) for each group of a block: for the eight voxels at once, or for the i-th listed voxel, n.
    template <class Body>
    static void forEachGroup(const VoxelBlock& block, const Body& body) {
        if constexpr (kGroups == 1)
            body(0, 0);
        else
            for (int i = 0; i < block.listed; ++i) body(i, block.list[i]);
    }

    /// The steps, whatever the lanes are: the depth that the rays have met, interpolated; the last stretch; where the
    /// rays disagree, the own line all the way instead; and with that into the accounts.
    void measureBlock(const VoxelBlock& block) {
        const RaysAround<Lanes> rays(block);
        const auto page = m_accounts.pageOf(block);

        // Large volumes: the last stretch is a single one, and nothing more is asked. All stays in registers.
        if (!m_follows && m_in.stepsPerSlice == 1) {
            const Stretch last = lastStretch(block);
            forEachGroup(block, [&](int i, int n) {
                Vec8 depth[kVectors];
                for (int part = 0; part < kVectors; ++part)
                    depth[part] =
                        rays.between(rays.corners(n, part), n) + Lanes::absorbed(page.integral, last, n, part);
                m_accounts.add(page, block, i, depth);
            });
            return;
        }

        Vec8 depth[kGroups][kVectors];
        Int8 apart = {}; // lanes in which the rays around any voxel disagree
        forEachGroup(block, [&](int, int n) {
            for (int part = 0; part < kVectors; ++part) {
                const Corners corners = rays.corners(n, part);
                depth[n][part] = rays.between(corners, n);
                if (part == 0 && m_follows) apart |= disagree(corners) & asked(block, n);
            }
        });
        alongOwnLines<false>(block, m_near, 0, [&](const Stretch& s) {
            addTo(depth, block, s);
            return true;
        });
        if (!none(apart)) followAllTheWay(block, apart, depth);
        forEachGroup(block, [&](int i, int n) { m_accounts.add(page, block, i, depth[n]); });
    }

    void addTo(Vec8 (*depth)[kVectors], const VoxelBlock& block, const Stretch& s) const {
        forEachGroup(block, [&](int, int n) {
            for (int part = 0; part < kVectors; ++part)
                depth[n][part] += Lanes::absorbed(m_in.integralTable, s, n, part);
        });
    }

    // ---- Do the rays agree? ----

    /// Where so different amounts of light come along the four rays that nothing between them is known. The
    /// difference of two transmittances is at most exp(−D)·ΔD, D the smaller depth; 1 + D + D²/2 ≤ exp(D).
    Int8 disagree(const Corners& c) const {
        const Vec8 lowBelow = c.belowLeft < c.belowRight ? c.belowLeft : c.belowRight,
                   highBelow = c.belowLeft < c.belowRight ? c.belowRight : c.belowLeft,
                   lowAbove = c.aboveLeft < c.aboveRight ? c.aboveLeft : c.aboveRight,
                   highAbove = c.aboveLeft < c.aboveRight ? c.aboveRight : c.aboveLeft;
        const Vec8 low = (lowBelow < lowAbove ? lowBelow : lowAbove) * m_scale.unit,
                   high = (highBelow > highAbove ? highBelow : highAbove) * m_scale.unit;
        return high - low > m_in.tolerance * (1.0f + low * (1.0f + 0.5f * low));
    }

    /// The lanes of a group whose depth makes a difference: those of listed voxels, or those in which voxel n is
    /// opaque.
    Int8 asked(const VoxelBlock& block, int n) const {
        if constexpr (kMode == SweepMode::Single) {
            Int8 listed = {};
            for (int i = 0; i < block.listed; ++i) listed[block.list[i]] = -1;
            return listed;
        }
        const std::size_t code = block.codes[n];
        if (kMode == SweepMode::Jacobian) return Int8{} - (m_in.alphaTable[code * 2] > 0);
        return load(m_in.alphaTable + code * Lanes::kLanes) > Vec8{};
    }

    /// Replaces depths by those along the own lines from the box, or the eye, on. Candidates do not depend on each
    /// other: only the lanes `apart` are replaced. Voxels of one block go together, and derivatives with their depth.
    void followAllTheWay(const VoxelBlock& block, Int8 apart, Vec8 (*depth)[kVectors]) {
        const Int8 replaced = kMode == SweepMode::Batch ? apart : Int8{} - 1;
        // Light in these lanes keeps the lines going.
        const Int8 counts = kMode == SweepMode::Single ? asked(block, 0) : (m_scale.unit > 0.0f) & replaced;
        Vec8 own[kGroups][kVectors];
        for (auto& group : own)
            for (Vec8& part : group) part = Vec8{};
        OwnLines& lines = farLines(block);
        int stretches = 0;
        alongOwnLines<true>(block, lines, entryOf(block, lines), [&](const Stretch& s) {
            addTo(own, block, s);
            if (++stretches % kLookEvery != 0) return true;
            Int8 light = {};
            forEachGroup(block, [&](int, int n) { light |= own[n][0] < m_scale.limit; });
            if (!none(light & counts)) return true;
            // Given up: a little light in each of many voxels would be much.
            forEachGroup(block, [&](int, int n) { own[n][0] *= kDark; });
            return false;
        });
        forEachGroup(block, [&](int, int n) {
            for (int part = 0; part < kVectors; ++part) depth[n][part] = replaced ? own[n][part] : depth[n][part];
        });
    }

    // ---- The voxels' own lines ----

    /// A sample plane as the own lines of one row of voxels meet it.
    struct OwnPlane {
        double w;
        LinePlane lines;
        typename Lines<kCodes>::Rows rows;
        bool insideV;
        const std::uint8_t* opaque; ///< row of blocks there
    };
    /// Those on the way to the row, the farthest from it first; room for one more.
    struct OwnLines {
        OwnPlane* planes = nullptr;
        int count = 0;
        int begin = 0, end = 0; ///< far: those of [0, count) that have been computed
        bool ready = false;
    };

    OwnPlane ownPlane(double w, const LinePlane& lines, double vThere) const {
        return {w, lines, m_lines.rowsAt(vThere, w), m_lines.insideV(vThere), m_lines.opaqueRow(vThere, w).blocks};
    }
    OwnPlane nearPlane(double w, int v, int k) const {
        const LinePlane lines = m_lines.voxelLines(w, k);
        return ownPlane(w, lines, lines.v(v));
    }
    OwnPlane farPlane(int i, const VoxelBlock& block) const {
        const LinePlane lines = m_lines.voxelLines(farW(i), block.k);
        return ownPlane(farW(i), lines, roundedTwice(block.v, lines.scale, lines.baseV));
    }

    /// Near: the sample planes from where the rays are.
    void startNear(int v, int k, int at) {
        m_near.ready = true;
        m_near.count = 0;
        for (int i = at; i == at || m_lines.sampleW(i) < k; ++i)
            m_near.planes[m_near.count++] = nearPlane(m_lines.sampleW(i), v, k);
    }

    /// Far: ownSteps to a slice distance, from where rays start. Planes are computed when they are asked for: most
    /// lines begin at a side of the box, or end in the dark, long before they have met all slices.
    OwnLines& farLines(const VoxelBlock& block) {
        if (m_far.ready) return m_far;
        m_far.ready = true;
        m_far.count = larger(1, block.k * m_in.ownSteps - farStart());
        m_far.begin = m_far.end = 0;
        return m_far;
    }
    int farStart() const { return floorInt(m_lines.startW() * m_in.ownSteps); }
    double farW(int i) const { return i == 0 ? m_lines.startW() : static_cast<double>(farStart() + i) / m_in.ownSteps; }
    /// Computes the plane i and some behind it. Not inlined: it is rare in a loop that wants the registers.
    __attribute__((noinline)) void computePlanes(OwnLines& own, int i, const VoxelBlock& block) const {
        constexpr int kAhead = 16;
        if (own.begin == own.end) own.begin = own.end = i;
        for (const int end = smaller(own.count, i + kAhead); own.end < end; ++own.end)
            own.planes[own.end] = farPlane(own.end, block);
        while (own.begin > i) {
            --own.begin;
            own.planes[own.begin] = farPlane(own.begin, block);
        }
    }
    /// The last plane before any line of the block enters the box; the first one where they start inside.
    int entryOf(const VoxelBlock& block, const OwnLines& own) const {
        const auto inside = [&](int i) { // from one plane on to the voxels, which are inside
            const LinePlane lines = m_lines.voxelLines(farW(i), block.k);
            return m_lines.insideV(lines.v(block.v)) && lines.u(block.u) <= m_in.nu - 0.5 &&
                   lines.u(block.u + kWide - 1) >= -0.5;
        };
        int outside = -1, in = own.count - 1;
        while (in - outside > 1) {
            const int middle = outside + (in - outside) / 2;
            (inside(middle) ? in : outside) = middle;
        }
        return larger(0, outside);
    }

    /// Of the own lines, d0 per slice.
    Vec8 ownLengths(const VoxelBlock& block) const {
        if (!m_in.perspective) return Vec8{} + static_cast<float>(m_lines.lengthOf(m_in.slopeU, m_in.slopeV));
        const double perSlice = 1 / (block.k - m_in.eyeW), v = (block.v - m_in.eyeV) * perSlice;
        const Vec8 u = static_cast<float>((block.u - m_in.eyeU) * perSlice) + kIota * static_cast<float>(perSlice);
        Vec8 length = u * (static_cast<float>(m_in.guu) * u + static_cast<float>(2 * (m_in.guv * v + m_in.guw))) +
                      static_cast<float>(m_in.gww + v * (m_in.gvv * v + 2 * m_in.gvw));
        for (int n = 0; n < kWide; ++n) length[n] = __builtin_sqrtf(length[n]);
        return length;
    }

    /// With one sample per slice: from the sample plane of the rays to d0/2 in front of the voxels. The intensity goes
    /// linearly to theirs, as it does from slice to slice along rays.
    Stretch lastStretch(const VoxelBlock& block) const {
        const OwnPlane& p = m_near.planes[0];
        const Vec8 length = ownLengths(block), zero = {};
        const float slices = static_cast<float>(block.k - p.w);
        Samples from = m_lines.sample(p.rows, p.lines.u(block.u), p.lines.scale);
        Vec8 path = length * slices - 0.5f;
        path = path > zero ? path : zero;
        const Vec8 part = path / (length * slices); // of the way to the voxels' centres
        const Int8 codes = __builtin_convertvector(load(block.codes), Int8);
        const Vec8 before = toFloat(from.entry);
        Vec8 own = toFloat(codes) * m_in.tableEntryOfCode;
        if (kInvalid) own = codes == kInvalidCode ? before : own; // has no entry, and nobody asks for its light
        const Samples to{toInt(before + part * (own - before) + 0.5f), from.share + part * (1.0f - from.share)};
        if (!p.insideV || !m_lines.insideU(p.lines.u(block.u), p.lines.u(block.u + kWide - 1)))
            path *= m_lines.insideShare(p.lines, m_lines.voxelLines(block.k, block.k), block.u, block.v);
        if (m_lines.isFaint())
            path *= m_lines.thinned(p.lines, m_lines.voxelLines(block.k, block.k), p.w, block.k, block.u, block.v,
                                    part > zero ? part : zero + 1.0f);
        typename Lines<kCodes>::Kept kept;
        // The voxels that count are kept themselves: what is cut away lies before them.
        if (m_lines.clips() && m_lines.clip(p.lines, m_lines.voxelLines(block.k, block.k), p.w, block.k, block.u,
                                            block.v, kept) == Lines<kCodes>::Clipped::Part) {
            const Vec8 enter = kept.enter < part ? kept.enter : part;
            path *= part > zero ? (part - enter) / part : zero;
            from.entry = toInt(before + enter * (own - before) + 0.5f);
        }
        return m_lines.stretch(from, to, path);
    }

    /// Calls body(stretch) for each stretch of the own lines that is not transparent, from the plane `first` on, until
    /// it says false. Stretches end d0/2 in front of each voxel. kFar: planes are computed when they are come to.
    template <bool kFar, class Body>
    void alongOwnLines(const VoxelBlock& block, OwnLines& own, int first, const Body& body) const {
        const auto plane = [&](int i) -> const OwnPlane& {
            if (kFar && i >= own.end) computePlanes(own, i, block);
            return own.planes[i];
        };
        const auto opaqueAt = [&](const OwnPlane& p) {
            return m_lines.opaqueBetween(p.opaque, p.lines.u(block.u), p.lines.u(block.u + kWide - 1)) != 0;
        };
        const auto inside = [&](const OwnPlane& p) {
            return p.insideV && m_lines.insideU(p.lines.u(block.u), p.lines.u(block.u + kWide - 1));
        };
        const auto at = [&](const OwnPlane& p) { return m_lines.sample(p.rows, p.lines.u(block.u), p.lines.scale); };

        // Where each line ends, as w; and where the last of them does.
        const Vec8 length = ownLengths(block), zero = {}, ends = static_cast<float>(block.k) - 0.5f / length;
        double end = static_cast<double>(ends[0]);
        for (int n = 1; n < kWide; ++n) end = static_cast<double>(ends[n]) > end ? static_cast<double>(ends[n]) : end;

        if (kFar) computePlanes(own, first, block);
        Samples before = {};
        bool known = false; // `before` holds the samples at the plane p0
        bool wasOpaque = opaqueAt(plane(first));
        for (int i = first + 1;; ++i) {
            const OwnPlane& p0 = own.planes[i - 1];
            const bool isLast = i >= own.count || plane(i).w >= end;
            const OwnPlane p1 = isLast ? nearPlane(end > p0.w ? end : p0.w, block.v, block.k) : own.planes[i];
            const bool opaque = opaqueAt(p1);
            if (!opaque && !wasOpaque) {
                known = false;
            } else {
                if (!known) before = at(p0);
                const Samples now = at(p1);
                const Vec8 upTo = Vec8{} + static_cast<float>(p1.w),
                           reach = (upTo < ends ? upTo : ends) - static_cast<float>(p0.w);
                Vec8 path = length * (reach > zero ? reach : zero);
                if (!inside(p0) || !inside(p1)) path *= m_lines.insideShare(p0.lines, p1.lines, block.u, block.v);
                Samples from = before, to = now;
                if (m_lines.isFaint()) {
                    const Vec8 part = partOf(reach, p0, p1);
                    path *= m_lines.thinned(p0.lines, p1.lines, p0.w, p1.w, block.u, block.v,
                                            part > zero ? part : zero + 1.0f);
                }
                if (m_lines.clips()) path *= clippedShare(block, p0, p1, reach, from, to);
                if (!body(m_lines.stretch(from, to, path))) return;
                before = now;
                known = true;
            }
            wasOpaque = opaque;
            if (isLast) return;
        }
    }

    /// As part of the way from p0 to p1, `reach` in w.
    static Vec8 partOf(Vec8 reach, const OwnPlane& p0, const OwnPlane& p1) {
        return reach / static_cast<float>(p1.w > p0.w ? p1.w - p0.w : 1);
    }
    /// What clip planes leave of the first `reach` (w) of the own lines between two planes, of which `from` and `to`
    /// are made the ends: [0,1].
    Vec8 clippedShare(const VoxelBlock& block, const OwnPlane& p0, const OwnPlane& p1, Vec8 reach, Samples& from,
                      Samples& to) const {
        const Vec8 zero = {}, one = zero + 1.0f;
        typename Lines<kCodes>::Kept kept;
        switch (m_lines.clip(p0.lines, p1.lines, p0.w, p1.w, block.u, block.v, kept)) {
        case Lines<kCodes>::Clipped::Nothing:
            return one;
        case Lines<kCodes>::Clipped::All:
            return zero;
        case Lines<kCodes>::Clipped::Part:
            break;
        }
        const Vec8 part = partOf(reach, p0, p1);
        kept.leave = kept.leave < part ? kept.leave : part;
        m_lines.narrow(from, to, kept);
        const Vec8 share = (kept.leave - kept.enter) / part;
        return part > zero && share > zero ? (share < one ? share : one) : zero;
    }

    const SweepInput& m_in;
    const Lines<kCodes> m_lines;
    Accounts<kMode>& m_accounts;
    const DepthScale m_scale;
    OwnLines m_near; ///< from where the rays are to the voxels of a row
    OwnLines m_far;  ///< from where rays start
    bool m_follows;  ///< own lines all the way, where rays disagree
};

} // namespace
} // namespace pellucid
