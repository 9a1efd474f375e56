// Lines through the volume and the optical depth along them, in three parts: how the depths of eight lines lie in
// vectors (the two lane policies), what lines meet in the volume (Lines), and the grid of rays that carries depths from
// slice to slice (Rays). Implements of docs/method.md, "The cpu engine": "Rays are fixed lines through all slices",
// "Segments are exact for a linear intensity" and, of rays, "What cannot be seen is left out".
//
// Coordinates are those of sweep.h: voxels, w across the slices and growing away from the eye. Depths are sums of
// differences of SweepInput::integralTable, in its units; times depthUnit they are optical depths ∫τ.
#pragma once

#include "render/cpu/sweep_vectors.inl"

namespace pellucid {
namespace {

// ==== How depths lie in vectors ============================================================================

/// What eight lines absorb between two samples of each: weight · (table[high] − table[low]).
struct Stretch {
    Int8 low, high; ///< rows of the integral table, low < high
    Vec8 weight;    ///< length in d0, per row between the two
};

// A lane policy says what the lanes of a vector are. Of eight neighbouring lines those that share a vector form a
// *group*. All that is done with depths is written once, as "for each group, for each of its vectors".

/// One transfer function: the eight lines are the lanes.
struct LinePerLane {
    static constexpr int kLanes = 1;   ///< depths of one line
    static constexpr int kGroups = 1;  ///< of eight lines
    static constexpr int kVectors = 1; ///< of a group
    static Vec8 absorbed(const std::int32_t* table, const Stretch& s, int /*group*/, int /*part*/) {
        return s.weight * toFloat(gathered(table, s.high) - gathered(table, s.low));
    }
};

/// kCount transfer functions, or a depth and its derivatives: these are the lanes, and each line is a group.
template <int kCount>
struct FunctionPerLane {
    static constexpr int kLanes = kCount;
    static constexpr int kGroups = kWide;
    static constexpr int kVectors = kCount / kWide;
    static Vec8 absorbed(const std::int32_t* table, const Stretch& s, int line, int part) {
        table += part * kWide;
        return s.weight[line] * toFloat(load(table + static_cast<std::ptrdiff_t>(s.high[line]) * kCount) -
                                        load(table + static_cast<std::ptrdiff_t>(s.low[line]) * kCount));
    }
};

template <SweepMode kMode>
struct LanePolicy {
    using Type = FunctionPerLane<lanesOf(kMode)>;
};
template <>
struct LanePolicy<SweepMode::Single> {
    using Type = LinePerLane;
};
template <SweepMode kMode>
using LanesOf = typename LanePolicy<kMode>::Type;

/// What the depths in the first vector of a group stand for.
struct DepthScale {
    Vec8 unit;  ///< optical depth of one unit of the integral table; 0 in lanes that hold derivatives
    Vec8 limit; ///< a lane at this depth, in units of the table, is exhausted: what lies behind is not seen
};
template <SweepMode kMode>
DepthScale depthScaleOf(const SweepInput& in) {
    DepthScale scale;
    for (int lane = 0; lane < kWide; ++lane) {
        const float unit = in.depthUnit[kMode == SweepMode::Single ? 0 : lane];
        scale.unit[lane] = kMode == SweepMode::Jacobian && lane > 0 ? 0.0f : unit;
        scale.limit[lane] = in.exhaustedDepth / unit;
    }
    return scale;
}

// ==== What lines meet ======================================================================================

/// Where lines meet a plane w, in voxels: line (a, b) at u = baseU + a·scale, v = baseV + b·scale. The lines are rays,
/// (a, b) their place in the grid of rays; or the lines of the voxels (a, b) of one slice.
struct LinePlane {
    double baseU, baseV, scale;
    double u(double a) const { return roundedOnce(a, scale, baseU); }
    double v(double b) const { return roundedOnce(b, scale, baseV); }
};

/// The intensities at which eight lines meet a plane.
struct Samples {
    Int8 entry; ///< nearest entry of the integral table
    Vec8 share; ///< [0,1], of valid corners among those interpolated; set where voxels may be invalid
};

/// What the volume's codes are.
enum class CodeKind {
    Wide,            ///< 16 bits
    WideSomeInvalid, ///< likewise, kInvalidCode where invalid
    Narrow           ///< 8 bits; neighbours along u may lie apart
};
template <CodeKind kCodes>
struct CodeOf {
    using Type = std::uint16_t;
    static const Type* first(const SweepInput& in) { return in.codes; }
};
template <>
struct CodeOf<CodeKind::Narrow> {
    using Type = std::uint8_t;
    static const Type* first(const SweepInput& in) { return in.narrowCodes; }
};

/// Sampling of the volume along lines. A small value: all who sample have their own.
template <CodeKind kCodes>
class Lines {
    static constexpr bool kInvalid = kCodes == CodeKind::WideSomeInvalid; ///< some voxels may be invalid
    using Code = typename CodeOf<kCodes>::Type;
    static constexpr float kNoShare = 1e-6f; ///< of valid corners: nothing there has an intensity

public:
    explicit Lines(const SweepInput& in)
        : m_in(in), m_startW(in.perspective && in.eyeW > -0.5 ? in.eyeW : -0.5),
          m_start(floorInt(m_startW * in.stepsPerSlice)) {}

