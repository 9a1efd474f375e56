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

/// row[x[0]], …, row[x[7]].
inline Vec8 gathered(const float* row, Int8 x) {
#ifdef __AVX2__
    return reinterpret_cast<Vec8>(_mm256_i32gather_ps(row, reinterpret_cast<__m256i>(x), 4));
#else
    return Vec8{row[x[0]], row[x[1]], row[x[2]], row[x[3]], row[x[4]], row[x[5]], row[x[6]], row[x[7]]};
#endif
}

inline Int8 gathered(const int* row, Int8 x) {
#ifdef __AVX2__
    return reinterpret_cast<Int8>(_mm256_i32gather_epi32(row, reinterpret_cast<__m256i>(x), 4));
#else
    return Int8{row[x[0]], row[x[1]], row[x[2]], row[x[3]], row[x[4]], row[x[5]], row[x[6]], row[x[7]]};
#endif
}

inline bool allZero(Int8 v) {
#ifdef __AVX2__
    return _mm256_testz_si256(reinterpret_cast<__m256i>(v), reinterpret_cast<__m256i>(v)) != 0;
#else
    return (v[0] | v[1] | v[2] | v[3] | v[4] | v[5] | v[6] | v[7]) == 0;
#endif
}

template <class V>
struct Lanes;
template <>
struct Lanes<Vec8> {
    static constexpr int kCount = 8;
    static Vec8 load(const float* p) { return *reinterpret_cast<const Vec8InMemory*>(p); }
    static void store(float* p, Vec8 v) { *reinterpret_cast<Vec8InMemory*>(p) = v; }
    static Vec8 zero() { return Vec8{}; }
    static Int8 toInt(Vec8 v) { return __builtin_convertvector(v, Int8); }
    static Vec8 toFloat(Int8 v) { return __builtin_convertvector(v, Vec8); }
    static Vec8 bits(Int8 v) { return reinterpret_cast<Vec8>(v); }
    static Vec8 atMost(Vec8 v, float limit) { return v < limit ? v : Vec8{} + limit; }
};
template <>
struct Lanes<float> {
    static constexpr int kCount = 1;
    static float load(const float* p) { return *p; }
    static void store(float* p, float v) { *p = v; }
    static float zero() { return 0.0f; }
    static int toInt(float v) { return static_cast<int>(v); }
    static float toFloat(int v) { return static_cast<float>(v); }
    static float bits(int v) { return __builtin_bit_cast(float, v); }
    static float atMost(float v, float limit) { return v < limit ? v : limit; }
};

