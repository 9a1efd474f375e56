// The sweep itself (see sweep.h). Included by one .cpp per instruction set; everything here is in an unnamed namespace
// and uses no templates of the standard library, so that no code compiled for a newer processor leaks into the rest.
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "render/cpu/sweep.h"

namespace pellucid {
namespace {

typedef float Vec8 __attribute__((vector_size(32)));
typedef float Vec8InMemory __attribute__((vector_size(32), aligned(4), may_alias)); // rows of floats, not aligned to 32
typedef int Int8 __attribute__((vector_size(32)));
typedef int Int8InMemory __attribute__((vector_size(32), aligned(4), may_alias));
typedef unsigned UInt8 __attribute__((vector_size(32)));
typedef unsigned UInt8InMemory __attribute__((vector_size(32), aligned(4), may_alias));
typedef std::uint16_t UShort8 __attribute__((vector_size(16)));
typedef std::uint16_t UShort8InMemory __attribute__((vector_size(16), aligned(2), may_alias));

constexpr int kWide = 8;            ///< lines, voxels or lanes in one vector
static_assert(kWide == kBlockSize); // a vector of voxels lies in one block of the opaque map
constexpr Vec8 kIota = {0, 1, 2, 3, 4, 5, 6, 7};

inline Vec8 load(const float* p) { return *reinterpret_cast<const Vec8InMemory*>(p); }
inline Int8 load(const int* p) { return *reinterpret_cast<const Int8InMemory*>(p); }
inline void store(float* p, Vec8 v) { *reinterpret_cast<Vec8InMemory*>(p) = v; }
inline void store(int* p, Int8 v) { *reinterpret_cast<Int8InMemory*>(p) = v; }
inline UShort8 load(const std::uint16_t* p) { return *reinterpret_cast<const UShort8InMemory*>(p); }
inline Vec8 toFloat(Int8 v) { return __builtin_convertvector(v, Vec8); }
inline Int8 toInt(Vec8 v) { return __builtin_convertvector(v, Int8); }
inline Vec8 toFloat(UShort8 v) { return __builtin_convertvector(__builtin_convertvector(v, Int8), Vec8); }

/// from[x[0]], …, from[x[7]].
inline Int8 gathered(const int* from, Int8 x) {
#ifdef __AVX2__
    return reinterpret_cast<Int8>(_mm256_i32gather_epi32(from, reinterpret_cast<__m256i>(x), 4));
#else
    return Int8{from[x[0]], from[x[1]], from[x[2]], from[x[3]], from[x[4]], from[x[5]], from[x[6]], from[x[7]]};
#endif
}
inline Vec8 asFloats(const std::uint16_t* p) { return toFloat(load(p)); }
inline Vec8 asFloats(const float* p) { return load(p); }

/// from[x] and from[x + 1] for each x; x ascends, and sixteen may be read from x[0] on.
template <class T>
inline void pairsAt(const T* from, Int8 x, Vec8& near, Vec8& far) {
#ifdef __AVX2__
    if (x[kWide - 1] - x[0] < 2 * kWide - 1) { // sixteen neighbours hold them all: cheaper than gathering
        const Vec8 low = asFloats(from + x[0]), high = asFloats(from + x[0] + kWide);
        const auto pick = [&](Int8 index) {
            const __m256i i = reinterpret_cast<__m256i>(index);
            const Vec8 fromLow = reinterpret_cast<Vec8>(_mm256_permutevar8x32_ps(reinterpret_cast<__m256>(low), i)),
                       fromHigh = reinterpret_cast<Vec8>(_mm256_permutevar8x32_ps(reinterpret_cast<__m256>(high), i));
            return index < kWide ? fromLow : fromHigh;
        };
        const Int8 index = x - x[0];
        near = pick(index);
        far = pick(index + 1);
        return;
    }
#endif
    for (int n = 0; n < kWide; ++n) {
        near[n] = static_cast<float>(from[x[n]]);
        far[n] = static_cast<float>(from[x[n] + 1]);
    }
}

/// True where no bit of a comparison's result is set.
inline bool none(Int8 v) {
#ifdef __AVX2__
    return _mm256_testz_si256(reinterpret_cast<__m256i>(v), reinterpret_cast<__m256i>(v)) != 0;
#else
    return (v[0] | v[1] | v[2] | v[3] | v[4] | v[5] | v[6] | v[7]) == 0;
#endif
}

/// Read from kJacobianLanes − n on: 1 in lane n, else 0; from 0 on: none.
constexpr float kOneAmongZeros[3 * kJacobianLanes] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
static_assert(kJacobianLanes == 16);

/// A bit per element of a comparison's result.
inline unsigned bitsOf(Int8 v) {
#ifdef __AVX2__
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(v)));
#else
    unsigned bits = 0;
    for (int n = 0; n < kWide; ++n) bits |= v[n] ? 1u << n : 0u;
    return bits;
#endif
}

/// exp(−x) for x ≥ 0, relative error below 4e-6; 0 is approached at x = 87.
inline Vec8 expMinus(Vec8 x) {
    const Vec8 limit = Vec8{} + 87.0f;
    x = x < limit ? x : limit;
    const Vec8 t = x * 1.44269504f;                    // −log2 of the result
    const Int8 whole = toInt(t + 0.5f);                // t ≥ 0: truncation rounds to nearest
    const Vec8 f = (toFloat(whole) - t) * 0.69314718f; // in [−0.35, 0.35]
    // Taylor to degree 5: the next term is 0.35^6/720 = 2.5e-6 at most.
    const Vec8 p = 1.0f + f * (1.0f + f * (0.5f + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120)))));
    return p * reinterpret_cast<Vec8>((127 - whole) << 23);
}

inline int floorInt(double v) { return static_cast<int>(__builtin_floor(v)); }
inline int ceilInt(double v) { return static_cast<int>(__builtin_ceil(v)); }
inline int smaller(int a, int b) { return a < b ? a : b; }
inline int larger(int a, int b) { return a > b ? a : b; }
inline int clampTo(int v, int lo, int hi) { return v < lo ? lo : (v > hi ? hi : v); }
inline double clampTo(double v, double hi) { return v < 0 ? 0 : (v > hi ? hi : v); }

template <class T>
T* memory(SweepScratch& scratch, SweepScratch::Slot slot, std::size_t count) {
    return static_cast<T*>(scratch.bytes(slot, count * sizeof(T)));
}

/// Where rays meet the plane w: coordinate = base + index·scale.
struct RayPlane {
    double baseU, baseV, scale;
    double u(double a) const { return baseU + a * scale; }
    double v(double b) const { return baseV + b * scale; }
};

/// Intensities on eight lines, as entries of the integral table, and the share of valid corners that they come from.
struct Samples {
    Int8 entry;
    Vec8 share;
};