    // ---- Sample planes: stepsPerSlice to a slice distance, plane 0 in slice 0 ----

    int start() const { return m_start; }      ///< the first plane …
    double startW() const { return m_startW; } ///< … which is moved to the front of the box, or to the eye
    double sampleW(int index) const {
        return index == m_start ? m_startW : static_cast<double>(index) / m_in.stepsPerSlice;
    }

    /// The lines through the voxels of slice k, toward the eye, where they meet the plane w.
    LinePlane voxelLines(double w, int k) const {
        if (!m_in.perspective) return {m_in.slopeU * (w - k), m_in.slopeV * (w - k), 1.0};
        const double scale = (w - m_in.eyeW) / (k - m_in.eyeW);
        return {m_in.eyeU * (1 - scale), m_in.eyeV * (1 - scale), scale};
    }
    /// Length in d0 of a line from one slice to the next, of slopes in voxels.
    double lengthOf(double slopeU, double slopeV) const {
        return __builtin_sqrt(m_in.gww + slopeU * (m_in.guu * slopeU + 2 * (m_in.guv * slopeV + m_in.guw)) +
                              slopeV * (m_in.gvv * slopeV + 2 * m_in.gvw));
    }

    // ---- Samples: trilinear, clamped to the outer centres ----

    /// Up to four rows of voxels along u, around (v, w), and their weights. Eight samples beside each other share them.
    struct Rows {
        int count = 0;
        const Code* codes[4];
        float weights[4];
    };
    Rows rowsAt(double v, double w) const {
        v = clampTo(v, m_in.nv - 1);
        w = clampTo(w, m_in.nw - 1);
        const int v0 = smaller(static_cast<int>(v), larger(0, m_in.nv - 2)),
                  w0 = smaller(static_cast<int>(w), larger(0, m_in.nw - 2));
        const double fv = v - v0, fw = w - w0;
        const double weights[4] = {(1 - fv) * (1 - fw), fv * (1 - fw), (1 - fv) * fw, fv * fw};
        Rows rows;
        for (int corner = 0; corner < 4; ++corner) {
            if (weights[corner] < 1e-6) continue; // on a voxel plane: a row less to read
            rows.codes[rows.count] = row(v0 + (corner & 1), w0 + (corner >> 1));
            rows.weights[rows.count++] = static_cast<float>(weights[corner]);
        }
        return rows;
    }

    /// The codes of the voxels (u … u + 7, v, k), of which u is stored; anything beyond the end of the row.
    void codesAt(int u, int v, int k, std::uint16_t (&codes)[kWide]) const {
        const Code* from = row(v, k);
        if (apart())
            for (int n = 0; n < kWide; ++n) codes[n] = from[smaller(u + n, m_in.lastU) * m_in.codeStrides.u];
        else
            store(codes, asCodes(from + u));
    }

    /// The volume at u = first + n·step, n = 0 … 7, along the rows; anything where that is not stored.
    inline Samples sample(const Rows& rows, double first, double step) const {
        const float u0 = static_cast<float>(first), du = static_cast<float>(step);
        Vec8 near = {}, far = {}, total = {}, share = {};
        // One row's part: the codes before and behind each sample, f of the way between them.
        const auto add = [&](int row, Vec8 f) {
            const float weight = rows.weights[row];
            if (kInvalid) { // the mean over the corners that have an intensity
                const Vec8 invalid = Vec8{} + static_cast<float>(kInvalidCode), zero = {};
                const Vec8 nearShare = near == invalid ? zero : (1.0f - f) * weight,
                           farShare = far == invalid ? zero : f * weight;
                total += nearShare * near + farShare * far;
                share += nearShare + farShare;
            } else {
                total += weight * (near + f * (far - near));
            }
        };
        if (du == 1.0f && u0 >= static_cast<float>(m_in.firstU) && u0 + (kWide - 1) < static_cast<float>(m_in.lastU)) {
            // A voxel apart and inside: all at the same fraction between neighbours in memory.
            const int x = static_cast<int>(u0);
            const Vec8 f = Vec8{} + (u0 - static_cast<float>(x));
            for (int row = 0; row < rows.count; ++row) {
                eightAt(rows.codes[row], x, near, far);
                add(row, f);
            }
        } else {
            const Vec8 zero = {}, begin = zero + static_cast<float>(m_in.firstU),
                       last = zero + static_cast<float>(m_in.lastU);
            const Int8 lastPair = Int8{} + larger(m_in.firstU, m_in.lastU - 1);
            Vec8 u = u0 + kIota * du;
            u = u > begin ? u : begin;
            u = u < last ? u : last;
            Int8 x = toInt(u);
            x = x < lastPair ? x : lastPair;
            const Vec8 f = u - toFloat(x);
            for (int row = 0; row < rows.count; ++row) {
                if (apart())
                    pairsApart(rows.codes[row], x, near, far);
                else
                    pairsAt(rows.codes[row], x, near, far);
                add(row, f);
            }
        }
        if (kInvalid) {
            const Vec8 zero = {};
            total = share > zero + kNoShare ? total / share : zero;
        }
        return {toInt(total * m_in.tableEntryOfCode + 0.5f), share};
    }

