// Where eight rays run and what they meet there: intervals, positions, intensities, blocks.
#pragma once

#include "render/cpu/ray_packets.h"
#include "render/cpu/sweep_vectors.inl"

namespace pellucid {
namespace {

typedef float Vec4 __attribute__((vector_size(16)));
typedef int Int4 __attribute__((vector_size(16)));
typedef std::uint16_t UShort4 __attribute__((vector_size(8)));
typedef Int4 Int4InMemory __attribute__((aligned(4), may_alias));
typedef UShort4 UShort4InMemory __attribute__((aligned(2), may_alias));
typedef unsigned UInt8 __attribute__((vector_size(32)));

constexpr float kNever = 1e30f;

inline Vec8 all(float v) { return Vec8{} + v; }
inline Vec8 least(Vec8 a, Vec8 b) { return a < b ? a : b; }
inline Vec8 most(Vec8 a, Vec8 b) { return a > b ? a : b; }
inline Int8 least(Int8 a, Int8 b) { return a < b ? a : b; }
inline Int8 most(Int8 a, Int8 b) { return a > b ? a : b; }
inline Vec8 positive(Vec8 v) { return v < 0 ? -v : v; }

inline Vec8 squareRoot(Vec8 v) {
#ifdef __AVX2__
    return reinterpret_cast<Vec8>(_mm256_sqrt_ps(reinterpret_cast<__m256>(v)));
#else
    Vec8 r;
    for (int n = 0; n < kWide; ++n) r[n] = __builtin_sqrtf(v[n]);
    return r;
#endif
}

inline float lowest(Vec8 v) {
    const Vec4 low{v[0], v[1], v[2], v[3]}, high{v[4], v[5], v[6], v[7]}, a = low < high ? low : high;
    const float x = a[0] < a[1] ? a[0] : a[1], y = a[2] < a[3] ? a[2] : a[3];
    return x < y ? x : y;
}
inline float highest(Vec8 v) { return -lowest(-v); }

/// The 32 bits at from + 2·x bytes for each x: a pair of codes.
inline Int8 pairsOfCodes(const std::uint16_t* from, Int8 x) {
#ifdef __AVX2__
    return reinterpret_cast<Int8>(
        _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), reinterpret_cast<__m256i>(x), 2));
#else
    Int8 pairs;
    for (int n = 0; n < kWide; ++n) __builtin_memcpy(&pairs[n], from + x[n], sizeof(int));
    return pairs;
#endif
}

/// The same of codes of 8 bits: two more may be read behind each pair.
inline Int8 pairsOfCodes(const std::uint8_t* from, Int8 x) {
#ifdef __AVX2__
    const Int8 four = reinterpret_cast<Int8>(
        _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), reinterpret_cast<__m256i>(x), 1));
    return (four & 0xff) | ((four & 0xff00) << 8);
#else
    Int8 pairs;
    for (int n = 0; n < kWide; ++n) pairs[n] = from[x[n]] | from[x[n] + 1] << 16;
    return pairs;
#endif
}

/// The byte at from + x for each x; three more may be read behind it.
inline Int8 bytesAt(const std::uint8_t* from, Int8 x) {
#ifdef __AVX2__
    return reinterpret_cast<Int8>(
               _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), reinterpret_cast<__m256i>(x), 1)) &
           255;
#else
    Int8 bytes;
    for (int n = 0; n < kWide; ++n) bytes[n] = from[x[n]];
    return bytes;
#endif
}

/// Eight rays: point + u·step for u in [0, count], u counting samples.
struct Rays {
    Vec8 point[3], step[3], perStep[3]; ///< voxels; perStep = 1/step, finite
    Vec8 count;                         ///< 0: meets nothing
    Vec8 shift;                         ///< sample n lies at u = n + shift, held in [0, count]
    Vec8 view[3];                       ///< unit vector toward the viewer: right, up, backward
    Vec8 depth, depthPerStep;           ///< of `point`, and what a step adds
    Vec8 clearFrom, clearTo;            ///< u between which nothing is faint
};

/// Takes of an interval of depths what lies within planes, where points are at `point` + t·`direction`.
inline void cut(const PacketPlane* planes, int count, const Vec8 (&point)[3], const Vec8 (&direction)[3], Vec8& enter,
                Vec8& exit) {
    for (int p = 0; p < count; ++p) {
        const PacketPlane& plane = planes[p];
        Vec8 away = Vec8{}, room = all(plane.offset);
        for (int a = 0; a < 3; ++a) {
            away += plane.normal[a] * direction[a];
            room -= plane.normal[a] * point[a];
        }
        const Vec8 t = room / away;
        enter = away < 0 ? most(enter, t) : enter;
        exit = away > 0 ? least(exit, t) : exit;
        exit = (away == 0) & (room < 0) ? all(-kNever) : exit;
    }
}