/// The stretch of eight lines between two samples: what the integral table tells of it, and by what to multiply that.
struct Stretch {
    Int8 low, high; ///< rows of the integral table
    Vec8 weight;
};

/// kMode: SweepMode; kInvalid: some voxels may be invalid.
template <SweepMode kMode, bool kInvalid>
class Sweeper {
    static constexpr bool kSingle = kMode == SweepMode::Single;
    static constexpr int K = lanesOf(kMode);
    static constexpr int kVectors = kSingle ? 1 : K / kWide; ///< that hold the lanes of a line
    static constexpr int kSpread = 4; ///< accumulators that take turns, so that no addition waits for the last
    static constexpr std::uint8_t kAllLanes = 255;
    static constexpr int kExhaustedEvery = 4; ///< slices between looks for exhausted rays
    static constexpr int kFlushEvery = 4;     ///< slices
    static constexpr int kLookEvery = 8;      ///< stretches of an own line between looks for light
    static constexpr float kDark = 10;        ///< times the depth at which rays are given up: exp(−60) at most

public:
    Sweeper(const SweepInput& in, const SweepPiece& piece, SweepScratch& scratch, double* sums)
        : m_in(in), m_piece(piece), m_scratch(scratch), m_sums(sums), m_b0(piece.firstRow), m_b1(piece.lastRow),
          m_startW(in.perspective && in.eyeW > -0.5 ? in.eyeW : -0.5), m_start(floorInt(m_startW * in.stepsPerSlice)),
          m_follows(in.tolerance < 1e30f) {
        m_accumulator = memory<float>(scratch, SweepScratch::Accumulator, accumulatorSize());
        for (std::size_t i = 0; i < accumulatorSize(); ++i) m_accumulator[i] = 0.0f;
        for (int lane = 0; lane < K; ++lane) m_limit[lane] = in.exhaustedDepth / in.depthUnit[lane];
        for (int lane = 0; lane < kWide; ++lane) // derivatives are no depths
            m_lightUnit[lane] = kMode == SweepMode::Batch || lane == 0 ? in.depthUnit[lane] : 0.0f;
        const auto planes = static_cast<std::size_t>(in.nw + 2);
        m_near.planes =
            memory<OwnPlane>(scratch, SweepScratch::Near, planes * static_cast<std::size_t>(in.stepsPerSlice));
        m_far.planes = memory<OwnPlane>(scratch, SweepScratch::Far, planes * static_cast<std::size_t>(in.ownSteps));
    }

    /// Takes rays from where they start to the slices of the piece, whose voxels ask for them.
    void run() {
        startRays();
        int at = m_start; // the sample plane that rays have come to
        const auto goal = [&](int k) { return (k - 1) * m_in.stepsPerSlice; };
        for (int k = m_piece.begin; k < m_piece.end; ++k) {
            for (; at < goal(k); ++at) {
                const Advance advance = advanceTo(at + 1);
                for (int b = m_b0; b <= m_b1; ++b) advanceRow(advance, b);
            }
            // Rows of rays go on as soon as no voxel needs them any more where they are: they are at hand now.
            const bool goOn = k + 1 < m_piece.end && at < goal(k + 1);
            gather(k, at, goOn ? advanceTo(at + 1) : Advance{});
            at += goOn;
            if (k % kFlushEvery == kFlushEvery - 1) flush();
        }
        flush();
    }

private:
    static constexpr float kNoShare = 1e-6f; ///< of valid corners: nothing there has an intensity
    static constexpr int kNever = -1000000;  ///< a plane at which no entry was taken

    // ---- The ray grid --------------------------------------------------------------------------------------------

    RayPlane rayPlane(double w) const {
        if (m_in.perspective) return {m_in.eyeU, m_in.eyeV, m_piece.slopeStep * (w - m_in.eyeW)};
        return {m_in.slopeU * w, m_in.slopeV * w, m_in.raySpacing};
    }
    /// The same for the lines through the voxels of slice k.
    RayPlane voxelPlane(double w, int k) const {
        if (!m_in.perspective) return {m_in.slopeU * (w - k), m_in.slopeV * (w - k), 1.0};
        const double scale = (w - m_in.eyeW) / (k - m_in.eyeW);
        return {m_in.eyeU * (1 - scale), m_in.eyeV * (1 - scale), scale};
    }
    std::size_t rows() const { return static_cast<std::size_t>(m_b1 - m_b0 + 1); }
    std::size_t rowRays() const { return static_cast<std::size_t>(m_blocks) * kWide; }
    std::size_t rowOf(int b) const { return static_cast<std::size_t>(b - m_b0); }
    std::size_t accumulatorSize() const {
        return static_cast<std::size_t>(m_in.features + 1) * 3 * (kSingle ? kWide : kSpread * K);
    }
    /// Of the planes that lines are sampled at: stepsPerSlice to a slice distance, the first of all at the front or the
    /// eye.
    double sampleW(int index) const {
        return index == m_start ? m_startW : static_cast<double>(index) / m_in.stepsPerSlice;
    }

    /// The voxels of a slice that are visited.
    struct Extent {
        int u0, u1, v0, v1;
    };
    Extent extentOf(int k) const {
        Extent e{0, m_in.nu - 1, 0, m_in.nv - 1};
        if (!m_in.pyramid) return e;
        const double away = k - m_in.eyeW;
        const auto cut = [&](double eye, bool ownsTie, int& first, int& last) {
            const int lo = ceilInt(eye - away), hi = floorInt(eye + away);
            first = larger(first, lo == eye - away && !ownsTie ? lo + 1 : lo);
            last = smaller(last, hi == eye + away && !ownsTie ? hi - 1 : hi);
        };
        cut(m_in.eyeU, m_in.ownsTieU, e.u0, e.u1);
        cut(m_in.eyeV, m_in.ownsTieV, e.v0, e.v1);
        return e;
    }