    /// What lies between two samples, `path` (d0) apart. The intensity goes linearly from one to the other, so τ is its
    /// mean over the table entries between them, both included: what the running integral tells, and for neighbouring
    /// entries the mean of the two.
    static Stretch stretch(Samples from, Samples to, Vec8 path) {
        if (kInvalid) { // a sample without intensity takes that of the other; what is absorbed fades with the share
            const Vec8 nothing = Vec8{} + kNoShare;
            from.entry = from.share > nothing ? from.entry : to.entry;
            to.entry = to.share > nothing ? to.entry : from.entry;
            path *= 0.5f * (from.share + to.share);
        }
        const Int8 low = from.entry < to.entry ? from.entry : to.entry,
                   high = (from.entry < to.entry ? to.entry : from.entry) + 1;
        return {low, high, path / toFloat(high - low)};
    }

    // ---- The sides of the box: half a voxel beyond the outer centres ----

    bool insideU(double first, double last) const { return first >= -0.5 && last <= m_in.nu - 0.5; }
    bool insideV(double v) const { return v >= -0.5 && v <= m_in.nv - 0.5; }

    /// The parts, [0,1], of the lines (a … a + 7, b) between two planes that lie inside the sides.
    Vec8 insideShare(const LinePlane& from, const LinePlane& to, double a, double b) const {
        constexpr float kParallel = 1e-9f; // to a side, all along
        const Vec8 zero = {}, fromU = static_cast<float>(from.u(a)) + kIota * static_cast<float>(from.scale),
                   toU = static_cast<float>(to.u(a)) + kIota * static_cast<float>(to.scale);
        const float fromV = static_cast<float>(from.v(b)), toV = static_cast<float>(to.v(b));
        Vec8 enter = zero, leave = zero + 1.0f;
        const auto cut = [&](Vec8 x0, Vec8 x1, int size) { // by the two sides x = −½ and x = size − ½
            Vec8 way = x1 - x0;
            way = (way < 0.0f ? -way : way) < kParallel ? zero + kParallel : way;
            const Vec8 t0 = (-0.5f - x0) / way, t1 = (static_cast<float>(size) - 0.5f - x0) / way;
            const Vec8 first = t0 < t1 ? t0 : t1, last = t0 < t1 ? t1 : t0;
            enter = first > enter ? first : enter;
            leave = last < leave ? last : leave;
        };
        cut(fromU, toU, m_in.nu);
        cut(zero + fromV, zero + toV, m_in.nv);
        return leave > enter ? leave - enter : zero;
    }

    // ---- Clip planes ----

    bool clips() const { return m_in.planeCount > 0; }

    /// What clip planes leave of eight lines between two planes: parts [0,1] of the way, none where leave ≤ enter.
    struct Kept {
        Vec8 enter = {}, leave = {};
    };
    enum class Clipped { Nothing, Part, All };
    /// Of the lines (a … a + 7, b) from the plane w0 to the plane w1. `kept` is set where a part is clipped.
    Clipped clip(const LinePlane& from, const LinePlane& to, double w0, double w1, double a, double b,
                 Kept& kept) const {
        return clip(m_in.planes, m_in.planeCount, from, to, w0, w1, a, b, kept);
    }
    Clipped clip(const SweepPlane* planes, int count, const LinePlane& from, const LinePlane& to, double w0, double w1,
                 double a, double b, Kept& kept) const {
        const Vec8 zero = {};
        const double u0 = from.u(a), u1 = to.u(a), v0 = from.v(b), v1 = to.v(b);
        Clipped result = Clipped::Nothing;
        for (int i = 0; i < count; ++i) {
            const SweepPlane& p = planes[i];
            // Linear in each of line and way: the extremes are at the corners.
            // Lines that run in a plane, up to rounding, are kept as voxels are.
            const double near0 = p.beyond(u0, v0, w0) - m_in.clipTie, near1 = p.beyond(u1, v1, w1) - m_in.clipTie,
                         step0 = p.u * from.scale, step1 = p.u * to.scale, far0 = near0 + (kWide - 1) * step0,
                         far1 = near1 + (kWide - 1) * step1;
            if (near0 <= 0 && near1 <= 0 && far0 <= 0 && far1 <= 0) continue;
            if (near0 > 0 && near1 > 0 && far0 > 0 && far1 > 0) return Clipped::All;
            if (result == Clipped::Nothing) kept = {zero, zero + 1.0f};
            result = Clipped::Part;
            constexpr float kParallel = 1e-9f; // to the plane, all along
            const Vec8 x0 = static_cast<float>(near0) + kIota * static_cast<float>(step0),
                       x1 = static_cast<float>(near1) + kIota * static_cast<float>(step1);
            Vec8 way = x1 - x0;
            way = (way < 0.0f ? -way : way) < kParallel ? zero + kParallel : way;
            const Vec8 at = -x0 / way;
            kept.leave = way > 0.0f && at < kept.leave ? at : kept.leave;
            kept.enter = way < 0.0f && at > kept.enter ? at : kept.enter;
        }
        return result;
    }
    bool isFaint() const { return m_in.faintCount > 0; }
    /// As part of its own, what the lines keep of the path between two planes of which they come `reach`, (0, 1], where
    /// some of it is faint.
    Vec8 thinned(const LinePlane& from, const LinePlane& to, double w0, double w1, double a, double b,
                 Vec8 reach) const {
        const Vec8 zero = {}, one = zero + 1.0f, density = zero + m_in.faintDensity;
        Kept kept;
        switch (clip(m_in.faintPlanes, m_in.faintCount, from, to, w0, w1, a, b, kept)) {
        case Clipped::Nothing:
            return one;
        case Clipped::All:
            return density;
        case Clipped::Part:
            break;
        }
        const Vec8 leave = kept.leave < reach ? kept.leave : reach, within = leave - kept.enter,
                   share = within > zero ? within / reach : zero;
        return density + (one - density) * share;
    }
    /// The intensities where the kept part of a stretch begins and ends: they go linearly along it.
    static void narrow(Samples& from, Samples& to, const Kept& kept) {
        const Vec8 e0 = toFloat(from.entry), way = toFloat(to.entry) - e0, zero = {}, one = zero + 1.0f;
        const Vec8 enter = kept.enter < one ? kept.enter : one, leave = kept.leave > zero ? kept.leave : zero;
        from.entry = toInt(e0 + enter * way + 0.5f);
        to.entry = toInt(e0 + leave * way + 0.5f);
    }
    /// Bit n: the voxel (u + n, v, k) is kept, and not faint.
    unsigned keptVoxels(int u, int v, int k) const {
        unsigned kept = (1u << kWide) - 1;
        const auto leave = [&](const SweepPlane* planes, int count) {
            for (int i = 0; i < count; ++i) {
                const double first = planes[i].beyond(u, v, k);
                for (int n = 0; n < kWide; ++n)
                    if (first + n * planes[i].u > m_in.clipTie) kept &= ~(1u << n);
            }
        };
        leave(m_in.planes, m_in.planeCount);
        leave(m_in.faintPlanes, m_in.faintCount);
        return kept;
    }