/// What of its own a path from u to v keeps where there are PacketScene::faintPlanes.
inline Vec8 thinned(float density, Vec8 clearFrom, Vec8 clearTo, Vec8 u, Vec8 v) {
    const Vec8 length = most(v - u, all(1e-6f)), within = least(v, clearTo) - most(u, clearFrom);
    return density + (1 - density) * least(all(1), most(Vec8{}, within / length));
}
inline Vec8 thinned(const PacketScene& s, const Rays& r, Vec8 u, Vec8 v) {
    return thinned(s.faintDensity, r.clearFrom, r.clearTo, u, v);
}

inline Vec8 hashOf(Int8 x, Int8 y) { ///< in [0, 1)
    UInt8 h = reinterpret_cast<UInt8>(x) * 0x9E3779B1u + reinterpret_cast<UInt8>(y) * 0x85EBCA77u;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    h ^= h >> 15;
    return toFloat(reinterpret_cast<Int8>(h >> 8)) * (1.0f / (1 << 24));
}

inline Rays raysOf(const PacketScene& s, Int8 x, Int8 y) {
    const PacketCamera& c = s.camera;
    const Vec8 px = toFloat(x) + (0.5f - c.middle[0]), py = toFloat(y) + (0.5f - c.middle[1]);
    Rays r;
    const Vec8 right = px * c.slope[0], down = py * c.slope[1]; // world units per unit of depth
    const Vec8 length = squareRoot(1.0f + right * right + down * down), perLength = 1.0f / length;
    r.view[0] = -right * perLength;
    r.view[1] = down * perLength;
    r.view[2] = perLength;
    Vec8 point[3], direction[3];
    for (int a = 0; a < 3; ++a) {
        point[a] = c.point[a] + px * c.pointBy[0][a] + py * c.pointBy[1][a];
        direction[a] = c.direction[a] + px * c.directionBy[0][a] + py * c.directionBy[1][a];
    }
    Vec8 enter = all(c.nearest), exit = all(kNever);
    cut(s.planes, s.planeCount, point, direction, enter, exit);
    const Int8 inPicture = (x < s.width) & (y < s.height);
    if (s.groundDepth) {
        for (int n = 0; n < kWide; ++n) {
            if (!inPicture[n]) continue;
            const float ground = s.groundDepth[static_cast<std::int64_t>(y[n]) * s.width + x[n]];
            exit[n] = exit[n] < ground ? exit[n] : ground;
        }
    }
    r.depthPerStep = s.step / length;
    r.count = (enter < exit) & inPicture ? (exit - enter) / r.depthPerStep : Vec8{};
    enter = r.count > 0 ? enter : Vec8{};
    r.depth = enter;
    for (int a = 0; a < 3; ++a) {
        r.point[a] = point[a] + enter * direction[a];
        r.step[a] = direction[a] * r.depthPerStep;
        r.perStep[a] = 1.0f / (positive(r.step[a]) > 1e-12f ? r.step[a] : all(1e-12f));
    }
    r.clearFrom = all(-kNever);
    r.clearTo = all(kNever);
    if (s.faintCount > 0) {
        Vec8 from = all(-kNever), to = all(kNever);
        cut(s.faintPlanes, s.faintCount, point, direction, from, to);
        r.clearFrom = (from - enter) / r.depthPerStep;
        r.clearTo = (to - enter) / r.depthPerStep;
    }
    r.shift = s.jitter ? hashOf(x, y) - 1.0f : Vec8{};
    return r;
}

/// Interpolated intensities. An invalid voxel has opacity 0, which interpolation carries on (see trilinear.h).
struct Intensity {
    Vec8 code;  ///< [0, 65535]
    Vec8 share; ///< weight of the valid corners; 1 where all voxels are valid
};

/// Cells around positions: the voxel below, and how far beyond it.
struct Cells {
    Int8 at[3];
    Vec8 fraction[3];
};

class Samples {
public:
    explicit Samples(const PacketScene& s)
        : m_s(s), m_codes(s.codes ? s.codes + s.middleVoxel : nullptr),
          m_narrow(s.codes ? nullptr : s.narrowCodes + s.middleVoxel),
          m_valid(s.valid ? s.valid + s.middleVoxel : nullptr) {
        for (int a = 0; a < 3; ++a) {
            // A hair below the last centre, so that the cell is never one too many.
            const float last = static_cast<float>(s.dims[a] - 1);
            m_last[a] = s.dims[a] > 1 ? last * (1 - 1e-7f) : 0;
            if (m_last[a] >= last && s.dims[a] > 1) m_last[a] = __builtin_nextafterf(last, 0);
        }
        m_alongY = s.dims[1] > 1 ? s.dims[0] : 0;
        m_alongZ = s.dims[2] > 1 ? static_cast<std::int64_t>(s.dims[0]) * s.dims[1] : 0;
    }

