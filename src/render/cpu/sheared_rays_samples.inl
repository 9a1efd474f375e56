// What eight neighbouring rays meet where they pass a slice: intensities, their gradient, entries of the table.
#pragma once

#include "render/cpu/ray_packets_light.inl"
#include "render/cpu/sheared_rays.h"

namespace pellucid {
namespace {

/// Four numbers at from + 4·x for each x, by number: those of eight entries of RayTable::colors().
inline void entriesAt(const std::int32_t* from, Int8 x, Int8 (&numbers)[4]) {
#ifdef __AVX2__
    alignas(32) int entry[kWide]; // by way of memory: eight moves out of a vector cost more than eight loads
    *reinterpret_cast<__m256i*>(entry) = reinterpret_cast<__m256i>(x);
    __asm__("" : "+m"(entry));     // or the compiler makes moves of it again
    const auto pair = [&](int n) { // of the entries n and n + 4
        const auto at = [&](int i) {
            return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + 4 * static_cast<std::int64_t>(entry[i])));
        };
        return _mm256_inserti128_si256(_mm256_castsi128_si256(at(n)), at(n + 4), 1);
    };
    const __m256i p0 = pair(0), p1 = pair(1), p2 = pair(2), p3 = pair(3);
    const __m256i low01 = _mm256_unpacklo_epi32(p0, p1), high01 = _mm256_unpackhi_epi32(p0, p1),
                  low23 = _mm256_unpacklo_epi32(p2, p3), high23 = _mm256_unpackhi_epi32(p2, p3);
    numbers[0] = reinterpret_cast<Int8>(_mm256_unpacklo_epi64(low01, low23));
    numbers[1] = reinterpret_cast<Int8>(_mm256_unpackhi_epi64(low01, low23));
    numbers[2] = reinterpret_cast<Int8>(_mm256_unpacklo_epi64(high01, high23));
    numbers[3] = reinterpret_cast<Int8>(_mm256_unpackhi_epi64(high01, high23));
#else
    for (int n = 0; n < kWide; ++n)
        for (int c = 0; c < 4; ++c) numbers[c][n] = from[4 * static_cast<std::int64_t>(x[n]) + c];
#endif
}

/// Sixteen neighbours of a row, blended from two or more rows.
struct Window {
    Vec8 low, high;
    Vec8 at(Int8 x, bool narrow) const { ///< x in [0, 16), below 8 where `narrow`
#ifdef __AVX2__
        const __m256i i = reinterpret_cast<__m256i>(x);
        const Vec8 fromLow = reinterpret_cast<Vec8>(_mm256_permutevar8x32_ps(reinterpret_cast<__m256>(low), i));
        if (narrow) return fromLow;
        const Vec8 fromHigh = reinterpret_cast<Vec8>(_mm256_permutevar8x32_ps(reinterpret_cast<__m256>(high), i));
        return x < kWide ? fromLow : fromHigh;
#else
        Vec8 result;
        for (int n = 0; n < kWide; ++n) result[n] = narrow || x[n] < kWide ? low[x[n]] : high[x[n] - kWide];
        return result;
#endif
    }
};

/// Where eight rays pass a slice.
struct Lanes {
    int slice = 0; ///< held within the volume, as are u and v
    int base = 0;  ///< voxel of the first ray, along u
    Int8 index;    ///< voxels along u, from `base` on
    Vec8 fraction; ///< beyond them
    int row = 0;   ///< voxel along v
    float fractionV = 0;
};

template <class Code>
class Slices {
public:
    explicit Slices(const ShearedScene& s) : m_s(s), m_scene(*s.scene) {
        if constexpr (sizeof(Code) == 1)
            m_codes = s.narrowCodes + s.origin;
        else
            m_codes = s.codes + s.origin;
        m_valid = s.valid ? s.valid + s.origin : nullptr;
        for (int a = 0; a < 2; ++a) m_last[a] = __builtin_nextafterf(static_cast<float>(s.dims[a] - 1), 0);
        const int steps[3] = {1, m_scene.blockDims[0], m_scene.blockDims[0] * m_scene.blockDims[1]};
        for (int a = 0; a < 3; ++a) m_blockStep[a] = steps[s.axis[a]];
    }

    int blockStep(int a) const { return m_blockStep[a]; }