    // ---- The opaque map ----

    /// A row of blocks along u.
    struct OpaqueRow {
        const std::uint8_t* blocks; ///< a bit per lane, SweepInput::opaqueStrides.u apart
        SweepSpan span;             ///< of the blocks that are opaque in any lane
    };
    /// The one around (v, w).
    OpaqueRow opaqueRow(double v, double w) const {
        const int k = clampTo(floorInt(w + 0.5), 0, m_in.nw - 1),
                  row = clampTo(floorInt(v + 0.5), 0, m_in.nv - 1) / kBlockSize,
                  slice = (m_in.flipped ? m_in.nw - 1 - k : k) / kBlockSize;
        return {m_in.opaque + row * m_in.opaqueStrides.v + slice * m_in.opaqueStrides.w,
                m_in.opaqueSpans[row + m_in.spanStride * slice]};
    }
    /// The lanes that are opaque in any block of a row from u = first to last.
    unsigned opaqueBetween(const std::uint8_t* row, double first, double last) const {
        const int end = smaller(clampTo(static_cast<int>(last + 0.5), 0, m_in.nu - 1) / kBlockSize, m_in.lastBlockU);
        unsigned lanes = 0;
        for (int i = larger(clampTo(static_cast<int>(first + 0.5), 0, m_in.nu - 1) / kBlockSize, m_in.firstBlockU);
             i <= end; ++i)
            lanes |= row[i * m_in.opaqueStrides.u];
        return lanes;
    }

private:
    const Code* row(int v, int k) const {
        return CodeOf<kCodes>::first(m_in) + v * m_in.codeStrides.v + k * m_in.codeStrides.w;
    }
    /// Whether neighbours along u are no neighbours in memory.
    bool apart() const { return kCodes == CodeKind::Narrow && m_in.codeStrides.u != 1; }

    /// Codes x … x + 7 of a row, and those behind each. All are inside the row.
    void eightAt(const Code* row, int x, Vec8& near, Vec8& far) const {
        if (!apart()) {
            near = asFloats(row + x);
            far = asFloats(row + x + 1);
            return;
        }
        const Code* at = row + x * m_in.codeStrides.u;
        float values[kWide + 1];
        for (int n = 0; n <= kWide; ++n, at += m_in.codeStrides.u) values[n] = static_cast<float>(*at);
        near = load(values);
        far = load(values + 1);
    }
    void pairsApart(const Code* row, Int8 x, Vec8& near, Vec8& far) const {
        for (int n = 0; n < kWide; ++n) {
            const Code* at = row + x[n] * m_in.codeStrides.u;
            near[n] = static_cast<float>(*at);
            far[n] = static_cast<float>(m_in.lastU > m_in.firstU ? at[m_in.codeStrides.u] : *at);
        }
    }

