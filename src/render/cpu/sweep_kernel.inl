// The sweep itself (see sweep.h). Included by one .cpp per instruction set; everything here is in an unnamed namespace
// and uses no templates of the standard library, so that no code compiled for a newer processor leaks into the rest.
#include "render/cpu/sweep.h"

namespace pellucid {
namespace {

typedef float Vec8 __attribute__((vector_size(32)));
typedef float Vec8InMemory __attribute__((vector_size(32), aligned(4), may_alias)); // rows of floats, not aligned to 32
typedef int Int8 __attribute__((vector_size(32)));

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
    static constexpr int kBlock = 32; ///< rays that share their sample planes where rays diverge

public:
    Band(const SweepInput& in, const SweepBand& band, SweepScratch& scratch, double* sums)
        : m_in(in), m_band(band), m_scratch(scratch), m_sums(sums), m_slopeStep(in.firstSlopeStep), m_b0(band.first),
          m_b1(band.last) {
        m_accumulator = scratch.floats(0, accumulatorSize());
        for (std::size_t i = 0; i < accumulatorSize(); ++i) m_accumulator[i] = 0.0f;
        m_row = scratch.floats(1, 2 * (static_cast<std::size_t>(in.nu) + 1));
        startGrid(0);
        for (std::size_t i = 0; i < rays() * K; ++i) m_depth[i] = 0.0f;
    }

    void run() {
        for (int k = 0; k < m_in.nw; ++k) {
            if (m_in.perspective && m_slopeStep * (k - m_in.eyeW) > m_in.maxRaySpacing) refineRays(k);
            advance(k);
            gather(k);
            flush();
        }
    }

private:
    // ---- The ray grid --------------------------------------------------------------------------------------------

    RayPlane plane(double w) const {
        if (m_in.perspective) return {m_in.eyeU, m_in.eyeV, m_slopeStep * (w - m_in.eyeW)};
        return {m_in.slopeU * w, m_in.slopeV * w, m_in.raySpacing};
    }
    std::size_t rays() const {
        return static_cast<std::size_t>(m_a1 - m_a0 + 1) * static_cast<std::size_t>(m_b1 - m_b0 + 1);
    }
    std::size_t rowRays() const { return static_cast<std::size_t>(m_a1 - m_a0 + 1); }
    float* depthRow(int b) { return m_depth + static_cast<std::size_t>(b - m_b0) * rowRays() * K; }
    std::size_t accumulatorSize() const { return static_cast<std::size_t>(m_in.features + 1) * 3 * K; }

    /// Chooses the rays that voxels of slices ≥ k will ask for, and lays out their memory (the slot alternates, so that
    /// the old grid can still be read).
    void startGrid(int k) {
        double lo = 1e30, hi = -1e30;
        for (int end = 0; end < 2; ++end) { // positions are monotone in w: the extremes are at the ends
            const RayPlane p = plane(end == 0 ? k : m_in.nw - 1);
            const double first = (0 - p.baseU) / p.scale, last = (m_in.nu - 1 - p.baseU) / p.scale;
            lo = first < lo ? first : lo;
            hi = last > hi ? last : hi;
        }
        m_a0 = floorInt(lo);
        m_a1 = floorInt(hi) + 1;
        m_slot = m_slot == 2 ? 3 : 2;
        m_depth = m_scratch.floats(m_slot, rays() * K);
        m_gatherRow = m_scratch.floats(4, rowRays() * K);
        m_length = m_scratch.floats(5, rays());
        const int blocks = blockCount() * (m_b1 - m_b0 + 1);
        m_offset = m_scratch.floats(6, static_cast<std::size_t>(blocks));
        m_samples = m_scratch.ints(0, static_cast<std::size_t>(blocks));
        measureRays();
    }

    int blockSize() const { return m_in.perspective ? kBlock : m_a1 - m_a0 + 1; }
    int blockCount() const { return (m_a1 - m_a0 + blockSize()) / blockSize(); }

    /// Length of a ray between two slices, in d0.
    double lengthPerSlice(int a, int b) const {
        const double su = m_in.perspective ? a * m_slopeStep : m_in.slopeU,
                     sv = m_in.perspective ? b * m_slopeStep : m_in.slopeV;
        return __builtin_sqrt(m_in.hw * m_in.hw + su * m_in.hu * su * m_in.hu + sv * m_in.hv * sv * m_in.hv);
    }

    /// Per ray the length between slices, per block the number of samples in it and how far in front of a slice (in
    /// slices) lies the point that is d0/2 away from it. Both are constant along a ray.
    void measureRays() {
        for (int b = m_b0; b <= m_b1; ++b) {
            float* length = m_length + static_cast<std::size_t>(b - m_b0) * rowRays();
            for (int a = m_a0; a <= m_a1; ++a) length[a - m_a0] = static_cast<float>(lengthPerSlice(a, b));
            for (int block = 0; block < blockCount(); ++block) {
                const int middle = smaller(m_a0 + block * blockSize() + blockSize() / 2, m_a1);
                const double l = lengthPerSlice(middle, b);
                const int at = (b - m_b0) * blockCount() + block;
                m_offset[at] = static_cast<float>(0.5 / l);
                m_samples[at] = larger(1, ceilInt(l / m_in.maxStep - 1e-6));
            }
        }
    }