    /// Chooses the rays that voxels of the piece will ask for.
    void startRays() {
        double lo = 1e30, hi = -1e30;
        for (const int k :
             {m_piece.begin, m_piece.end - 1}) { // positions are monotone in w: the extremes are at the ends
            const RayPlane p = rayPlane(k);
            double first = 0, last = m_in.nu - 1;
            if (m_in.pyramid) {
                first = first > m_in.eyeU - (k - m_in.eyeW) ? first : m_in.eyeU - (k - m_in.eyeW);
                last = last < m_in.eyeU + (k - m_in.eyeW) ? last : m_in.eyeU + (k - m_in.eyeW);
                if (first > last) { // none on this slice: any may come in between
                    first = m_in.eyeU - (k - m_in.eyeW);
                    last = m_in.eyeU + (k - m_in.eyeW);
                }
            }
            first = (first - p.baseU) / p.scale, last = (last - p.baseU) / p.scale;
            lo = first < lo ? first : lo;
            hi = last > hi ? last : hi;
        }
        m_a0 = floorInt(lo);
        m_a1 = floorInt(hi) + 1;
        m_blocks = (m_a1 - m_a0) / kWide + 1;
        const std::size_t rays = rows() * rowRays(), blocks = rows() * static_cast<std::size_t>(m_blocks);
        m_depth = memory<float>(m_scratch, SweepScratch::Depth, rays * K + 2 * kWide); // see pairsAt
        m_entry = memory<int>(m_scratch, SweepScratch::Entry, rays);
        if (kInvalid) m_share = memory<float>(m_scratch, SweepScratch::Share, rays);
        m_length = memory<float>(m_scratch, SweepScratch::Length, rays);
        m_stamp = memory<int>(m_scratch, SweepScratch::Stamp, blocks);
        m_alive = memory<std::uint8_t>(m_scratch, SweepScratch::Alive, blocks);
        m_met = memory<std::uint8_t>(m_scratch, SweepScratch::Met, blocks);
        for (std::size_t i = 0; i < rays * K; ++i) m_depth[i] = 0.0f;
        for (std::size_t i = 0; i < blocks; ++i) {
            m_stamp[i] = kNever;
            m_alive[i] = kAllLanes;
            m_met[i] = 0;
        }
        for (int b = m_b0; b <= m_b1; ++b)
            for (std::size_t i = 0; i < rowRays(); ++i)
                m_length[rowOf(b) * rowRays() + i] = static_cast<float>(rayLength(m_a0 + static_cast<int>(i), b));
    }

    double lengthOf(double slopeU, double slopeV) const {
        return __builtin_sqrt(m_in.hw * m_in.hw + slopeU * m_in.hu * slopeU * m_in.hu +
                              slopeV * m_in.hv * slopeV * m_in.hv);
    }
    /// Length of a ray between two slices, in d0; the same all along it.
    double rayLength(int a, int b) const {
        return m_in.perspective ? lengthOf(a * m_piece.slopeStep, b * m_piece.slopeStep)
                                : lengthOf(m_in.slopeU, m_in.slopeV);
    }

    // ---- Samples -------------------------------------------------------------------------------------------------