    const SweepInput& m_in;
    double m_startW;
    int m_start;
};

// ==== The grid of rays =====================================================================================

/// What rays go through from one sample plane to the next.
struct Advance {
    static constexpr int kNowhere = -1000000;
    int to = kNowhere; ///< index of the plane that they come to
    double w0 = 0, w1 = 0;
    LinePlane p0{}, p1{};
    int firstBlock = 0, lastBlock = -1; ///< of rays inside the box
    RaySpan going{};                    ///< bounded: the rays whose stretch counts, where the row does, too
};

/// Two neighbouring rows of rays, as the voxels between them see them.
struct Strip {
    const float *below, *above;                  ///< depths, [ray][lanes]
    const std::uint8_t *aliveBelow, *aliveAbove; ///< per block of eight rays, a bit per lane that is not exhausted
    int first;                                   ///< the `a` of the first ray
    int last;                                    ///< index of the last ray that voxels lie before
    SweepSpan living;                            ///< the blocks of either row that are not exhausted lie in it
};

/// The rays (a, b) of one piece, rows b of blocks of eight along a: all that is known of them at the sample plane that
/// they have come to.
template <SweepMode kMode, CodeKind kCodes>
class Rays {
    static constexpr bool kInvalid = kCodes == CodeKind::WideSomeInvalid;
    using Lanes = LanesOf<kMode>;
    static constexpr int K = Lanes::kLanes;
    static constexpr std::uint8_t kAllLanes = 255;
    static constexpr int kExhaustedEvery = 4; ///< slices between looks for exhausted rays

public:
    /// At the front, with no depth yet.
    Rays(const SweepInput& in, const SweepPiece& piece, const Lines<kCodes>& lines, SweepScratch& scratch)
        : m_in(in), m_piece(piece), m_lines(lines), m_scale(depthScaleOf<kMode>(in)), m_a0(piece.firstRay),
          m_a1(piece.lastRay), m_blocks((m_a1 - m_a0) / kWide + 1), m_b0(piece.firstRow), m_b1(piece.lastRow) {
        startRays(scratch);
    }

    LinePlane plane(double w) const {
        if (m_in.perspective) return {m_in.eyeU, m_in.eyeV, m_piece.slopeStep * (w - m_in.eyeW)};
        return {m_in.slopeU * w, m_in.slopeV * w, m_in.raySpacing};
    }

    /// Between the rows b and b + 1.
    Strip strip(int b) const {
        const float* depth = m_depth + rowOf(b) * rowRays() * K;
        const std::uint8_t* alive = m_alive + rowOf(b) * static_cast<std::size_t>(m_blocks);
        const SweepSpan &below = m_living[rowOf(b)], &above = m_living[rowOf(b) + 1];
        return {depth,
                depth + rowRays() * K,
                alive,
                alive + m_blocks,
                m_a0,
                m_a1 - m_a0,
                {smaller(below.first, above.first), larger(below.last, above.last)}};
    }

    Advance advanceTo(int to) const {
        Advance go{to, m_lines.sampleW(to - 1), m_lines.sampleW(to), {}, {}, 0, -1};
        const LinePlane p0 = go.p0 = plane(go.w0), p1 = go.p1 = plane(go.w1);
        // Rays inside the box on either plane; none are outside on both that come through an edge worth counting.
        double lo = (-0.5 - p1.baseU) / p1.scale, hi = (m_in.nu - 0.5 - p1.baseU) / p1.scale;
        if (p0.scale > 0) { // not at the eye
            const double lo0 = (-0.5 - p0.baseU) / p0.scale, hi0 = (m_in.nu - 0.5 - p0.baseU) / p0.scale;
            lo = lo0 < lo ? lo0 : lo;
            hi = hi0 > hi ? hi0 : hi;
        }
        if (m_in.bounded) go.going = spanWithin(m_in.reach, go);
        if (hi < m_a0 || lo > m_a1) return go;
        go.firstBlock = lo < m_a0 ? 0 : (ceilInt(lo) - m_a0) / kWide;
        go.lastBlock = hi > m_a1 ? m_blocks - 1 : (floorInt(hi) - m_a0) / kWide;
        return go;
    }