    Cells cellsAt(const Vec8 (&position)[3]) const {
        Cells c;
        for (int a = 0; a < 3; ++a) {
            const Vec8 p = most(Vec8{}, least(position[a], all(m_last[a])));
            c.at[a] = toInt(p);
            c.fraction[a] = p - toFloat(c.at[a]);
        }
        return c;
    }
    Int8 indexOf(const Cells& c) const { ///< relative to the middle voxel
        return ((c.at[2] - m_s.middleSlice) * m_s.dims[1] + c.at[1]) * m_s.dims[0] + c.at[0];
    }

    template <bool kInvalid>
    Intensity intensityIn(const Cells& c) const {
        const Int8 index = indexOf(c);
        if constexpr (kInvalid) return withInvalid(c, index);
        return m_codes ? among(m_codes, c, index) : among(m_narrow, c, index);
    }

    /// The codes at index − 1 … index + 2, relative to the middle voxel.
    Vec4 rowAround(std::int64_t index) const {
        if (!m_codes) {
            const std::uint8_t* p = m_narrow + index - 1;
            const Int4 row{p[0], p[1], p[2], p[3]};
            return __builtin_convertvector(row, Vec4);
        }
        const UShort4 row = *reinterpret_cast<const UShort4InMemory*>(m_codes + index - 1);
        return __builtin_convertvector(__builtin_convertvector(row, Int4), Vec4);
    }
    std::int64_t alongY() const { return m_alongY; }
    std::int64_t alongZ() const { return m_alongZ; }

    /// One intensity at any position, beyond the centres too.
    float codeAt(float x, float y, float z) const {
        const float position[3] = {x, y, z};
        int at[3];
        float f[3];
        for (int a = 0; a < 3; ++a) {
            const float p = position[a] < 0 ? 0 : (position[a] > m_last[a] ? m_last[a] : position[a]);
            at[a] = static_cast<int>(p);
            f[a] = p - static_cast<float>(at[a]);
        }
        const std::int64_t index =
            (static_cast<std::int64_t>(at[2] - m_s.middleSlice) * m_s.dims[1] + at[1]) * m_s.dims[0] + at[0];
        float sum = 0, share = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const std::int64_t i = index + (corner & 1 && m_s.dims[0] > 1 ? 1 : 0) + (corner & 2 ? m_alongY : 0) +
                                   (corner & 4 ? m_alongZ : 0);
            if (m_valid && !m_valid[i]) continue;
            const float w =
                (corner & 1 ? f[0] : 1 - f[0]) * (corner & 2 ? f[1] : 1 - f[1]) * (corner & 4 ? f[2] : 1 - f[2]);
            sum += w * codeOf(i);
            share += w;
        }
        return share > 0 ? sum / share : 0;
    }

private:
    float codeOf(std::int64_t index) const { return static_cast<float>(m_codes ? m_codes[index] : m_narrow[index]); }
    template <class Code>
    Intensity among(const Code* codes, const Cells& c, Int8 index) const {
        const Int8 low = pairsOfCodes(codes, index), up = pairsOfCodes(codes + m_alongY, index),
                   far = pairsOfCodes(codes + m_alongZ, index),
                   farUp = pairsOfCodes(codes + m_alongZ + m_alongY, index);
        const Vec8 near2 = mix(alongX(low, c.fraction[0]), alongX(up, c.fraction[0]), c.fraction[1]),
                   far2 = mix(alongX(far, c.fraction[0]), alongX(farUp, c.fraction[0]), c.fraction[1]);
        return {mix(near2, far2, c.fraction[2]), all(1)};
    }

    static Vec8 mix(Vec8 a, Vec8 b, Vec8 f) { return a + f * (b - a); }
    static Vec8 alongX(Int8 pair, Vec8 f) {
        const Vec8 low = toFloat(pair & 0xffff),
                   high = toFloat(reinterpret_cast<Int8>(reinterpret_cast<UInt8>(pair) >> 16));
        return mix(low, high, f);
    }

    Intensity withInvalid(const Cells& c, Int8 index) const {
        Intensity result{Vec8{}, Vec8{}};
        for (int n = 0; n < kWide; ++n) {
            const float fx = c.fraction[0][n], fy = c.fraction[1][n], fz = c.fraction[2][n];
            float sum = 0, share = 0;
            for (int corner = 0; corner < 8; ++corner) {
                const std::int64_t i = index[n] + (corner & 1 && m_s.dims[0] > 1 ? 1 : 0) +
                                       (corner & 2 ? m_alongY : 0) + (corner & 4 ? m_alongZ : 0);
                if (!m_valid[i]) continue;
                const float w = (corner & 1 ? fx : 1 - fx) * (corner & 2 ? fy : 1 - fy) * (corner & 4 ? fz : 1 - fz);
                sum += w * codeOf(i);
                share += w;
            }
            result.code[n] = share > 0 ? sum / share : 0;
            result.share[n] = share;
        }
        return result;
    }

    const PacketScene& m_s;
    const std::uint16_t* m_codes; ///< of the middle voxel; null where the codes are narrow
    const std::uint8_t* m_narrow;
    const std::uint8_t* m_valid;
    float m_last[3];
    std::int64_t m_alongY, m_alongZ;
};