    /// The rows of voxels around (v, w), clamped to the volume, and their weights.
    struct Rows {
        int count = 0;
        const std::uint16_t* codes[4];
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
            rows.codes[rows.count] =
                m_in.codes + (v0 + (corner & 1)) * m_in.codeStrides.v + (w0 + (corner >> 1)) * m_in.codeStrides.w;
            rows.weights[rows.count++] = static_cast<float>(weights[corner]);
        }
        return rows;
    }

    /// The volume at u = u0 + n·du, n = 0 … 7, along the rows.
    inline Samples sample(const Rows& rows, double first, double step) const {
        const float u0 = static_cast<float>(first), du = static_cast<float>(step);
        Vec8 near, far, total = {}, share = {};
        const auto add = [&](int row, Vec8 f) {
            const float weight = rows.weights[row];
            if (kInvalid) {
                const Vec8 invalid = Vec8{} + static_cast<float>(kInvalidCode), zero = {};
                const Vec8 nearShare = near == invalid ? zero : (1.0f - f) * weight,
                           farShare = far == invalid ? zero : f * weight;
                total += nearShare * near + farShare * far;
                share += nearShare + farShare;
            } else {
                total += weight * (near + f * (far - near));
            }
        };
        if (du == 1.0f && u0 >= 0.0f && u0 + (kWide - 1) < static_cast<float>(m_in.nu - 1)) {
            const int x = static_cast<int>(u0);
            const Vec8 f = Vec8{} + (u0 - static_cast<float>(x));
            for (int row = 0; row < rows.count; ++row) {
                near = toFloat(load(rows.codes[row] + x));
                far = toFloat(load(rows.codes[row] + x + 1));
                add(row, f);
            }
        } else {
            const Vec8 zero = {}, last = zero + static_cast<float>(m_in.nu - 1);
            const Int8 lastPair = Int8{} + larger(0, m_in.nu - 2);
            Vec8 u = u0 + kIota * du;
            u = u > zero ? u : zero;
            u = u < last ? u : last;
            Int8 x = toInt(u);
            x = x < lastPair ? x : lastPair;
            const Vec8 f = u - toFloat(x);
            for (int row = 0; row < rows.count; ++row) {
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

    /// τ between two samples is its mean over the table entries from one to the other, both included: what the running
    /// integral tells, and for neighbouring entries the mean of the two.
    static Stretch stretch(Samples from, Samples to, Vec8 path) {
        if (kInvalid) {
            const Vec8 nothing = Vec8{} + kNoShare;
            from.entry = from.share > nothing ? from.entry : to.entry;
            to.entry = to.share > nothing ? to.entry : from.entry;
            path *= 0.5f * (from.share + to.share);
        }
        const Int8 low = from.entry < to.entry ? from.entry : to.entry,
                   high = (from.entry < to.entry ? to.entry : from.entry) + 1;
        return {low, high, path / toFloat(high - low)};
    }

    /// The parts of eight lines between two planes that lie inside the sides of the box.
    Vec8 insideShare(const RayPlane& from, const RayPlane& to, double a, double b) const {
        constexpr float kParallel = 1e-9f; // to a side, all along
        const Vec8 zero = {}, fromU = static_cast<float>(from.u(a)) + kIota * static_cast<float>(from.scale),
                   toU = static_cast<float>(to.u(a)) + kIota * static_cast<float>(to.scale);
        const float fromV = static_cast<float>(from.v(b)), toV = static_cast<float>(to.v(b));
        Vec8 enter = zero, leave = zero + 1.0f;
        const auto cut = [&](Vec8 x0, Vec8 x1, int size) {
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
    bool insideU(double first, double last) const { return first >= -0.5 && last <= m_in.nu - 0.5; }
    bool insideV(double v) const { return v >= -0.5 && v <= m_in.nv - 0.5; }

    // ---- Along the rays ------------------------------------------------------------------------------------------

    /// Of the blocks around (v, w), along u.
    struct OpaqueRow {
        const std::uint8_t* blocks;
        SweepSpan span;
    };
    OpaqueRow opaqueRow(double v, double w) const {
        const int k = clampTo(floorInt(w + 0.5), 0, m_in.nw - 1),
                  row = clampTo(floorInt(v + 0.5), 0, m_in.nv - 1) / kBlockSize,
                  slice = (m_in.flipped ? m_in.nw - 1 - k : k) / kBlockSize;
        return {m_in.opaque + row * m_in.opaqueStrides.v + slice * m_in.opaqueStrides.w,
                m_in.opaqueSpans[row + ((m_in.nv - 1) / kBlockSize + 1) * slice]};
    }
    /// The lanes that are opaque in any block from first to last.
    unsigned opaqueBetween(const std::uint8_t* row, double first, double last) const {
        const int end = clampTo(static_cast<int>(last + 0.5), 0, m_in.nu - 1) / kBlockSize;
        unsigned lanes = 0;
        for (int i = clampTo(static_cast<int>(first + 0.5), 0, m_in.nu - 1) / kBlockSize; i <= end; ++i)
            lanes |= row[i * m_in.opaqueStrides.u];
        return lanes;
    }

    /// What rays go through from one sample plane to the next.
    struct Advance {
        int to = kNever;
        double w0 = 0, w1 = 0;
        RayPlane p0{}, p1{};
        int firstBlock = 0, lastBlock = -1; ///< of rays inside the box
    };
    Advance advanceTo(int to) const {
        Advance go{to, sampleW(to - 1), sampleW(to), {}, {}, 0, -1};
        const RayPlane p0 = go.p0 = rayPlane(go.w0), p1 = go.p1 = rayPlane(go.w1);
        // Rays inside the box on either plane; none are outside on both that come through an edge worth counting.
        double lo = (-0.5 - p1.baseU) / p1.scale, hi = (m_in.nu - 0.5 - p1.baseU) / p1.scale;
        if (p0.scale > 0) {
            const double lo0 = (-0.5 - p0.baseU) / p0.scale, hi0 = (m_in.nu - 0.5 - p0.baseU) / p0.scale;
            lo = lo0 < lo ? lo0 : lo;
            hi = hi0 > hi ? hi0 : hi;
        }
        if (hi < m_a0 || lo > m_a1) return go;
        go.firstBlock = lo < m_a0 ? 0 : (ceilInt(lo) - m_a0) / kWide;
        go.lastBlock = hi > m_a1 ? m_blocks - 1 : (floorInt(hi) - m_a0) / kWide;
        return go;
    }

    /// Takes a row of rays on, blocks of eight at a time; blocks that meet nothing opaque on either plane, in any lane
    /// that is not exhausted, are passed over.
    void advanceRow(const Advance& go, int b) {
        const RayPlane &p0 = go.p0, &p1 = go.p1;
        const double w0 = go.w0, w1 = go.w1;
        const int from = go.to - 1, to = go.to;
        const float slices = static_cast<float>(w1 - w0);
        const bool look = to % (kExhaustedEvery * m_in.stepsPerSlice) == 0;
        const double v0 = p0.v(b), v1 = p1.v(b);
        const bool bothInside = insideV(v0) && insideV(v1);
        if (!bothInside && (larger(v0<-0.5, v0> m_in.nv - 0.5) & larger(v1<-0.5, v1> m_in.nv - 0.5))) return;
        const OpaqueRow opaque = opaqueRow(v1, w1);
        int first = m_blocks, last = -1; // blocks of rays that meet something opaque on either plane
        const auto widen = [&](const SweepSpan& span, const RayPlane& p) {
            if (span.last < span.first || !(p.scale > 0)) return;
            // Half a voxel beyond the blocks; what is clamped to the edge belongs to the outermost block.
            const double lowU = span.first == 0 ? -1e30 : span.first * kBlockSize - 1,
                         highU = (span.last + 1) * kBlockSize >= m_in.nu ? 1e30 : (span.last + 1) * kBlockSize;
            const double low = (lowU - p.baseU) / p.scale, high = (highU - p.baseU) / p.scale;
            first = smaller(first, low <= m_a0 ? 0 : low > m_a1 ? m_blocks : (floorInt(low) - m_a0) / kWide);
            last = larger(last, high >= m_a1 ? m_blocks - 1 : high < m_a0 ? -1 : (ceilInt(high) - m_a0) / kWide);
        };
        widen(opaqueRow(v0, w0).span, p0);
        widen(opaque.span, p1);
        first = larger(first, go.firstBlock);
        last = smaller(last, go.lastBlock);
        if (first > last) return;
        const Rows before = rowsAt(v0, w0), now = rowsAt(v1, w1);
        for (int block = first; block <= last; ++block) {
            const std::size_t at = rowOf(b) * static_cast<std::size_t>(m_blocks) + static_cast<std::size_t>(block);
            if (m_alive[at] == 0) continue;
            const int a = m_a0 + block * kWide;
            const double u1 = p1.u(a), end1 = p1.u(a + kWide - 1);
            const unsigned meets = opaqueBetween(opaque.blocks, u1, end1), met = m_met[at];
            m_met[at] = static_cast<std::uint8_t>(meets);
            if (((met | meets) & m_alive[at]) == 0) continue;
            const std::size_t ray = at * kWide;
            Samples s0;
            if (m_stamp[at] == from) {
                s0.entry = load(m_entry + ray);
                if (kInvalid) s0.share = load(m_share + ray);
            } else {
                s0 = sample(before, p0.u(a), p0.scale);
            }
            const Samples s1 = sample(now, u1, p1.scale);
            store(m_entry + ray, s1.entry);
            if (kInvalid) store(m_share + ray, s1.share);
            m_stamp[at] = to;
            Vec8 path = load(m_length + ray) * slices;
            if (!bothInside || !insideU(u1, end1) || !insideU(p0.u(a), p0.u(a + kWide - 1)))
                path *= insideShare(p0, p1, a, b);
            addDepth(m_depth + ray * K, stretch(s0, s1, path));
            if (look) m_alive[at] &= static_cast<std::uint8_t>(alive(m_depth + ray * K));
        }
    }

    /// Adds what eight rays meet on a stretch.
    void addDepth(float* depth, const Stretch& s) const {
        const std::int32_t* table = m_in.integralTable; // stores may not change it, but the compiler cannot know
        if constexpr (kSingle) {
            store(depth, load(depth) + s.weight * toFloat(gathered(table, s.high) - gathered(table, s.low)));
        } else {
            for (int n = 0; n < kWide; ++n)
                for (int part = 0; part < kVectors; ++part, depth += kWide)
                    store(depth, load(depth) + s.weight[n] * between(table, s.low[n], s.high[n], part));
        }
    }
    /// The difference of two rows of the integral table.
    static Vec8 between(const std::int32_t* table, int low, int high, int part) {
        table += part * kWide;
        return toFloat(load(table + static_cast<std::ptrdiff_t>(high) * K) -
                       load(table + static_cast<std::ptrdiff_t>(low) * K));
    }

    /// The lanes in which any of eight rays is not exhausted; of derivatives, all of them or none.
    unsigned alive(const float* depth) const {
        if constexpr (kMode == SweepMode::Batch) {
            const Vec8 limit = load(m_limit);
            Int8 open = {};
            for (int n = 0; n < kWide; ++n) open |= load(depth + n * kWide) < limit;
            return bitsOf(open);
        } else if constexpr (kSingle) {
            return none(load(depth) < m_limit[0]) ? 0 : kAllLanes;
        } else {
            for (int n = 0; n < kWide; ++n)
                if (depth[n * K] < m_limit[0]) return kAllLanes;
            return 0;
        }
    }

    // ---- At the voxels -------------------------------------------------------------------------------------------

    /// Eight voxels of a row, u … u + 7.
    struct VoxelBlock {
        int u = 0, v = 0, k = 0;
        const std::uint16_t* codes = nullptr;
        std::ptrdiff_t field = 0; ///< index of the first in weights and field
        int list[kWide];          ///< those that count
        int listed = 0;
        Int8 ray;          ///< the ray below, in its row
        Vec8 fraction;     ///< between it and the next
        const float* near; ///< depths of the row of rays below
        const float* far;  ///< and above
        float fractionV;   ///< between them
    };

    /// Measures the voxels of a slice, for rays at a sample plane; then takes those rays on, where `go` says so.
    void gather(int k, int at, const Advance& go) {
        const RayPlane p = rayPlane(k);
        const Extent extent = extentOf(k);
        int next = m_b0;
        const auto goOn = [&](int end) {
            for (; go.to != kNever && next < end; ++next) advanceRow(go, next);
        };
        const int firstRow = larger(extent.v0, m_piece.outermostLow ? 0 : floorInt(p.v(m_b0)) - 1),
                  lastRow = smaller(extent.v1, m_piece.outermostHigh ? m_in.nv - 1 : ceilInt(p.v(m_b1)) + 1);
        for (int v = firstRow; v <= lastRow && extent.u0 <= extent.u1; ++v) {
            const double b = (v - p.baseV) / p.scale;
            if ((b < m_b0 && !m_piece.outermostLow) || (b >= m_b1 && !m_piece.outermostHigh)) continue;
            goOn(clampTo(floorInt(b), m_b0, m_b1 - 1));
            gatherRow(k, v, extent, p, b, at);
        }
        goOn(m_b1 + 1);
    }

    void gatherRow(int k, int v, const Extent& extent, const RayPlane& p, double b, int at) {
        const int row = clampTo(floorInt(b), m_b0, m_b1 - 1);
        const OpaqueRow opaque = opaqueRow(v, k);
        const int firstBlock = larger(extent.u0 / kWide, opaque.span.first),
                  lastBlock = smaller(extent.u1 / kWide, opaque.span.last);
        if (firstBlock > lastBlock) return;
        VoxelBlock block;
        block.v = v;
        block.k = k;
        block.fractionV = static_cast<float>(b - row);
        block.near = m_depth + rowOf(row) * rowRays() * K;
        block.far = block.near + rowRays() * K;
        const std::uint8_t* alive = m_alive + rowOf(row) * static_cast<std::size_t>(m_blocks);
        const std::uint16_t* codes = m_in.codes + v * m_in.codeStrides.v + k * m_in.codeStrides.w;
        const std::ptrdiff_t field = v * m_in.fieldStrides.v + k * m_in.fieldStrides.w;
        m_near.ready = m_far.ready = false;
        const double perVoxel = 1 / p.scale;
        for (int i = firstBlock; i <= lastBlock; ++i) {
            const unsigned opaqueHere = opaque.blocks[i * m_in.opaqueStrides.u];
            if (opaqueHere == 0) continue;
            block.u = i * kWide;
            const double a = (block.u - p.baseU) * perVoxel - m_a0;
            const int firstRay = clampTo(static_cast<int>(a), 0, m_a1 - m_a0 - 1),
                      lastRay = clampTo(static_cast<int>(a + perVoxel * (kWide - 1)) + 1, 0, m_a1 - m_a0);
            unsigned lanes = 0; // in which light comes here
            for (int r = firstRay / kWide; r <= lastRay / kWide; ++r) lanes |= alive[r] | alive[r + m_blocks];
            if ((opaqueHere & lanes) == 0) continue;
            block.codes = codes + block.u;
            block.listed = 0;
            const int end = smaller(kWide, extent.u1 + 1 - block.u);
            for (int n = larger(0, extent.u0 - block.u); n < end; ++n) {
                block.list[block.listed] = n;
                block.listed += m_in.featureOfCode[block.codes[n]] != kTransparent;
            }
            if (block.listed == 0) continue;
            block.field = field + block.u * m_in.fieldStrides.u;
            const Vec8 index = static_cast<float>(a) + kIota * static_cast<float>(perVoxel);
            const Int8 zero = {}, last = zero + (m_a1 - m_a0 - 1);
            Int8 ray = toInt(index);
            ray = ray > zero ? ray : zero;
            block.ray = ray < last ? ray : last;
            block.fraction = index - toFloat(block.ray);
            if (!m_near.ready) startNear(v, k, at);
            gatherBlock(block);
        }
    }

    /// A sample plane as lines through the voxels of one row meet it.
    struct OwnPlane {
        double w;
        RayPlane lines;
        Rows rows;
        bool insideV;
        const std::uint8_t* opaque;
    };
    /// Those on the way to one row of voxels, the farthest first; room for one more.
    struct OwnLines {
        OwnPlane* planes = nullptr;
        int count = 0;
        int begin = 0, end = 0; ///< far: those of [0, count) that have been computed
        bool ready = false;
    };

    OwnPlane ownPlane(double w, int v, int k) const {
        const RayPlane lines = voxelPlane(w, k);
        const double vThere = lines.v(v);
        return {w, lines, rowsAt(vThere, w), insideV(vThere), opaqueRow(vThere, w).blocks};
    }
    /// From where the rays are.
    void startNear(int v, int k, int at) {
        m_near.ready = true;
        m_near.count = 0;
        for (int i = at; i == at || sampleW(i) < k; ++i) m_near.planes[m_near.count++] = ownPlane(sampleW(i), v, k);
    }
    /// From where rays start. Planes are computed when they are asked for: most lines begin at a side of the box, or
    /// end in the dark, long before they have met all slices.
    OwnLines& farLines(const VoxelBlock& block) {
        if (m_far.ready) return m_far;
        m_far.ready = true;
        m_far.count = larger(1, block.k * m_in.ownSteps - farStart());
        m_far.begin = m_far.end = 0;
        return m_far;
    }
    int farStart() const { return floorInt(m_startW * m_in.ownSteps); }
    double farW(int i) const { return i == 0 ? m_startW : static_cast<double>(farStart() + i) / m_in.ownSteps; }
    /// Computes the plane i and some behind it. Not inlined: it is rare in a loop that wants the registers.
    __attribute__((noinline)) void computePlanes(OwnLines& own, int i, const VoxelBlock& block) const {
        constexpr int kAhead = 16;
        if (own.begin == own.end) own.begin = own.end = i;
        for (const int end = smaller(own.count, i + kAhead); own.end < end; ++own.end)
            own.planes[own.end] = ownPlane(farW(own.end), block.v, block.k);
        while (own.begin > i) {
            --own.begin;
            own.planes[own.begin] = ownPlane(farW(own.begin), block.v, block.k);
        }
    }
    /// The last plane before any line of the block enters the box; the first one where they start inside.
    int entryOf(const VoxelBlock& block, const OwnLines& own) const {
        const auto inside = [&](int i) { // from one plane on to the voxels, which are inside
            const RayPlane lines = voxelPlane(farW(i), block.k);
            return insideV(lines.v(block.v)) && lines.u(block.u) <= m_in.nu - 0.5 &&
                   lines.u(block.u + kWide - 1) >= -0.5;
        };
        int outside = -1, in = own.count - 1;
        while (in - outside > 1) {
            const int middle = outside + (in - outside) / 2;
            (inside(middle) ? in : outside) = middle;
        }
        return larger(0, outside);
    }

    /// Of the voxels' own lines, d0 per slice.
    Vec8 voxelLengths(const VoxelBlock& block) const {
        if (!m_in.perspective) return Vec8{} + static_cast<float>(lengthOf(m_in.slopeU, m_in.slopeV));
        const double perSlice = 1 / (block.k - m_in.eyeW), v = (block.v - m_in.eyeV) * perSlice * m_in.hv;
        const Vec8 u = static_cast<float>((block.u - m_in.eyeU) * perSlice * m_in.hu) +
                       kIota * static_cast<float>(perSlice * m_in.hu);
        Vec8 length = u * u + static_cast<float>(m_in.hw * m_in.hw + v * v);
        for (int n = 0; n < kWide; ++n) length[n] = __builtin_sqrtf(length[n]);
        return length;
    }

    /// The stretch from the sample plane of the rays, one slice in front, to d0/2 in front of the voxels: intensity
    /// goes linearly to theirs, as it does from slice to slice along rays.
    Stretch lastStretch(const VoxelBlock& block) const {
        const OwnPlane& p = m_near.planes[0];
        const Vec8 length = voxelLengths(block), zero = {};
        const float slices = static_cast<float>(block.k - p.w);
        const Samples from = sample(p.rows, p.lines.u(block.u), p.lines.scale);
        Vec8 path = length * slices - 0.5f;
        path = path > zero ? path : zero;
        const Vec8 part = path / (length * slices);
        const Int8 codes = __builtin_convertvector(load(block.codes), Int8);
        const Vec8 before = toFloat(from.entry);
        Vec8 own = toFloat(codes) * m_in.tableEntryOfCode;
        if (kInvalid) own = codes == kInvalidCode ? before : own; // has no entry, and nobody asks for its light
        const Samples to{toInt(before + part * (own - before) + 0.5f), from.share + part * (1.0f - from.share)};
        if (!p.insideV || !insideU(p.lines.u(block.u), p.lines.u(block.u + kWide - 1)))
            path *= insideShare(p.lines, voxelPlane(block.k, block.k), block.u, block.v);
        return stretch(from, to, path);
    }

    /// Calls body(stretch) for each stretch of the voxels' own lines that is not transparent, from the plane `first` on
    /// until it says false. kFar: planes are computed when they are come to.
    template <bool kFar, class Body>
    void alongOwnLines(const VoxelBlock& block, OwnLines& own, int first, const Body& body) const {
        const auto plane = [&](int i) -> const OwnPlane& {
            if (kFar && i >= own.end) computePlanes(own, i, block);
            return own.planes[i];
        };
        const Vec8 length = voxelLengths(block), zero = {}, ends = static_cast<float>(block.k) - 0.5f / length;
        double end = static_cast<double>(ends[0]); // d0/2 in front of the voxels: of the one where that is farthest off
        for (int n = 1; n < kWide; ++n) end = static_cast<double>(ends[n]) > end ? static_cast<double>(ends[n]) : end;
        const auto opaqueAt = [&](const OwnPlane& p) {
            return opaqueBetween(p.opaque, p.lines.u(block.u), p.lines.u(block.u + kWide - 1)) != 0;
        };
        const auto inside = [&](const OwnPlane& p) {
            return p.insideV && insideU(p.lines.u(block.u), p.lines.u(block.u + kWide - 1));
        };
        const auto at = [&](const OwnPlane& p) { return sample(p.rows, p.lines.u(block.u), p.lines.scale); };
        if (kFar) computePlanes(own, first, block);
        Samples before = {};
        bool known = false, wasOpaque = opaqueAt(plane(first));
        for (int i = first + 1;; ++i) {
            const OwnPlane& p0 = own.planes[i - 1];
            const bool isLast = i >= own.count || plane(i).w >= end;
            const OwnPlane p1 = isLast ? ownPlane(end > p0.w ? end : p0.w, block.v, block.k) : own.planes[i];
            const bool opaque = opaqueAt(p1);
            if (!opaque && !wasOpaque) {
                known = false;
            } else {
                if (!known) before = at(p0);
                const Samples now = at(p1);
                const Vec8 upTo = Vec8{} + static_cast<float>(p1.w),
                           reach = (upTo < ends ? upTo : ends) - static_cast<float>(p0.w);
                Vec8 path = length * (reach > zero ? reach : zero);
                if (!inside(p0) || !inside(p1)) path *= insideShare(p0.lines, p1.lines, block.u, block.v);
                if (!body(stretch(before, now, path))) return;
                before = now;
                known = true;
            }
            wasOpaque = opaque;
            if (isLast) return;
        }
    }

    /// Where so different amounts of light come along four neighbouring rays that nothing between them is known. The
    /// difference of two transmittances is at most exp(−D)·ΔD, D the smaller depth; 1 + D + D²/2 ≤ exp(D).
    Int8 disagree(Vec8 a, Vec8 b, Vec8 c, Vec8 d, Vec8 unit) const {
        const Vec8 lowAB = a < b ? a : b, highAB = a < b ? b : a, lowCD = c < d ? c : d, highCD = c < d ? d : c;
        const Vec8 low = (lowAB < lowCD ? lowAB : lowCD) * unit, high = (highAB > highCD ? highAB : highCD) * unit;
        return high - low > m_in.tolerance * (1.0f + low * (1.0f + 0.5f * low));
    }

    void gatherBlock(const VoxelBlock& block) {
        if constexpr (kSingle)
            gatherSingle(block);
        else
            gatherLanes(block);
    }

    void gatherSingle(const VoxelBlock& block) {
        Vec8 near0, near1, far0, far1;
        pairsAt(block.near, block.ray, near0, near1);
        pairsAt(block.far, block.ray, far0, far1);
        const Vec8 near = near0 + block.fraction * (near1 - near0), far = far0 + block.fraction * (far1 - far0);
        Vec8 depth = near + block.fractionV * (far - near);
        const auto depthOf = [this](const Stretch& s) {
            return s.weight * toFloat(gathered(m_in.integralTable, s.high) - gathered(m_in.integralTable, s.low));
        };
        if (m_in.stepsPerSlice == 1)
            depth += depthOf(lastStretch(block));
        else
            alongOwnLines<false>(block, m_near, 0, [&](const Stretch& s) {
                depth += depthOf(s);
                return true;
            });
        if (m_follows) {
            Int8 listed = {};
            for (int i = 0; i < block.listed; ++i) listed[block.list[i]] = -1;
            if (!none(disagree(near0, near1, far0, far1, Vec8{} + m_in.depthUnit[0]) & listed)) {
                depth = Vec8{};
                OwnLines& own = farLines(block);
                int stretches = 0;
                alongOwnLines<true>(block, own, entryOf(block, own), [&](const Stretch& s) {
                    depth += depthOf(s);
                    if (++stretches % kLookEvery != 0) return true;
                    if (!none((depth < m_limit[0]) & listed)) return true;
                    depth *= kDark; // a little light in each of many voxels would be much
                    return false;
                });
            }
        }
        Vec8 alpha = {}, weights[2] = {};
        Int8 feature = Int8{} + kTransparent;
        for (int i = 0; i < block.listed; ++i) {
            const int n = block.list[i];
            alpha[n] = m_in.alphaTable[block.codes[n]];
            feature[n] = m_in.featureOfCode[block.codes[n]];
            if (!m_in.weights) continue;
            const std::uint32_t both = m_in.weights[block.field + n * m_in.fieldStrides.u];
            weights[0][n] = static_cast<float>(both & 0xffff);
            weights[1][n] = static_cast<float>(both >> 16);
        }
        const Vec8 seen = expMinus(depth * m_in.depthUnit[0]) * alpha;
        if (m_in.field)
            for (int i = 0; i < block.listed; ++i)
                m_in.field[block.field + block.list[i] * m_in.fieldStrides.u] = seen[block.list[i]];
        for (int i = 0; i < block.listed; ++i) { // the features of the block in turn: nearly always one
            const int f = feature[block.list[i]];
            if (f < 0) continue; // has had its turn
            float* sum = m_accumulator + static_cast<std::size_t>(f) * 3 * kWide;
            const Int8 here = feature == f;
            const Vec8 zero = {}, mine = here ? seen : zero;
            store(sum, load(sum) + mine);
            store(sum + kWide, load(sum + kWide) + mine * weights[0]);
            store(sum + 2 * kWide, load(sum + 2 * kWide) + mine * weights[1]);
            feature |= here; // −1
        }
    }

    /// Lanes in which a voxel of this code is seen at all.
    Int8 opaqueLanes(std::uint16_t code) const {
        if (kMode == SweepMode::Jacobian) return Int8{} - (m_in.alphaTable[static_cast<std::size_t>(code) * 2] > 0);
        return load(m_in.alphaTable + static_cast<std::size_t>(code) * K) > Vec8{};
    }

    void gatherLanes(const VoxelBlock& block) {
        // The four rays around each voxel.
        const Vec8 f = block.fraction;
        const float fv = block.fractionV;
        const Vec8 near0 = (1.0f - f) * (1.0f - fv), near1 = f * (1.0f - fv), far0 = (1.0f - f) * fv, far1 = f * fv;
        const float *nearRow = block.near, *farRow = block.far;
        const Int8 rays = block.ray;
        const auto atRays = [=](int n, int part, const auto& body) {
            const std::ptrdiff_t ray = static_cast<std::ptrdiff_t>(rays[n]) * K + part * kWide;
            const Vec8 d0 = load(nearRow + ray), d1 = load(nearRow + ray + K), d2 = load(farRow + ray),
                       d3 = load(farRow + ray + K);
            body(d0, d1, d2, d3);
            return near0[n] * d0 + near1[n] * d1 + far0[n] * d2 + far1[n] * d3;
        };
        const Ledger ledger = ledgerOf(block);
        if (!m_follows && m_in.stepsPerSlice == 1) { // nearly always: all in registers
            const Stretch s = lastStretch(block);
            for (int i = 0; i < block.listed; ++i) {
                const int n = block.list[i];
                Vec8 depth[kVectors];
                for (int part = 0; part < kVectors; ++part)
                    depth[part] = atRays(n, part, [](Vec8, Vec8, Vec8, Vec8) {}) +
                                  s.weight[n] * between(ledger.integral, s.low[n], s.high[n], part);
                account(ledger, block, i, depth);
            }
            return;
        }
        Vec8 depth[kWide][kVectors], own[kWide][kVectors];
        Int8 apart = {}; // lanes in which any voxel's rays disagree
        for (int i = 0; i < block.listed; ++i) {
            const int n = block.list[i];
            for (int part = 0; part < kVectors; ++part)
                depth[n][part] = atRays(n, part, [&](Vec8 d0, Vec8 d1, Vec8 d2, Vec8 d3) {
                    if (part == 0 && m_follows)
                        apart |= disagree(d0, d1, d2, d3, load(m_lightUnit)) & opaqueLanes(block.codes[n]);
                });
        }
        const auto addTo = [&](Vec8(*sum)[kVectors], const Stretch& s) {
            for (int i = 0; i < block.listed; ++i) {
                const int n = block.list[i];
                for (int part = 0; part < kVectors; ++part)
                    sum[n][part] += s.weight[n] * between(m_in.integralTable, s.low[n], s.high[n], part);
            }
        };
        alongOwnLines<false>(block, m_near, 0, [&](const Stretch& s) {
            addTo(depth, s);
            return true;
        });
        if (!none(apart)) {
            if (kMode == SweepMode::Jacobian) apart = Int8{} - 1; // derivatives go with their depth
            for (auto& voxel : own)
                for (Vec8& part : voxel) part = Vec8{};
            // Lanes that are depths, and whose depths are asked for.
            const Int8 counts = (load(m_lightUnit) > Vec8{}) & apart;
            OwnLines& lines = farLines(block);
            int stretches = 0;
            alongOwnLines<true>(block, lines, entryOf(block, lines), [&](const Stretch& s) {
                addTo(own, s);
                if (++stretches % kLookEvery != 0) return true;
                Int8 light = {};
                for (int i = 0; i < block.listed; ++i) light |= own[block.list[i]][0] < load(m_limit);
                if (!none(light & counts)) return true;
                for (int i = 0; i < block.listed; ++i) own[block.list[i]][0] *= kDark;
                return false;
            });
            for (int i = 0; i < block.listed; ++i)
                for (int part = 0; part < kVectors; ++part) {
                    const int n = block.list[i];
                    depth[n][part] = apart ? own[n][part] : depth[n][part];
                }
        }
        for (int i = 0; i < block.listed; ++i) account(ledger, block, i, depth[block.list[i]]);
    }

    /// What accounting needs, in registers: stores may not change it, but the compiler cannot know.
    struct Ledger {
        const std::int32_t* integral;
        const float* alpha;
        const std::uint16_t* featureOfCode;
        const std::uint32_t* weights; ///< of the first voxel of the block
        std::ptrdiff_t weightStep;
        float* sums;
        std::ptrdiff_t spread; ///< from one accumulator to the one that takes turns with it
        Vec8 unit[kVectors];   ///< Jacobian: 0 in lane 0
    };
    Ledger ledgerOf(const VoxelBlock& block) const {
        Ledger ledger{m_in.integralTable,
                      m_in.alphaTable,
                      m_in.featureOfCode,
                      m_in.weights ? m_in.weights + block.field : nullptr,
                      m_in.fieldStrides.u,
                      m_accumulator,
                      static_cast<std::ptrdiff_t>(m_in.features + 1) * 3 * K,
                      {}};
        for (int part = 0; part < kVectors; ++part) ledger.unit[part] = load(m_in.depthUnit + part * kWide);
        if (kMode == SweepMode::Jacobian) ledger.unit[0][0] = 0;
        return ledger;
    }

    /// Adds what the i-th listed voxel of a block shows.
    void account(const Ledger& ledger, const VoxelBlock& block, int i, const Vec8* depth) const {
        const int n = block.list[i];
        const std::uint16_t code = block.codes[n];
        const int feature = ledger.featureOfCode[code];
        Vec8 seen[kVectors];
        if constexpr (kMode == SweepMode::Batch)
            seen[0] = expMinus(depth[0] * ledger.unit[0]) * load(ledger.alpha + static_cast<std::size_t>(code) * K);
        else
            differentiate(ledger, depth, code, feature, seen);
        float* sum = ledger.sums + (i & (kSpread - 1)) * ledger.spread + feature * (3 * K);
        add(sum, seen, 1.0f);
        if (!ledger.weights) return;
        const std::uint32_t both = ledger.weights[n * ledger.weightStep];
        add(sum + K, seen, static_cast<float>(both & 0xffff));
        add(sum + 2 * K, seen, static_cast<float>(both >> 16));
    }
    static void add(float* sum, const Vec8* seen, float weight) {
        for (int part = 0; part < kVectors; ++part)
            store(sum + part * kWide, load(sum + part * kWide) + seen[part] * weight);
    }

    /// v = α·exp(−D) in lane 0, ∂v/∂x_j = exp(−D)·∂α/∂x_j − v·∂D/∂x_j in lane 1 + j.
    void differentiate(const Ledger& ledger, const Vec8* depth, std::uint16_t code, int feature, Vec8* seen) const {
        const float* alpha = ledger.alpha + static_cast<std::size_t>(code) * 2;
        const Vec8 light = expMinus(Vec8{} + depth[0][0] * m_in.depthUnit[0]), v = light * alpha[0];
        const int lane = feature - m_in.firstDerivative + 1;
        const bool own = feature < m_in.features && lane >= 1 && lane < K; // lane of the voxel's own feature
        const float *first = kOneAmongZeros + K, *mine = kOneAmongZeros + K - (own ? lane : K);
        for (int part = 0; part < kVectors; ++part, first += kWide, mine += kWide)
            seen[part] = v * (load(first) - depth[part] * ledger.unit[part]) + light * alpha[1] * load(mine);
    }

    /// Floats hold a few slices of a piece at most: what they lose stays below 1e-6 of the sum.
    void flush() {
        const std::size_t sums = static_cast<std::size_t>(m_in.features + 1) * 3;
        if (kSingle) {
            for (std::size_t i = 0; i < sums; i += 3) { // the three of a feature
                const float* at = m_accumulator + i * kWide;
                if (none(load(at) != Vec8{})) continue; // of many features few occur in a piece
                for (int n = 0; n < 3 * kWide; ++n)
                    m_sums[i + static_cast<std::size_t>(n / kWide)] += static_cast<double>(at[n]);
            }
        } else {
            for (std::size_t i = 0; i < sums * K * kSpread; ++i)
                m_sums[i % (sums * K)] += static_cast<double>(m_accumulator[i]);
        }
        for (std::size_t i = 0; i < accumulatorSize(); ++i) m_accumulator[i] = 0.0f;
    }

    const SweepInput& m_in;
    const SweepPiece& m_piece;
    SweepScratch& m_scratch;
    double* m_sums;
    int m_a0 = 0, m_a1 = 0;          ///< rays of a row that voxels lie between
    int m_blocks = 0;                ///< of eight rays in a row; the last may go beyond m_a1
    int m_b0, m_b1;                  ///< rows of rays; m_b1 is the first of the next piece
    double m_startW;                 ///< where rays start
    int m_start;                     ///< the sample plane there
    float* m_accumulator;            ///< Single: [features + 1][3][eight voxels], else [kSpread][features + 1][3][K]
    float* m_depth = nullptr;        ///< [row][ray][K]
    int* m_entry = nullptr;          ///< [row][ray], at the plane in m_stamp
    float* m_share = nullptr;        ///< [row][ray], valid corners there
    float* m_length = nullptr;       ///< [row][ray], d0 per slice
    int* m_stamp = nullptr;          ///< [row][block]
    std::uint8_t* m_alive = nullptr; ///< [row][block], a bit per lane that is not exhausted
    std::uint8_t* m_met = nullptr;   ///< [row][block], the lanes that are opaque around the last sample plane
    float m_limit[K];                ///< a lane at this depth, in units of the table, is exhausted
    float m_lightUnit[kWide];        ///< depthUnit of the lanes that are depths, else 0
    OwnLines m_near;                 ///< from where the rays are to the voxels of a row
    OwnLines m_far;                  ///< from where rays start
    bool m_follows;                  ///< own lines all the way, where rays disagree
};

void sweepPiece(const SweepInput& in, const SweepPiece& piece, SweepScratch& scratch, double* sums) {
    const auto run = [&]<SweepMode kMode>() {
        if (in.someInvalid)
            Sweeper<kMode, true>(in, piece, scratch, sums).run();
        else
            Sweeper<kMode, false>(in, piece, scratch, sums).run();
    };
    switch (in.mode) {
    case SweepMode::Single:
        return run.template operator()<SweepMode::Single>();
    case SweepMode::Batch:
        return run.template operator()<SweepMode::Batch>();
    case SweepMode::Jacobian:
        return run.template operator()<SweepMode::Jacobian>();
    }
}

} // namespace
} // namespace pellucid