    /// Takes a row of rays on by one sample plane. Blocks of eight that meet nothing opaque on either plane, in any
    /// lane that is not exhausted, are passed over.
    void advanceRow(const Advance& go, int b) {
        const LinePlane &p0 = go.p0, &p1 = go.p1;
        const double w0 = go.w0, w1 = go.w1;
        const int from = go.to - 1, to = go.to;
        const float slices = static_cast<float>(w1 - w0);
        const bool look = to % (kExhaustedEvery * m_in.stepsPerSlice) == 0;
        SweepSpan& living = m_living[rowOf(b)];
        if (living.last < living.first) return;

        // Which part of the row is inside the box and near anything opaque?
        const double v0 = p0.v(b), v1 = p1.v(b);
        const bool inside0 = m_lines.insideV(v0), inside1 = m_lines.insideV(v1);
        if (!inside0 && !inside1) return;
        const bool bounded = m_in.bounded;
        if (bounded && (go.going.first >= go.going.end || !rowWithin(m_in.reach, v0, v1))) return;
        const auto opaque = m_lines.opaqueRow(v1, w1);
        Blocks reach{m_blocks, -1};
        widen(reach, m_lines.opaqueRow(v0, w0).span, p0);
        widen(reach, opaque.span, p1);
        reach.first = larger(larger(reach.first, go.firstBlock), living.first);
        reach.last = smaller(smaller(reach.last, go.lastBlock), living.last);
        if (bounded) {
            reach.first = larger(reach.first, (go.going.first - m_a0) / kWide);
            reach.last = smaller(reach.last, (go.going.end - 1 - m_a0) / kWide);
        }
        if (reach.first > reach.last) return;

        const auto before = m_lines.rowsAt(v0, w0), now = m_lines.rowsAt(v1, w1);
        const std::size_t row = rowOf(b) * static_cast<std::size_t>(m_blocks),
                          last = row + static_cast<std::size_t>(reach.last);
        int a = m_a0 + reach.first * kWide; // the first ray of the block
        for (std::size_t at = row + static_cast<std::size_t>(reach.first); at <= last; ++at, a += kWide) {
            if (m_alive[at] == 0) continue;
            const double u1 = p1.u(a), end1 = p1.u(a + kWide - 1);
            const unsigned meets = m_lines.opaqueBetween(opaque.blocks, u1, end1), met = m_met[at];
            m_met[at] = static_cast<std::uint8_t>(meets);
            if (((met | meets) & m_alive[at]) == 0) continue;

            // The sample at either end: the first is at hand, unless the block was passed over last time.
            const std::size_t ray = at * kWide;
            Samples s0;
            if (m_stamp[at] == from) {
                s0.entry = load(m_entry + ray);
                if (kInvalid) s0.share = load(m_share + ray);
            } else {
                s0 = m_lines.sample(before, p0.u(a), p0.scale);
            }
            const Samples s1 = m_lines.sample(now, u1, p1.scale);
            store(m_entry + ray, s1.entry);
            if (kInvalid) store(m_share + ray, s1.share);
            m_stamp[at] = to;

            // The path between them, without what is outside the box; and what it absorbs.
            Vec8 path = load(m_length + ray) * slices;
            if (!(inside0 && inside1) || !m_lines.insideU(u1, end1) || !m_lines.insideU(p0.u(a), p0.u(a + kWide - 1)))
                path *= m_lines.insideShare(p0, p1, a, b);
            if (bounded && (a < go.going.first || a + kWide > go.going.end)) {
                const Int8 index = toInt(kIota) + a;
                path = (index >= go.going.first) & (index < go.going.end) ? path : Vec8{};
            }
            if (m_lines.isFaint()) path *= m_lines.thinned(p0, p1, w0, w1, a, b, Vec8{} + 1.0f);
            if (m_lines.clips()) {
                typename Lines<kCodes>::Kept kept;
                const auto clipped = m_lines.clip(p0, p1, w0, w1, a, b, kept);
                if (clipped == Lines<kCodes>::Clipped::All) continue;
                Samples end = s1; // the next stretch begins with s1
                if (clipped == Lines<kCodes>::Clipped::Part) {
                    const Vec8 part = kept.leave - kept.enter;
                    path *= part > 0.0f ? part : Vec8{};
                    m_lines.narrow(s0, end, kept);
                }
                addDepth(m_depth + ray * K, m_lines.stretch(s0, end, path));
            } else {
                addDepth(m_depth + ray * K, m_lines.stretch(s0, s1, path));
            }
            if (look) m_alive[at] &= static_cast<std::uint8_t>(alive(m_depth + ray * K));
        }
        if (look) narrow(living, b);
    }

    // ---- Of a block of a volume alone ----

    /// Where a row of rays has come to with `go`, those are handed over that enter the reach of another block there.
    /// To be called for each row of a plane, after prepareHandovers(go).
    void handOver(const Advance& go, int b) const {
        if (m_handing == nullptr) return;
        const double v0 = go.p0.v(b), v1 = go.p1.v(b);
        if (go.going.first >= go.going.end || !(v1 >= m_in.reach.lo[1] && v1 < m_in.reach.hi[1])) return;
        for (int i = 0; i < m_in.handoverCount; ++i) {
            const SweepHandover& to = m_in.handovers[i];
            const Handing& h = m_handing[i];
            if (h.enter.first >= h.enter.end || b < to.rect.firstRow || b >= to.rect.endRow ||
                !(v1 >= to.reach.lo[1] && v1 < to.reach.hi[1]))
                continue;
            const bool was = v0 >= to.reach.lo[1] && v0 < to.reach.hi[1];
            for (int a = h.enter.first; a < h.enter.end; ++a) {
                if (was && a >= h.were.first && a < h.were.end) continue;
                const float* from = m_depth + (rowOf(b) * rowRays() + static_cast<std::size_t>(a - m_a0)) * K;
                float* there = to.depths + to.rect.at(a, b, m_in.keptLanes);
                for (int lane = 0; lane < m_in.keptLanes; ++lane) there[lane] = from[lane];
            }
        }
    }
    void prepareHandovers(const Advance& go) {
        for (int i = 0; m_handing != nullptr && i < m_in.handoverCount; ++i) {
            const SweepHandover& to = m_in.handovers[i];
            Handing& h = m_handing[i];
            h = {};
            if (go.going.first >= go.going.end || !(go.w1 >= to.reach.lo[2] && go.w1 < to.reach.hi[2])) continue;
            h.enter = spanAt(go.p1, to.reach);
            h.enter.first = larger(larger(h.enter.first, go.going.first), to.rect.firstCol);
            h.enter.end = smaller(smaller(smaller(h.enter.end, go.going.end), to.rect.endCol), m_a1 + 1);
            if (go.w0 >= to.reach.lo[2] && go.w0 < to.reach.hi[2]) h.were = spanAt(go.p0, to.reach);
        }
    }
    /// What the rays have met, to where the block's depths are kept.
    void writeDepths() const {
        for (int b = m_b0; b < m_b1; ++b) {
            const float* from = m_depth + rowOf(b) * rowRays() * K;
            float* to = m_in.endDepths + m_in.endRect.at(m_a0, b, m_in.keptLanes);
            for (int a = m_a0; a <= m_a1; ++a, from += K)
                for (int lane = 0; lane < m_in.keptLanes; ++lane) *to++ = from[lane];
        }
    }

private:
    /// Rays of one plane, of which some may be handed over.
    struct Handing {
        RaySpan enter; ///< that are in the other's reach, …
        RaySpan were;  ///< … and those that were on the plane before
    };
    std::size_t rows() const { return static_cast<std::size_t>(m_b1 - m_b0 + 1); }
    std::size_t rowRays() const { return static_cast<std::size_t>(m_blocks) * kWide; }
    std::size_t rowOf(int b) const { return static_cast<std::size_t>(b - m_b0); }