    /// Twice as many rays each way; new ones take the depth that their neighbours have between them.
    void refineRays(int k) {
        const float* old = m_depth;
        const int oldA0 = m_a0, oldB0 = m_b0, oldA1 = m_a1, oldB1 = m_b1;
        const std::size_t oldRow = rowRays();
        m_slopeStep *= 0.5;
        m_b0 *= 2;
        m_b1 *= 2;
        startGrid(k);
        for (int b = m_b0; b <= m_b1; ++b)
            for (int a = m_a0; a <= m_a1; ++a) {
                const int al = larger(oldA0, smaller(oldA1, a >> 1)), ah = larger(oldA0, smaller(oldA1, (a + 1) >> 1));
                const int bl = smaller(oldB1, b >> 1), bh = smaller(oldB1, (b + 1) >> 1);
                const auto at = [&](int aa, int bb) {
                    return L::load(
                        old +
                        (static_cast<std::size_t>(bb - oldB0) * oldRow + static_cast<std::size_t>(aa - oldA0)) * K);
                };
                L::store(depthRow(b) + static_cast<std::size_t>(a - m_a0) * K,
                         0.25f * ((at(al, bl) + at(ah, bl)) + (at(al, bh) + at(ah, bh))));
            }
    }

    // ---- Along the rays ------------------------------------------------------------------------------------------

    /// Takes every ray from d0/2 in front of slice k − 1 (the first time: from where it enters the box) to d0/2 in
    /// front of slice k.
    void advance(int k) {
        for (int b = m_b0; b <= m_b1; ++b)
            for (int block = 0; block < blockCount(); ++block) {
                const int at = (b - m_b0) * blockCount() + block;
                const int first = m_a0 + block * blockSize(), last = smaller(first + blockSize() - 1, m_a1);
                const double end = k - static_cast<double>(m_offset[at]);
                const double span = k == 0 ? end + 0.5 : 1.0; // in slices
                if (span < 1e-6) continue;
                const int samples = k == 0 ? larger(1, ceilInt(m_samples[at] * span)) : m_samples[at];
                for (int s = 0; s < samples; ++s)
                    sample(b, first, last, end - span * (s + 0.5) / samples, static_cast<float>(span / samples));
            }
    }

    /// Adds to the rays a ∈ [first, last] of row b what they meet at the plane w, over `share` of a slice distance.
    void sample(int b, int first, int last, double w, float share) {
        const RayPlane p = plane(w);
        const double v = p.baseV + b * p.scale;
        if (v < -0.5 || v > m_in.nv - 0.5) return;
        const int a0 = larger(first, ceilInt((-0.5 - p.baseU) / p.scale)),
                  a1 = smaller(last, floorInt((m_in.nu - 0.5 - p.baseU) / p.scale));
        if (a0 > a1) return;
        const double top = m_in.nu - 1;
        const int x0 = static_cast<int>(clampTo(p.baseU + a0 * p.scale, top)),
                  x1 = smaller(m_in.nu - 1, static_cast<int>(clampTo(p.baseU + a1 * p.scale, top)) + 1);
        interpolateRow(x0, x1, clampTo(v, m_in.nv - 1), clampTo(w, m_in.nw - 1));

        float* depth = depthRow(b) + static_cast<std::size_t>(a0 - m_a0) * K;
        const float* length = m_length + static_cast<std::size_t>(b - m_b0) * rowRays() + (a0 - m_a0);
        const float scale = static_cast<float>(p.scale), base = static_cast<float>(p.baseU + a0 * p.scale),
                    limit = static_cast<float>(top);
        const float* share01 = m_in.valid ? m_row + m_in.nu + 1 : nullptr;
        for (int a = 0; a <= a1 - a0; ++a, depth += K) {
            float u = base + static_cast<float>(a) * scale;
            u = u < 0 ? 0 : (u > limit ? limit : u);
            const int x = static_cast<int>(u);
            const float f = u - static_cast<float>(x);
            float entry = m_row[x] + f * (m_row[x + 1] - m_row[x]);
            float path = length[a] * share;
            if (share01) {
                const float validShare = share01[x] + f * (share01[x + 1] - share01[x]);
                if (validShare <= 0) continue;
                entry /= validShare;
                path *= validShare;
            }
            const int index = smaller(m_in.tableSize - 1, static_cast<int>(entry + 0.5f));
            L::store(depth, L::load(depth) + path * L::load(m_in.depthTable + static_cast<std::size_t>(index) * K));
        }
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
        const RayPlane p = plane(k);
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
            const float* near = depthRow(row) + static_cast<std::size_t>(a0 - m_a0) * K;
            const float* far = depthRow(row + 1) + static_cast<std::size_t>(a0 - m_a0) * K;
            for (int i = 0; i <= (a1 - a0); ++i) {
                const V d = L::load(near + i * K);
                L::store(m_gatherRow + i * K, d + fb * (L::load(far + i * K) - d));
            }
            gatherRow(codes, u0, u1, v, k, static_cast<float>(first - a0), static_cast<float>(1 / p.scale),
                      a1 - a0 - 1);
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
            const V depth = near + f * (L::load(m_gatherRow + (i + 1) * K) - near);
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
    int m_slot = 3;
    float* m_accumulator;         ///< [features + 1][3][K]
    float* m_row;                 ///< see interpolateRow
    float* m_depth = nullptr;     ///< [row][ray][K], optical depth
    float* m_gatherRow = nullptr; ///< [ray][K], optical depth between two rows of rays
    float* m_length = nullptr;    ///< [row][ray], d0 per slice
    float* m_offset = nullptr;    ///< [row][block], see measureRays
    int* m_samples = nullptr;     ///< [row][block]
};

} // namespace
} // namespace pellucid
