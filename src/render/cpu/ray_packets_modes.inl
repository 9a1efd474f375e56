// The modes that do not composite along the ray: the greatest, smallest and mean intensity, and surfaces
// (docs/method.md, "The picture").
#pragma once

#include "render/cpu/ray_packets_light.inl"

namespace pellucid {
namespace {

/// Premultiplied.
struct Colors {
    Vec4 rgb[kWide];
};
/// What a packet ends with.
struct Gathered {
    Colors color;
    Vec8 clear; ///< transmittance
};

/// Samples between two looks at the blocks, where rays are in one that is not passed over.
constexpr int kRun = 4;
/// What a ray has gathered up to this opacity is lit as one: half an 8-bit level.
constexpr float kLitAtOnce = 1.0f / 512;

inline Vec8 placeOf(const Rays& r, float n) { return most(Vec8{}, least(n + r.shift, r.count)); }
inline void positionAt(const Rays& r, Vec8 u, Vec8 (&position)[3]) {
    for (int a = 0; a < 3; ++a) position[a] = r.point[a] + u * r.step[a];
}
/// One more than the last sample that any ray has.
inline float endOf(const Rays& r) { return highest(r.count - r.shift); }

/// Mip, MinIp and Average.
template <bool kInvalid>
class Grey {
public:
    Grey(const PacketScene& s, const Samples& samples, const Rays& rays) : m_s(s), m_samples(samples), m_rays(rays) {}

    Gathered run() {
        const float end = endOf(m_rays);
        if (!(highest(m_rays.count) > 0)) return {{}, all(1)};
        for (float n = 0; n < end + 1; n += 1) {
            const Vec8 u = placeOf(m_rays, n);
            Vec8 position[3];
            positionAt(m_rays, u, position);
            const Cells cells = m_samples.cellsAt(position);
            if (m_s.leap && m_s.mode != PacketMode::Average) {
                const Int8 done = placeOf(m_rays, n - 1) >= m_rays.count; // its last sample has been taken
                const int leap = stepsThrough(m_s, m_rays, position, cells, u, done, [&](Int8 block) {
                    return unchanged(gathered(m_s.blockRange, block)) & 1;
                });
                if (leap > 1) { // this sample is passed over, and the next ones
                    n += static_cast<float>(leap - 1);
                    continue;
                }
            }
            add(m_samples.intensityIn<kInvalid>(cells), placeOf(m_rays, n + 1) - placeOf(m_rays, n - 1));
        }
        return result();
    }

private:
    /// Whether codes of a range, low and high in 16 bits each, change nothing; by element.
    Int8 unchanged(Int8 range) const {
        const Vec8 low = toFloat(range & 0xffff),
                   high = toFloat(reinterpret_cast<Int8>(reinterpret_cast<UInt8>(range) >> 16));
        const Int8 hidden = (high < m_s.lowestShown) | (low >= m_s.highestShown);
        return hidden | (m_s.mode == PacketMode::Mip ? high <= m_best : low >= m_best);
    }

    void add(const Intensity& i, Vec8 weight) {
        const Int8 counts = (i.code >= m_s.lowestShown) & (i.code < m_s.highestShown) & (i.share > 0);
        if (m_s.mode == PacketMode::Average) {
            m_sum += counts ? weight * i.code : Vec8{};
            m_weight += counts ? weight : Vec8{};
        } else if (m_s.mode == PacketMode::Mip) {
            m_best = counts ? most(m_best, i.code) : m_best;
        } else {
            m_best = counts ? least(m_best, i.code) : m_best;
        }
    }
    Gathered result() const {
        Vec8 code = m_best;
        Int8 any = m_best != worst();
        if (m_s.mode == PacketMode::Average) {
            any = m_weight > 0;
            code = m_sum / (any ? m_weight : all(1));
        }
        any &= m_rays.count > 0;
        Gathered g{{}, any ? Vec8{} : all(1)};
        for (int n = 0; n < kWide; ++n)
            if (any[n]) g.color.rgb[n] = Vec4{} + code[n] * m_s.intensityOfCode;
        return g;
    }
    Vec8 worst() const { return all(m_s.mode == PacketMode::Mip ? -1.0f : 70000.0f); }

    const PacketScene& m_s;
    const Samples& m_samples;
    const Rays& m_rays;
    Vec8 m_best = worst(), m_sum = Vec8{}, m_weight = Vec8{};
};

/// Each feature once per ray, where the intensity first enters its interval.
template <bool kInvalid>
class FirstHits {
public:
    FirstHits(const PacketScene& s, const Samples& samples, const Rays& rays)
        : m_s(s), m_samples(samples), m_lighting(s, samples), m_voxelColors(s, samples), m_rays(rays) {}