    Lanes lanesAt(Vec8 u, float v, int slice) const {
        Lanes lanes;
        const Vec8 in = most(Vec8{}, least(u, all(m_last[0])));
        lanes.base = static_cast<int>(in[0]);
        const Vec8 from = in - static_cast<float>(lanes.base);
        lanes.index = toInt(from);
        lanes.fraction = from - toFloat(lanes.index);
        const float inV = v < 0 ? 0 : (v > m_last[1] ? m_last[1] : v);
        lanes.row = static_cast<int>(inV);
        lanes.fractionV = inV - static_cast<float>(lanes.row);
        lanes.slice = clampTo(slice, 0, m_s.dims[2] - 1);
        return lanes;
    }

    /// Asks for what rays x0 … x1 − 1 of row y will meet in a slice.
    void prefetch(int x0, int x1, int y, int slice) const {
        const float w = static_cast<float>(slice), scale = m_s.scale[0] + w * m_s.scale[1];
        const auto place = [&](int a, int ray) {
            const float at = (m_s.first[a] + static_cast<float>(ray) * m_s.pitch[a]) * scale +
                             (m_s.shift[a][0] + w * m_s.shift[a][1]);
            return clampTo(static_cast<int>(at), 0, m_s.dims[a] - 1);
        };
        constexpr int kLine = 64 / sizeof(Code);
        const Code* const row = m_codes + rowAt(place(1, y), clampTo(slice, 0, m_s.dims[2] - 1));
        const int last = place(0, x1);
        for (int u = place(0, x0); u <= last; u += kLine) {
            const Code* const p = row + u * m_s.along[0];
            __builtin_prefetch(p);
            __builtin_prefetch(p + m_s.along[1]);
        }
    }

    /// Interpolated in the slice; of invalid voxels 0.
    Vec8 codes(const Lanes& l) const { return blended(m_codes, l, l.slice); }
    Vec8 validShare(const Lanes& l) const { return blended(m_valid, l, l.slice); }

    /// Central differences of the interpolated codes over one voxel on each side of places in a slice, along u, v, w.
    void gradient(Vec8 u, float v, int slice, unsigned bits, Vec8 (&g)[3]) const {
        const Lanes l = lanesAt(u, v, slice);
        const int start = l.base - 1, farthest = l.index[kWide - 1] + 3;
        if (m_valid || start < 0 || start + farthest >= m_s.dims[0] || farthest >= 2 * kWide || m_s.along[0] != 1)
            return scatteredGradient(l, bits, g);
        const Code* const here = m_codes + rowAt(l.row, l.slice) + start;
        const auto row = [&](int n) { return m_codes + rowAt(l.row + n, l.slice) + start; };
        const Code *const above = row(-1), *const below = row(1), *const farBelow = row(2);
        const std::int64_t toLast = (larger(0, l.slice - 1) - l.slice) * m_s.along[2],
                           toNext = (smaller(m_s.dims[2] - 1, l.slice + 1) - l.slice) * m_s.along[2];
        // Differences of codes before the rays' own places between them: sixteen neighbours in two halves.
        Window on, alongV, alongW;
        const auto half = [&](int from, Vec8& onRow, Vec8& inV, Vec8& inW) {
            const Int8 first = asInts(here + from), second = asInts(below + from);
            const auto blend = [&](Int8 a, Int8 b) { return toFloat(a) + l.fractionV * toFloat(b - a); };
            onRow = blend(first, second);
            inV = blend(second - asInts(above + from), asInts(farBelow + from) - first);
            inW = blend(asInts(here + toNext + from) - asInts(here + toLast + from),
                        asInts(below + toNext + from) - asInts(below + toLast + from));
        };
        half(0, on.low, alongV.low, alongW.low);
        half(kWide, on.high, alongV.high, alongW.high);
        const Int8 at = l.index + 1;
        const auto between = [&](Vec8 a, Vec8 b) { return 0.5f * (a + l.fraction * (b - a)); };
        const Vec8 left = on.at(at, false), right = on.at(at + 1, false);
        g[0] = between(right - on.at(at - 1, false), on.at(at + 2, false) - left);
        g[1] = between(alongV.at(at, false), alongV.at(at + 1, false));
        g[2] = between(alongW.at(at, false), alongW.at(at + 1, false));
    }

private:
    /// Whether voxels up to `index` from the first ray's on lie side by side in memory, and close enough.
    bool isRow(int index) const { return m_s.along[0] == 1 && index < 2 * kWide - 2; }
    std::int64_t rowAt(int row, int slice) const { ///< held within the volume
        return clampTo(row, 0, m_s.dims[1] - 1) * m_s.along[1] + slice * m_s.along[2];
    }

    template <class T>
    static Window windowAt(const T* p) {
        return {asFloats(p), asFloats(p + kWide)};
    }