    /// The rays whose u on a plane lies in a reach. The same ray is found on the same side of a border by all blocks.
    RaySpan spanAt(const LinePlane& p, const SweepReach& reach) const {
        return {firstFrom(p, reach.lo[0]), firstFrom(p, reach.hi[0])};
    }
    int firstFrom(const LinePlane& p, double u) const {
        const int end = m_a0 + m_blocks * kWide;
        if (!(p.scale > 0)) return p.baseU >= u ? m_a0 : end; // at the eye: all are in one place
        const double a = (u - p.baseU) / p.scale;
        return a <= m_a0 ? m_a0 : a >= end ? end : ceilInt(a);
    }
    /// The rays of a row whose stretch counts, as far as u and w tell.
    RaySpan spanWithin(const SweepReach& reach, const Advance& go) const {
        if (!(go.w1 >= reach.lo[2] && go.w1 < reach.hi[2])) return {};
        RaySpan span = spanAt(go.p1, reach);
        if (!reach.fromInside) return span;
        if (!(go.w0 >= reach.lo[2] && go.w0 < reach.hi[2])) return {};
        const RaySpan before = spanAt(go.p0, reach);
        return {larger(span.first, before.first), smaller(span.end, before.end)};
    }
    static bool rowWithin(const SweepReach& reach, double v0, double v1) {
        return v1 >= reach.lo[1] && v1 < reach.hi[1] && (!reach.fromInside || (v0 >= reach.lo[1] && v0 < reach.hi[1]));
    }

    void startRays(SweepScratch& scratch) {
        const std::size_t rays = rows() * rowRays(), blocks = rows() * static_cast<std::size_t>(m_blocks);
        m_depth = memory<float>(scratch, SweepScratch::Depth, rays * K + 2 * kWide); // see pairsAt
        m_entry = memory<int>(scratch, SweepScratch::Entry, rays);
        if (kInvalid) m_share = memory<float>(scratch, SweepScratch::Share, rays);
        m_length = memory<float>(scratch, SweepScratch::Length, rays);
        m_stamp = memory<int>(scratch, SweepScratch::Stamp, blocks);
        m_alive = memory<std::uint8_t>(scratch, SweepScratch::Alive, blocks);
        m_living = memory<SweepSpan>(scratch, SweepScratch::Living, rows());
        m_met = memory<std::uint8_t>(scratch, SweepScratch::Met, blocks);
        for (std::size_t i = 0; i < rays * K; ++i) m_depth[i] = 0.0f;
        for (std::size_t i = 0; i < blocks; ++i) {
            m_stamp[i] = Advance::kNowhere;
            m_alive[i] = kAllLanes;
            m_met[i] = 0;
        }
        for (int b = m_b0; b <= m_b1; ++b)
            for (std::size_t i = 0; i < rowRays(); ++i)
                m_length[rowOf(b) * rowRays() + i] = static_cast<float>(rayLength(m_a0 + static_cast<int>(i), b));
        if (m_in.startDepths != nullptr) takeDepths();
        if (m_in.carried != nullptr) leaveUnasked();
        for (int b = m_b0; b <= m_b1; ++b) {
            SweepSpan& living = m_living[rowOf(b)];
            living = {0, m_blocks - 1};
            narrow(living, b);
        }
        if (m_in.handoverCount > 0)
            m_handing = memory<Handing>(scratch, SweepScratch::Handing, static_cast<std::size_t>(m_in.handoverCount));
    }
    /// Rays go on with what they have met in other blocks; those of which nothing is known are asked by nobody.
    void takeDepths() {
        for (int b = m_b0; b <= m_b1; ++b)
            for (int block = 0; block < m_blocks; ++block) {
                const std::size_t at = rowOf(b) * static_cast<std::size_t>(m_blocks) + static_cast<std::size_t>(block);
                float* depths = m_depth + at * kWide * K;
                for (int n = 0; n < kWide; ++n) {
                    const int a = m_a0 + block * kWide + n;
                    const float* from = m_in.startRect.holds(a, b)
                                            ? m_in.startDepths + m_in.startRect.at(a, b, m_in.keptLanes)
                                            : nullptr;
                    for (int lane = 0; lane < K; ++lane) {
                        const int kept = smaller(lane, m_in.keptLanes - 1); // candidates repeat the last one
                        depths[n * K + lane] = from == nullptr                               ? kUnknownDepth
                                               : kMode == SweepMode::Jacobian && kept < lane ? 0.0f
                                                                                             : from[kept];
                    }
                }
                m_alive[at] = static_cast<std::uint8_t>(alive(depths));
            }
    }
    /// Groups of rays that nobody asks for are not carried.
    void leaveUnasked() {
        const SweepRect& rect = m_in.endRect;
        const std::uint8_t* asked =
            m_in.carried + static_cast<std::size_t>(m_b0 - rect.firstRow) * static_cast<std::size_t>(m_blocks);
        for (std::size_t i = 0, all = rows() * static_cast<std::size_t>(m_blocks),
                         ends = static_cast<std::size_t>(m_b1 - m_b0) * static_cast<std::size_t>(m_blocks);
             i < all; ++i)
            if (i >= ends || asked[i] == 0) m_alive[i] = 0;
    }
    /// Exhausted blocks at either end of a row are not looked at again.
    void narrow(SweepSpan& living, int b) const {
        const std::uint8_t* alive = m_alive + rowOf(b) * static_cast<std::size_t>(m_blocks);
        while (living.first <= living.last && alive[living.first] == 0) ++living.first;
        while (living.first <= living.last && alive[living.last] == 0) --living.last;
    }
    /// From slice to slice, in d0; the same all along a ray.
    double rayLength(int a, int b) const {
        return m_in.perspective ? m_lines.lengthOf(a * m_piece.slopeStep, b * m_piece.slopeStep)
                                : m_lines.lengthOf(m_in.slopeU, m_in.slopeV);
    }