/// Colours of voxels, where they do not come from the transfer function.
class VoxelColorSamples {
public:
    VoxelColorSamples(const PacketScene& s, const Samples& samples)
        : m_colors(s.voxelColors ? s.voxelColors + s.middleVoxel : nullptr),
          m_valid(s.valid ? s.valid + s.middleVoxel : nullptr),
          m_samples(samples), m_along{s.dims[0] > 1 ? 1 : 0, samples.alongY(), samples.alongZ()} {}

    /// Straight colours of the lanes in `bits`, interpolated over the valid voxels.
    void at(const Vec8 (&position)[3], unsigned bits, Vec4 (&rgb)[kWide]) const {
        const Cells c = m_samples.cellsAt(position);
        const Int8 index = m_samples.indexOf(c);
        for (; bits != 0; bits &= bits - 1) {
            const int n = __builtin_ctz(bits);
            const float f[3] = {c.fraction[0][n], c.fraction[1][n], c.fraction[2][n]};
            rgb[n] = m_valid ? amongValid(index[n], f) : among(index[n], f);
        }
    }

private:
    Vec4 voxel(std::int64_t i) const {
        const std::uint32_t v = m_colors[i];
        const Int4 channels{static_cast<int>(v & 255u), static_cast<int>(v >> 8 & 255u),
                            static_cast<int>(v >> 16 & 255u), 0};
        return __builtin_convertvector(channels, Vec4) * (1 / 255.0f);
    }
    Vec4 among(std::int64_t i, const float (&f)[3]) const {
        const auto alongX = [&](std::int64_t p) {
            const Vec4 low = voxel(p);
            return low + f[0] * (voxel(p + m_along[0]) - low);
        };
        const auto alongY = [&](std::int64_t p) {
            const Vec4 low = alongX(p);
            return low + f[1] * (alongX(p + m_along[1]) - low);
        };
        const Vec4 low = alongY(i);
        return low + f[2] * (alongY(i + m_along[2]) - low);
    }
    Vec4 amongValid(std::int64_t index, const float (&f)[3]) const {
        Vec4 sum{};
        float share = 0;
        for (int corner = 0; corner < 8; ++corner) {
            std::int64_t i = index;
            float w = 1;
            for (int a = 0; a < 3; ++a) {
                const bool high = corner >> a & 1;
                i += high ? m_along[a] : 0;
                w *= high ? f[a] : 1 - f[a];
            }
            if (!m_valid[i]) continue;
            sum += w * voxel(i);
            share += w;
        }
        return share > 0 ? sum / share : sum;
    }

    const std::uint32_t* m_colors; ///< of the middle voxel
    const std::uint8_t* m_valid;
    const Samples& m_samples;
    std::int64_t m_along[3];
};

/// How many whole steps rays at `position`, in the cells `c`, can go before any leaves what may be passed over around
/// it; 0 where one is in a block that may not. `distanceOf(block)`, by the blocks' indices, is how many blocks off the
/// next one is that may not. Rays that are `done` do not ask.
template <class Distance>
int stepsThrough(const PacketScene& s, const Rays& r, const Vec8 (&position)[3], const Cells& c, Vec8 u, Int8 done,
                 const Distance& distanceOf) {
    Int8 block[3];
    for (int a = 0; a < 3; ++a) block[a] = c.at[a] >> kRayBlockShift;
    const Int8 distance = distanceOf((block[2] * s.blockDims[1] + block[1]) * s.blockDims[0] + block[0]);
    if (!none(~done & (distance == 0))) return 0;
    Vec8 room = all(kNever);
    for (int a = 0; a < 3; ++a) {
        const Vec8 low = toFloat((block[a] - distance + 1) << kRayBlockShift),
                   high = toFloat((block[a] + distance) << kRayBlockShift);
        room = least(room, ((r.step[a] < 0 ? low : high) - position[a]) * r.perStep[a]);
    }
    room = done | (r.count - u <= room) ? all(65536) : room; // it ends before
    return static_cast<int>(lowest(room) - 0.01f);           // rounding leaves it inside
}
inline int stepsToLeap(const PacketScene& s, const Rays& r, const Vec8 (&position)[3], const Cells& c, Vec8 u) {
    return stepsThrough(s, r, position, c, u, u >= r.count,
                        [&](Int8 block) { return bytesAt(s.blockDistance, block); });
}

} // namespace
} // namespace pellucid