    Gathered run() {
        const float end = endOf(m_rays);
        if (!(highest(m_rays.count) > 0)) return {m_color, m_clear};
        bool known = false;
        Met last{};
        for (float n = 0; n < end;) {
            Vec8 u = placeOf(m_rays, n);
            Vec8 position[3];
            positionAt(m_rays, u, position);
            Cells cells = m_samples.cellsAt(position);
            if (m_s.leap) {
                const int leap = stepsToLeap(m_s, m_rays, position, cells, u);
                if (leap > 0) {
                    n += static_cast<float>(leap);
                    known = false;
                    continue;
                }
            }
            if (!known) {
                last = meet(u, cells);
                if (n == 0) pass(last, last);
            }
            known = true;
            n += 1;
            u = placeOf(m_rays, n);
            positionAt(m_rays, u, position);
            const Met next = meet(u, m_samples.cellsAt(position));
            pass(last, next);
            last = next;
            if (none((m_clear >= kDark) & (m_rays.count > u))) break;
        }
        return {m_color, m_clear};
    }

private:
    struct Met {
        Vec8 u, code, share;
        Int8 integral;
    };
    Met meet(Vec8 u, const Cells& cells) const {
        const Intensity i = m_samples.intensityIn<kInvalid>(cells);
        return {u, i.code, i.share, gathered(m_s.integral, cellOf(i.code))};
    }

    Int8 cellOf(Vec8 code) const { return toInt(code * m_s.cellOfCode + 0.5f); }

    /// The hits between two samples.
    void pass(Met last, Met next) {
        if constexpr (kInvalid) {
            last.code = last.share > 0 ? last.code : next.code;
            next.code = next.share > 0 ? next.code : last.code;
            const Int8 shown = (last.share > 0) | (next.share > 0);
            m_shown = shown;
            last.integral = gathered(m_s.integral, cellOf(last.code));
            next.integral = gathered(m_s.integral, cellOf(next.code));
        }
        const Int8 some = ((next.integral ^ last.integral) | ((next.integral | last.integral) & 1)) != 0;
        unsigned bits = bitsOf(some & m_shown & (m_rays.count > 0) & (m_clear >= kDark));
        for (; bits != 0; bits &= bits - 1) {
            const int n = __builtin_ctz(bits);
            while (hit(n, last.code[n], next.code[n], last.u[n], next.u[n])) {
            }
        }
    }
    /// The next feature that ray n meets for the first time while the code goes from `a` to `b`; false: none.
    bool hit(int n, float a, float b, float from, float to) {
        int nearest = -1;
        float at = 2;
        for (int f = 0; f < m_s.featureCount; ++f) {
            const PacketScene::Feature& feature = m_s.features[f];
            if (m_seen[n][f >> 6] >> (f & 63) & 1) continue;
            float where = 2;
            if (a >= feature.low && a < feature.high)
                where = 0;
            else if (a < feature.low && b >= feature.low)
                where = (feature.low - a) / (b - a);
            else if (a >= feature.high && b < feature.high)
                where = (feature.high - a) / (b - a);
            if (where < at) {
                at = where;
                nearest = f;
            }
        }
        if (nearest < 0) return false;
        m_seen[n][nearest >> 6] |= std::uint64_t{1} << (nearest & 63);
        const PacketScene::Feature& feature = m_s.features[nearest];
        Vec4 rgb{feature.rgb[0], feature.rgb[1], feature.rgb[2], 0};
        float alpha = feature.opacity;
        const unsigned bit = 1u << n;
        const Vec8 place = all(from + at * (to - from));
        Vec8 position[3];
        positionAt(m_rays, place, position);
        if (m_s.voxelColors) {
            Vec4 colors[kWide];
            m_voxelColors.at(position, bit, colors);
            rgb = colors[n];
        }
        if (m_s.light.any) {
            Vec8 gradient[3] = {Vec8{}, Vec8{}, Vec8{}}, inCamera[3];
            m_lighting.gradientsAt(position, bit, gradient);
            m_lighting.toCamera(gradient, inCamera);
            if (m_s.light.gradientOpacity > 0) {
                const float share = m_lighting.depthShare(Lighting::lengthOf(inCamera))[n];
                alpha = 1 - __builtin_powf(1 - alpha, share);
            }
            const Shade shade =
                m_lighting.shadeOf(m_rays.view, inCamera, position, m_rays.depth + place * m_rays.depthPerStep, bit);
            rgb = m_lighting.lit(rgb, 1, shade, n);
        }
        m_color.rgb[n] += m_clear[n] * alpha * rgb;
        m_clear[n] *= 1 - alpha;
        return true;
    }

    const PacketScene& m_s;
    const Samples& m_samples;
    Lighting m_lighting;
    VoxelColorSamples m_voxelColors;
    const Rays& m_rays;
    Colors m_color{};
    Vec8 m_clear = all(1);
    Int8 m_shown = ~Int8{};
    std::uint64_t m_seen[kWide][kMostSurfaces / 64]{};
};

} // namespace
} // namespace pellucid