    /// Blocks of rays of a row; none where last < first.
    struct Blocks {
        int first, last;
    };
    /// Takes in the rays that meet a plane within a span of opaque blocks of voxels.
    void widen(Blocks& reach, const SweepSpan& span, const LinePlane& p) const {
        if (span.last < span.first || !(p.scale > 0)) return;
        // Up to a voxel beyond the blocks; what is clamped to the edge belongs to the outermost block.
        const double lowU = span.first == 0 ? -1e30 : span.first * kBlockSize - 1,
                     highU = (span.last + 1) * kBlockSize >= m_in.nu ? 1e30 : (span.last + 1) * kBlockSize;
        const double low = (lowU - p.baseU) / p.scale, high = (highU - p.baseU) / p.scale;
        reach.first = smaller(reach.first, low <= m_a0 ? 0 : low > m_a1 ? m_blocks : (floorInt(low) - m_a0) / kWide);
        reach.last = larger(reach.last, high >= m_a1  ? m_blocks - 1
                                        : high < m_a0 ? -1
                                                      : (ceilInt(high) - m_a0) / kWide);
    }

    /// Adds what eight rays absorb on a stretch.
    void addDepth(float* depth, const Stretch& s) const {
        const std::int32_t* table = m_in.integralTable; // stores may not change it, but the compiler cannot know
        for (int group = 0; group < Lanes::kGroups; ++group)
            for (int part = 0; part < Lanes::kVectors; ++part, depth += kWide)
                store(depth, load(depth) + Lanes::absorbed(table, s, group, part));
    }

    /// The lanes in which any of eight rays is not exhausted; where not each lane is a depth of its own, all or none.
    unsigned alive(const float* depth) const {
        Int8 open = {};
        for (int group = 0; group < Lanes::kGroups; ++group)
            open |= load(depth + group * Lanes::kVectors * kWide) < m_scale.limit;
        if (kMode == SweepMode::Batch) return bitsOf(open);
        return none(open & (m_scale.unit > 0.0f)) ? 0 : kAllLanes;
    }

    const SweepInput& m_in;
    const SweepPiece& m_piece;
    const Lines<kCodes> m_lines;
    const DepthScale m_scale;
    int m_a0, m_a1;                  ///< rays of a row that voxels lie between
    int m_blocks;                    ///< of eight rays in a row; the last may go beyond m_a1
    int m_b0, m_b1;                  ///< rows of rays; m_b1 is the first of the next piece
    float* m_depth = nullptr;        ///< [row][ray][K]
    int* m_entry = nullptr;          ///< [row][ray], at the plane in m_stamp
    float* m_share = nullptr;        ///< [row][ray], valid corners there
    float* m_length = nullptr;       ///< [row][ray], d0 per slice
    int* m_stamp = nullptr;          ///< [row][block], the plane of the last sample
    std::uint8_t* m_alive = nullptr; ///< [row][block], a bit per lane that is not exhausted
    SweepSpan* m_living = nullptr;   ///< [row], the blocks that are not exhausted lie in it
    std::uint8_t* m_met = nullptr;   ///< [row][block], the lanes that are opaque around the last sample plane
    Handing* m_handing = nullptr;    ///< per SweepInput::handovers; null: none
};

} // namespace
} // namespace pellucid