/// exp(−x) for x ≥ 0, relative error below 3e-7; 0 is approached at x = 87.
template <class V>
inline V expMinus(V x) {
    using L = Lanes<V>;
    x = L::atMost(x, 87.0f);
    const V t = x * 1.44269504f;                       // −log2 of the result
    const auto whole = L::toInt(t + 0.5f);             // t ≥ 0: truncation rounds to nearest
    const V f = (L::toFloat(whole) - t) * 0.69314718f; // in [−0.35, 0.35]
    // Taylor to degree 6: the next term is 0.35^7/5040 = 1.3e-7.
    const V p = 1.0f + f * (1.0f + f * (0.5f + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
    return p * L::bits((127 - whole) << 23);
}

inline int floorInt(double v) { return static_cast<int>(__builtin_floor(v)); }
inline int ceilInt(double v) { return static_cast<int>(__builtin_ceil(v)); }
inline int smaller(int a, int b) { return a < b ? a : b; }
inline int larger(int a, int b) { return a > b ? a : b; }
inline double clampTo(double v, double hi) { return v < 0 ? 0 : (v > hi ? hi : v); }

/// Where rays meet the plane w: coordinate = base + index·scale.
struct RayPlane {
    double baseU, baseV, scale;
};

template <class V>
class Band {
    using L = Lanes<V>;
    static constexpr int K = L::kCount;
    static constexpr int kNear = 4; ///< table entries closer than this are averaged by their middle

public:
    Band(const SweepInput& in, const SweepBand& band, SweepScratch& scratch, double* sums)
        : m_in(in), m_band(band), m_scratch(scratch), m_sums(sums), m_slopeStep(in.firstSlopeStep), m_b0(band.first),
          m_b1(band.last) {
        const auto nu = static_cast<std::size_t>(in.nu);
        m_accumulator = scratch.floats(0, accumulatorSize());
        for (std::size_t i = 0; i < accumulatorSize(); ++i) m_accumulator[i] = 0.0f;
        m_row = scratch.floats(1, 2 * (nu + 1));
        m_local.depth = scratch.floats(2, nu * K);
        m_local.share = scratch.floats(3, nu);
        m_local.entry = scratch.ints(0, nu);
    }

    /// Slices in turn, each range of them with rays of its own, dense enough there: rays that diverge from a near eye
    /// start anew from the front of the box as soon as they lie too far apart.
    void run() {
        for (int begin = 0; begin < m_in.nw;) {
            int end = m_in.nw;
            if (m_in.perspective) {
                end = smaller(end, floorInt(m_in.eyeW + m_in.raySpacing / m_slopeStep * (1 + 1e-9)) + 1);
                if (end <= begin) end = begin; // not dense enough for a single slice
            }
            if (end > begin) sweepSlices(begin, end);
            begin = end;
            m_slopeStep *= 0.5;
            m_b0 *= 2;
            m_b1 *= 2;
        }
    }

private:
    static constexpr int kOutside = -1;
    static constexpr float kNoShare = 1e-6f; ///< of valid corners: nothing there has an intensity

    /// Neighbouring lines toward the eye, rays or those of voxels, and how far they have come: per line the optical
    /// depth of each candidate, the table entry at the last sample (kOutside: not in the box there), and where voxels
    /// may be invalid the share of valid corners there.
    struct Lines {
        int first = 0, last = 0; ///< indices along u
        float* depth = nullptr;  ///< [line][K]
        int* entry = nullptr;
        float* share = nullptr;
        const float* length = nullptr;        ///< d0 per slice
        int lengthStep = 1;                   ///< 0: the same for all
        const std::uint16_t* codes = nullptr; ///< of the voxels whose lines these are; null for rays
    };

    /// Of SweepInput, where the compiler sees that stores leave them alone.
    struct Tables {
        const float *depth, *integral;
        const int* opaqueBefore;
    };

    // ---- The ray grid --------------------------------------------------------------------------------------------

    RayPlane rayPlane(double w) const {
        if (m_in.perspective) return {m_in.eyeU, m_in.eyeV, m_slopeStep * (w - m_in.eyeW)};
        return {m_in.slopeU * w, m_in.slopeV * w, m_in.raySpacing};
    }
    /// The same for the lines through the voxels of slice k.
    RayPlane voxelPlane(double w, int k) const {
        if (!m_in.perspective) return {m_in.slopeU * (w - k), m_in.slopeV * (w - k), 1.0};
        const double scale = (w - m_in.eyeW) / (k - m_in.eyeW);
        return {m_in.eyeU * (1 - scale), m_in.eyeV * (1 - scale), scale};
    }
    std::size_t rowRays() const { return static_cast<std::size_t>(m_a1 - m_a0 + 1); }
    std::size_t rays() const { return rowRays() * static_cast<std::size_t>(m_b1 - m_b0 + 1); }
    std::size_t rayIndex(int a, int b) const {
        return static_cast<std::size_t>(b - m_b0) * rowRays() + static_cast<std::size_t>(a - m_a0);
    }
    std::size_t accumulatorSize() const { return static_cast<std::size_t>(m_in.features + 1) * 3 * K; }

    /// Takes rays from the front of the box to the slices [begin, end), whose voxels ask for them.
    void sweepSlices(int begin, int end) {
        startRays(begin, end);
        int next = 0; // where the rays go next
        for (int k = begin; k < end; ++k) {
            for (; next <= k - m_in.ownSlices; ++next) advanceRays(next);
            gather(k);
            flush();
        }
    }

    /// Chooses the rays that voxels of the slices [begin, end) will ask for, and lets them start.
    void startRays(int begin, int end) {
        double lo = 1e30, hi = -1e30;
        for (int side = 0; side < 2; ++side) { // positions are monotone in w: the extremes are at the ends
            const RayPlane p = rayPlane(side == 0 ? begin : end - 1);
            const double first = (0 - p.baseU) / p.scale, last = (m_in.nu - 1 - p.baseU) / p.scale;
            lo = first < lo ? first : lo;
            hi = last > hi ? last : hi;
        }
        m_a0 = floorInt(lo);
        m_a1 = floorInt(hi) + 1;
        m_rays.depth = m_scratch.floats(4, rays() * K);
        m_rays.share = m_scratch.floats(5, rays());
        m_rays.entry = m_scratch.ints(1, rays());
        m_gatherRow = m_scratch.floats(6, rowRays() * K);
        m_length = m_scratch.floats(7, rays());
        const std::size_t longest = 8 + static_cast<std::size_t>(larger(m_a1 - m_a0 + 1, m_in.nu));
        m_next = m_scratch.ints(2, longest);
        m_nextShare = m_scratch.floats(8, longest);
        for (int b = m_b0; b <= m_b1; ++b)
            for (int a = m_a0; a <= m_a1; ++a) m_length[rayIndex(a, b)] = static_cast<float>(rayLength(a, b));
        for (std::size_t i = 0; i < rays() * K; ++i) m_rays.depth[i] = 0.0f;
        forEachBlock([&](const Block& block) { this->begin(rayPlane(-0.5), -0.5, block.row, raysOf(block)); });
    }

    double lengthOf(double slopeU, double slopeV) const {
        return __builtin_sqrt(m_in.hw * m_in.hw + slopeU * m_in.hu * slopeU * m_in.hu +
                              slopeV * m_in.hv * slopeV * m_in.hv);
    }
    /// Length of a ray between two slices, in d0; the same all along it.
    double rayLength(int a, int b) const {
        return m_in.perspective ? lengthOf(a * m_slopeStep, b * m_slopeStep) : lengthOf(m_in.slopeU, m_in.slopeV);
    }

    /// Lines along a row that may share their sample planes: all where they are parallel, else as long as their slopes
    /// (here `slopeStep` apart) hardly change.
    int blockSize(double slopeStep, int all) const {
        constexpr double kSlopeChange = 0.06;
        return m_in.perspective
                   ? larger(1, static_cast<int>(clampTo(kSlopeChange * m_in.hw / (slopeStep * m_in.hu), all)))
                   : all;
    }

    struct Block {
        int row, first, last;
        double length; ///< d0 per slice, in the middle
    };
    template <class Body>
    void forEachBlock(const Body& body) {
        const int size = blockSize(m_slopeStep, m_a1 - m_a0 + 1);
        for (int b = m_b0; b <= m_b1; ++b)
            for (int a = m_a0; a <= m_a1; a += size) {
                const int last = smaller(a + size - 1, m_a1);
                body(Block{b, a, last, rayLength((a + last) / 2, b)});
            }
    }
    Lines raysOf(const Block& block) const {
        const std::size_t at = rayIndex(block.first, block.row);
        return {block.first, block.last, m_rays.depth + at * K, m_rays.entry + at, m_rays.share + at, m_length + at,
                1,           nullptr};
    }

    // ---- Along the lines -----------------------------------------------------------------------------------------

    /// Takes every ray on to d0/2 in front of slice k.
    void advanceRays(int k) {
        forEachBlock([&](const Block& block) {
            const auto plane = [&](double w) { return rayPlane(w); };
            toSlice(plane, k, block.length, block.row, raysOf(block));
        });
    }

    /// From d0/2 in front of slice k − 1 (k = 0: from the front of the box) to d0/2 in front of slice k. A sample lies
    /// on each voxel plane, since that is where trilinear interpolation has its kinks.
    template <class Plane>
    void toSlice(const Plane& plane, int k, double length, int row, const Lines& lines) {
        const double end = k - 0.5 / length;
        double from = k == 0 ? -0.5 : end - 1;
        if (k > 0) from = step(plane, from, k - 1, row, lines);
        const int steps = stepsOver(end - from, length);
        const double start = from;
        if (end - start < 1e-6) return;
        for (int n = 1; n <= steps; ++n) from = step(plane, from, start + (end - start) * n / steps, row, lines);
    }

    /// Samples over a part of a slice distance: no further apart than maxStep, but no more than tell the voxels apart
    /// that a line crosses there, since between them its intensity is smooth (long voxels seen along their length).
    int stepsOver(double slices, double length) const {
        const double lateral = length * length - m_in.hw * m_in.hw; // squared, in d0
        const double narrow = m_in.hu < m_in.hv ? m_in.hu : m_in.hv;
        const double crossed = lateral > 0 ? 1.5 * slices * __builtin_sqrt(lateral) / narrow : 0.0;
        const double wanted = slices * length / m_in.maxStep - 1e-6, enough = 1 + 2 * crossed / m_in.maxStep;
        return larger(1, ceilInt(wanted < enough ? wanted : enough));
    }

    /// The lines of `row` that are inside the box at this plane; empty where first > last.
    struct Inside {
        int first, last;
    };
    Inside insideAt(const RayPlane& p, int row, const Lines& lines) const {
        const double v = p.baseV + row * p.scale;
        if (v < -0.5 || v > m_in.nv - 0.5) return {lines.first, lines.first - 1};
        return {larger(lines.first, ceilInt((-0.5 - p.baseU) / p.scale)),
                smaller(lines.last, floorInt((m_in.nu - 0.5 - p.baseU) / p.scale))};
    }

    /// Reads the volume along `row` where it meets the plane w, into m_row; see interpolateRow.
    void readRow(const RayPlane& p, double w, int row, const Inside& inside) {
        const double top = m_in.nu - 1;
        const int x0 = static_cast<int>(clampTo(p.baseU + inside.first * p.scale, top)),
                  x1 = smaller(m_in.nu - 1, static_cast<int>(clampTo(p.baseU + inside.last * p.scale, top)) + 1);
        interpolateRow(x0, x1, clampTo(p.baseV + row * p.scale, m_in.nv - 1), clampTo(w, m_in.nw - 1));
    }

    /// Samples the lines `inside` where they meet the row that was read last: table entries into m_next, and where
    /// voxels may be invalid the shares of valid corners into m_nextShare. Eight at a time; both have room for the last
    /// eight.
    void sampleRow(const RayPlane& p, const Inside& inside) {
        const int count = inside.last - inside.first + 1;
        const Vec8 zero{}, scale = zero + static_cast<float>(p.scale), limit = zero + static_cast<float>(m_in.nu - 1);
        const Int8 top = Int8{} + (m_in.tableSize - 1);
        const Vec8 first = Vec8{0, 1, 2, 3, 4, 5, 6, 7} * scale + static_cast<float>(p.baseU + inside.first * p.scale);
        for (int i = 0; i < count; i += 8) {
            Vec8 u = first + static_cast<float>(i) * scale;
            u = u < zero ? zero : u;
            u = u > limit ? limit : u;
            const Int8 x = __builtin_convertvector(u, Int8);
            const Vec8 f = u - __builtin_convertvector(x, Vec8);
            Vec8 entry = gathered(m_row, x);
            entry += f * (gathered(m_row + 1, x) - entry);
            if (m_in.valid) {
                const float* shares = m_row + m_in.nu + 1;
                Vec8 share = gathered(shares, x);
                share += f * (gathered(shares + 1, x) - share);
                entry = share > zero + kNoShare ? entry / share : zero;
                *reinterpret_cast<Vec8InMemory*>(m_nextShare + i) = share;
            }
            const Int8 next = __builtin_convertvector(entry + 0.5f, Int8);
            *reinterpret_cast<Int8InMemory*>(m_next + i) = next < top ? next : top;
        }
    }

    /// Notes where the lines start from.
    void begin(const RayPlane& p, double w, int row, const Lines& lines) {
        for (int a = 0; a <= lines.last - lines.first; ++a) lines.entry[a] = kOutside;
        const Inside inside = insideAt(p, row, lines);
        if (inside.first > inside.last) return;
        readRow(p, w, row, inside);
        sampleRow(p, inside);
        const int offset = inside.first - lines.first;
        for (int i = 0; i <= inside.last - inside.first; ++i) lines.entry[i + offset] = m_next[i];
        if (!m_in.valid) return;
        for (int i = 0; i <= inside.last - inside.first; ++i) lines.share[i + offset] = m_nextShare[i];
    }

    /// Adds `path` times the mean of τ while the intensity goes linearly from one table entry to another: exact, by the
    /// table's running integral.
    static void addDepth(const Tables& tables, float* depth, int from, int to, float path) {
        const int low = smaller(from, to), high = larger(from, to);
        if (tables.opaqueBefore[high + 1] == tables.opaqueBefore[low]) return; // transparent in every candidate
        // Entries next to each other are averaged by their middle: their integrals differ by less than floats can tell.
        // Selected, not branched: in noisy data nobody could foretell which it will be.
        static constexpr float kNothing[K] = {};
        const bool near = high - low < kNear;
        const float* plus = near ? tables.depth + static_cast<std::ptrdiff_t>((low + high) / 2) * K
                                 : tables.integral + static_cast<std::ptrdiff_t>(high) * K;
        const float* minus = near ? kNothing : tables.integral + static_cast<std::ptrdiff_t>(low) * K;
        const float scale = path / static_cast<float>(near ? 1 : high - low);
        L::store(depth, L::load(depth) + scale * (L::load(plus) - L::load(minus)));
    }

    /// Takes eight lines from `i` on over what is transparent in every candidate, if it is so for all of them.
    bool crossTransparent(const Tables& tables, const Lines& lines, int i, int next) {
        const Int8 entries = *reinterpret_cast<const Int8InMemory*>(lines.entry + i);
        const Int8 now = *reinterpret_cast<const Int8InMemory*>(m_next + next);
        const Int8 last = entries < 0 ? now : entries;
        const Int8 low = last < now ? last : now, high = last < now ? now : last;
        if (!allZero(gathered(tables.opaqueBefore + 1, high) - gathered(tables.opaqueBefore, low))) return false;
        *reinterpret_cast<Int8InMemory*>(lines.entry + i) = now;
        if (m_in.valid)
            for (int k = 0; k < 8; ++k) lines.share[i + k] = m_nextShare[next + k];
        return true;
    }

    /// Adds to the lines what they meet between two planes. Returns `to`.
    template <class Plane>
    double step(const Plane& plane, double from, double to, int row, const Lines& lines) {
        const RayPlane p = plane(to), before = plane(from);
        Inside inside = insideAt(p, row, lines);
        if (inside.first > inside.last) inside = {lines.last + 1, lines.last};
        const float slices = static_cast<float>(to - from);
        const Tables tables{m_in.depthTable, m_in.integralTable, m_in.opaqueBefore};
        const bool someInvalid = m_in.valid != nullptr;
        if (inside.first <= inside.last) {
            readRow(p, to, row, inside);
            sampleRow(p, inside);
        }
        for (int a = inside.first; a <= inside.last; ++a) {
            const int i = a - lines.first, now = m_next[a - inside.first];
            if (((a - inside.first) & 7) == 0 && a + 7 <= inside.last &&
                crossTransparent(tables, lines, i, a - inside.first)) {
                a += 7;
                continue;
            }
            int last = lines.entry[i];
            lines.entry[i] = now;
            if (lines.codes && m_in.featureOfCode[lines.codes[i]] == kTransparent) continue;
            float path = lines.length[i * lines.lengthStep] * slices;
            const bool cameIn = last == kOutside; // through a side, on the way
            if (cameIn) {
                path *= insideShare(p, before, a, row);
                last = now;
            }
            int end = now;
            if (someInvalid) {
                const float share = m_nextShare[a - inside.first], lastShare = cameIn ? share : lines.share[i];
                lines.share[i] = share;
                if (lastShare <= kNoShare) last = now;
                if (share <= kNoShare) end = last;
                path *= 0.5f * (lastShare + share);
            }
            addDepth(tables, lines.depth + i * K, last, end, path);
        }
        const auto leave = [&](int a) { // through a side
            const int i = a - lines.first;
            if (lines.entry[i] == kOutside) return;
            float path = lines.length[i * lines.lengthStep] * slices * insideShare(before, p, a, row);
            if (someInvalid) path *= lines.share[i];
            addDepth(tables, lines.depth + i * K, lines.entry[i], lines.entry[i], path);
            lines.entry[i] = kOutside;
        };
        for (int a = lines.first; a < inside.first; ++a) leave(a);
        for (int a = inside.last + 1; a <= lines.last; ++a) leave(a);
        return to;
    }

    /// The part of a line between two planes that lies inside the sides of the box, where it is inside at `in` and
    /// outside at `out`.
    float insideShare(const RayPlane& in, const RayPlane& out, int a, int row) const {
        const double u0 = in.baseU + a * in.scale, u1 = out.baseU + a * out.scale;
        const double v0 = in.baseV + row * in.scale, v1 = out.baseV + row * out.scale;
        double share = 1;
        const auto cut = [&](double x0, double x1, double size) {
            double t = 1;
            if (x1 < -0.5)
                t = (x0 + 0.5) / (x0 - x1);
            else if (x1 > size - 0.5)
                t = (size - 0.5 - x0) / (x1 - x0);
            share = t < share ? t : share;
        };
        cut(u0, u1, m_in.nu);
        cut(v0, v1, m_in.nv);
        return static_cast<float>(share < 0 ? 0 : share);
    }

    /// m_row[x], x ∈ [x0, x1]: the volume at (x, v, w) as an entry of the depth table; m_row[x1 + 1] repeats the last,
    /// for the ray that ends on it. With invalid voxels: entry·share there, and the share of the valid corners behind.
    void interpolateRow(int x0, int x1, double v, double w) {
        const int v0 = smaller(static_cast<int>(v), larger(0, m_in.nv - 2)),
                  w0 = smaller(static_cast<int>(w), larger(0, m_in.nw - 2));
        const double fv = v - v0, fw = w - w0;
        const double weights[4] = {(1 - fv) * (1 - fw), fv * (1 - fw), (1 - fv) * fw, fv * fw};
        float* row = m_row;
        float* share = m_row + m_in.nu + 1;
        bool fresh = true;
        for (int corner = 0; corner < 4; ++corner) {
            if (weights[corner] < 1e-7) continue; // on a voxel plane: a row less to read
            const int vv = v0 + (corner & 1), ww = w0 + (corner >> 1);
            const std::uint16_t* codes = m_in.codes + vv * m_in.codeStrides.v + ww * m_in.codeStrides.w;
            const float weight = static_cast<float>(weights[corner]), scaled = weight * m_in.tableEntryOfCode;
            if (m_in.valid) {
                const std::uint8_t* valid = m_in.valid + vv * m_in.fieldStrides.v + ww * m_in.fieldStrides.w;
                for (int x = x0; x <= x1; ++x) {
                    const bool good = valid[x * m_in.fieldStrides.u] != 0;
                    row[x] = (fresh ? 0.0f : row[x]) + (good ? scaled * codes[x] : 0.0f);
                    share[x] = (fresh ? 0.0f : share[x]) + (good ? weight : 0.0f);
                }
            } else if (fresh) {
                for (int x = x0; x <= x1; ++x) row[x] = scaled * static_cast<float>(codes[x]);
            } else {
                for (int x = x0; x <= x1; ++x) row[x] += scaled * static_cast<float>(codes[x]);
            }
            fresh = false;
        }
        row[x1 + 1] = row[x1];
        if (m_in.valid) share[x1 + 1] = share[x1];
    }

    // ---- At the voxels -------------------------------------------------------------------------------------------

    void gather(int k) {
        const RayPlane p = rayPlane(k);
        for (int v = 0; v < m_in.nv; ++v) {
            const double b = (v - p.baseV) / p.scale;
            if ((b < m_b0 && !m_band.outermostLow) || (b >= m_b1 && !m_band.outermostHigh)) continue;
            const int row = larger(m_b0, smaller(m_b1 - 1, floorInt(b)));
            const std::uint16_t* codes = m_in.codes + v * m_in.codeStrides.v + k * m_in.codeStrides.w;
            int u0 = 0, u1 = m_in.nu - 1; // what is seen of the row
            while (u0 <= u1 && m_in.featureOfCode[codes[u0]] == kTransparent) ++u0;
            while (u0 <= u1 && m_in.featureOfCode[codes[u1]] == kTransparent) --u1;
            if (u0 > u1) continue;

            // Between the two ray rows first, then along them.
            const double first = (u0 - p.baseU) / p.scale, last = (u1 - p.baseU) / p.scale;
            const int a0 = larger(m_a0, smaller(m_a1 - 1, floorInt(first))),
                      a1 = larger(a0 + 1, smaller(m_a1, floorInt(last) + 1));
            const float fb = static_cast<float>(b - row);
            const float* near = m_rays.depth + rayIndex(a0, row) * K;
            const float* far = m_rays.depth + rayIndex(a0, row + 1) * K;
            for (int i = 0; i <= (a1 - a0); ++i) {
                const V d = L::load(near + i * K);
                L::store(m_gatherRow + i * K, d + fb * (L::load(far + i * K) - d));
            }
            followOwnLines(codes, u0, u1, v, k);
            gatherRow(codes, u0, u1, v, k, static_cast<float>(first - a0), static_cast<float>(1 / p.scale),
                      a1 - a0 - 1);
        }
    }

    /// What the voxels u ∈ [u0, u1] have right in front of them, along lines of their own: surfaces there change so
    /// much from ray to ray that depths between rays would not do.
    void followOwnLines(const std::uint16_t* codes, int u0, int u1, int v, int k) {
        for (int i = 0; i < (u1 - u0 + 1) * K; ++i) m_local.depth[i] = 0.0f;
        if (m_in.ownSlices == 0) return;
        const auto plane = [&](double w) { return voxelPlane(w, k); };
        // Blocks begin at multiples of their size, so that a voxel's line does not depend on what else is seen.
        const int size = blockSize(1 / (k - m_in.eyeW), m_in.nu);
        for (int block = u0 / size; block * size <= u1; ++block) {
            const int first = larger(u0, block * size), last = smaller(u1, (block + 1) * size - 1);
            const double away = k - m_in.eyeW, middle = (block + 0.5) * size;
            const double l = m_in.perspective ? lengthOf((middle - m_in.eyeU) / away, (v - m_in.eyeV) / away)
                                              : lengthOf(m_in.slopeU, m_in.slopeV);
            const float length = static_cast<float>(l);
            const Lines lines{
                first, last, m_local.depth + (first - u0) * K, m_local.entry, m_local.share, &length, 0, codes + first};
            const int start = k - m_in.ownSlices; // where the rays are
            const double from = start < 0 ? -0.5 : start - 0.5 / l;
            begin(plane(from), from, v, lines);
            for (int slice = larger(0, start + 1); slice <= k; ++slice) toSlice(plane, slice, l, v, lines);
        }
    }

    /// Voxels u ∈ [u0, u1] of one row; voxel u0 lies at `first` in m_gatherRow, whose last pair starts at `lastPair`.
    void gatherRow(const std::uint16_t* codes, int u0, int u1, int v, int k, float first, float raysPerVoxel,
                   int lastPair) {
        const std::ptrdiff_t at = v * m_in.fieldStrides.v + k * m_in.fieldStrides.w;
        for (int u = u0; u <= u1; ++u) {
            const std::uint8_t feature = m_in.featureOfCode[codes[u]];
            if (feature == kTransparent) continue;
            const std::ptrdiff_t here = at + u * m_in.fieldStrides.u;
            if (m_in.valid && !m_in.valid[here]) continue;
            const float a = first + static_cast<float>(u - u0) * raysPerVoxel;
            const int i = larger(0, smaller(lastPair, static_cast<int>(a)));
            const float f = a - static_cast<float>(i);
            const V near = L::load(m_gatherRow + i * K);
            const V depth =
                near + f * (L::load(m_gatherRow + (i + 1) * K) - near) + L::load(m_local.depth + (u - u0) * K);
            const V seen = expMinus<V>(depth) * L::load(m_in.alphaTable + static_cast<std::size_t>(codes[u]) * K);
            float* sum = m_accumulator + static_cast<std::size_t>(feature) * 3 * K;
            L::store(sum, L::load(sum) + seen);
            if (m_in.weights[0]) {
                L::store(sum + K, L::load(sum + K) + seen * m_in.weights[0][here]);
                L::store(sum + 2 * K, L::load(sum + 2 * K) + seen * m_in.weights[1][here]);
            }
            if (K == 1 && m_in.field) L::store(m_in.field + here, seen);
        }
    }

    /// Floats hold one slice of a band at most: what they lose stays below 1e-6 of the sum.
    void flush() {
        for (std::size_t i = 0; i < accumulatorSize(); ++i) {
            m_sums[i] += static_cast<double>(m_accumulator[i]);
            m_accumulator[i] = 0.0f;
        }
    }

    const SweepInput& m_in;
    const SweepBand& m_band;
    SweepScratch& m_scratch;
    double* m_sums;
    double m_slopeStep;     ///< perspective: slope between neighbouring rays
    int m_a0 = 0, m_a1 = 0; ///< rays of a row
    int m_b0, m_b1;         ///< rows of rays; m_b1 is the first of the next band
    float* m_accumulator;   ///< [features + 1][3][K]
    float* m_row;           ///< see interpolateRow
    Lines m_rays;           ///< all rows of rays
    Lines m_local;          ///< the voxels of one row
    int* m_next = nullptr;  ///< see sampleRow
    float* m_nextShare = nullptr;
    float* m_gatherRow = nullptr; ///< [ray][K], optical depth between two rows of rays
    float* m_length = nullptr;    ///< [row][ray], d0 per slice
};

} // namespace
} // namespace pellucid