    template <class T>
    Vec8 blended(const T* from, const Lanes& l, int slice) const {
        const std::int64_t near = rowAt(l.row, slice), far = near + m_s.along[1];
        const int last = l.index[kWide - 1];
        if (m_s.along[0] != 1) return scattered(from, l, near, far);
        if (!isRow(last)) return ofPairs(from + near + l.base, from + far + l.base, l);
        const T *a = from + near + l.base, *b = from + far + l.base;
        const bool narrow = last < kWide - 1;
        Window w{};
        const Vec8 low = asFloats(a);
        w.low = low + l.fractionV * (asFloats(b) - low);
        if (!narrow) {
            const Vec8 high = asFloats(a + kWide);
            w.high = high + l.fractionV * (asFloats(b + kWide) - high);
        }
        const Vec8 left = w.at(l.index, narrow), right = w.at(l.index + 1, narrow);
        return left + l.fraction * (right - left);
    }
    /// Of rays farther apart.
    template <class T>
    static Vec8 ofPairs(const T* near, const T* far, const Lanes& l) {
        const Int8 a = pairsOfCodes(near, l.index), b = pairsOfCodes(far, l.index);
        const auto between = [&](Int8 low, Int8 high) { return toFloat(low) + l.fractionV * toFloat(high - low); };
        const Vec8 left = between(a & 0xffff, b & 0xffff), right = between(highHalves(a), highHalves(b));
        return left + l.fraction * (right - left);
    }
    static Int8 highHalves(Int8 v) { return reinterpret_cast<Int8>(reinterpret_cast<UInt8>(v) >> 16); }
    /// Of voxels that do not lie side by side.
    template <class T>
    Vec8 scattered(const T* from, const Lanes& l, std::int64_t near, std::int64_t far) const {
        Vec8 left, right;
        for (int n = 0; n < kWide; ++n) {
            const std::int64_t at = (l.base + l.index[n]) * m_s.along[0], beside = at + m_s.along[0];
            const auto along = [&](std::int64_t x) {
                const float a = static_cast<float>(from[near + x]), b = static_cast<float>(from[far + x]);
                return a + l.fractionV * (b - a);
            };
            left[n] = along(at);
            right[n] = along(beside);
        }
        return left + l.fraction * (right - left);
    }

    void scatteredGradient(const Lanes& l, unsigned bits, Vec8 (&g)[3]) const {
        for (Vec8& component : g) component = Vec8{};
        const float v = static_cast<float>(l.row) + l.fractionV;
        for (; bits != 0; bits &= bits - 1) {
            const int n = __builtin_ctz(bits);
            const float u = static_cast<float>(l.base + l.index[n]) + l.fraction[n];
            g[0][n] = 0.5f * (codeAt(u + 1, v, l.slice) - codeAt(u - 1, v, l.slice));
            g[1][n] = 0.5f * (codeAt(u, v + 1, l.slice) - codeAt(u, v - 1, l.slice));
            g[2][n] = 0.5f * (codeAt(u, v, l.slice + 1) - codeAt(u, v, l.slice - 1));
        }
    }
    /// Among the valid voxels, at any place, held within the volume.
    float codeAt(float u, float v, int slice) const {
        const float place[2] = {u, v};
        int at[2];
        float f[2];
        for (int a = 0; a < 2; ++a) {
            const float p = place[a] < 0 ? 0 : (place[a] > m_last[a] ? m_last[a] : place[a]);
            at[a] = static_cast<int>(p);
            f[a] = p - static_cast<float>(at[a]);
        }
        float sum = 0, share = 0;
        for (int corner = 0; corner < 4; ++corner) {
            const std::int64_t i = rowAt(at[1] + (corner >> 1), clampTo(slice, 0, m_s.dims[2] - 1)) +
                                   (at[0] + (corner & 1)) * m_s.along[0];
            if (m_valid && !m_valid[i]) continue;
            const float weight = (corner & 1 ? f[0] : 1 - f[0]) * (corner & 2 ? f[1] : 1 - f[1]);
            sum += weight * static_cast<float>(m_codes[i]);
            share += weight;
        }
        return share > 0 ? sum / share : 0;
    }

    const ShearedScene& m_s;
    const PacketScene& m_scene;
    const Code* m_codes;         ///< of the voxel (0, 0, 0)
    const std::uint8_t* m_valid; ///< likewise, or null
    float m_last[2];             ///< a hair below the last centre, so that the cell is never one too many
    int m_blockStep[3];
};

} // namespace
} // namespace pellucid
