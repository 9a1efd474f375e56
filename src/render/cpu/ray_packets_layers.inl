// What eight pixels are made of: what each feature adds to them, and where half of their light has been absorbed
// (docs/method.md, "Layers").
#pragma once

#include "render/cpu/ray_packets_modes.inl"

namespace pellucid {
namespace {

constexpr float kHalf = 0.5f;

class LayerSums {
public:
    /// A way through the table of the transfer function, in cells and parts of them.
    struct Course {
        int from, to;
        float fromFraction, toFraction;

        float begin() const { return static_cast<float>(from) + fromFraction; }
        float end() const { return static_cast<float>(to) + toFraction; }
        Course(int f, int t, float ofFrom, float ofTo) : from(f), to(t), fromFraction(ofFrom), toFraction(ofTo) {}
        Course(float a, float b)
            : from(static_cast<int>(a)), to(static_cast<int>(b)), fromFraction(a - static_cast<float>(from)),
              toFraction(b - static_cast<float>(to)) {}
        Course upTo(float part) const {
            const Course other(0, begin() + part * (end() - begin()));
            return {from, other.to, fromFraction, other.toFraction};
        }
    };

    /// Of the pixels (x, y).
    LayerSums(const PacketScene& s, Int8 x, Int8 y) : m_s(s), m_layers(*s.layers) {
        for (int n = 0; n < kWide; ++n) m_pixel[n] = static_cast<std::int64_t>(y[n]) * s.width + x[n];
        for (int f = 0; f <= m_layers.count; ++f)
            for (Vec4& v : m_pending[f]) v = Vec4{};
    }

    /// The running integral of τ·rgb along a course.
    Vec4 colorsOf(const Course& c) const {
        Vec4 rgb{};
        for (int i = 0; i < 3; ++i)
            rgb[i] = along(c, [&](int cell) { return m_s.colors[4 * static_cast<std::int64_t>(cell) + i]; });
        return rgb;
    }

    /// Divides what ray n absorbs along a course, `weight`, among the features that it runs through.
    /// `colorOf(part, share)` is the colour of a part of the course that has this share of the weight.
    template <class ColorOf>
    void add(int n, const Course& course, float weight, const ColorOf& colorOf) {
        const float begin = course.begin(), end = course.end(), low = begin < end ? begin : end,
                    high = begin < end ? end : begin;
        const float whole = opacityOf(course);
        float rest = weight;
        Vec4 restOfColor = colorOf(course, 1);
        int latest = m_layers.count; // the rest
        for (int f = 0; f < m_layers.count && rest > 0; ++f) {
            const float first = m_layers.entries[f][0], last = m_layers.entries[f][1];
            if (high <= first || low >= last) continue;
            if (low >= first && high <= last) { // as a rule
                put(f, n, restOfColor, rest);
                return;
            }
            const float from = begin < first ? first : (begin > last ? last : begin),
                        to = end < first ? first : (end > last ? last : end);
            const Course part(from, to);
            const float share = whole == 0 ? 0 : opacityOf(part) / whole;
            if (!(share > 0)) continue;
            const Vec4 color = colorOf(part, share);
            put(f, n, color, weight * share);
            latest = f;
            restOfColor -= color;
            rest -= weight * share;
        }
        // What rounding has left over goes where the last part went, so that nothing is lost of the whole.
        put(rest > kRounding * weight ? m_layers.count : latest, n, restOfColor, rest);
    }

    /// What has been added to ray n goes into the picture's layers, lit: `lit(rgb, weight)`.
    template <class Lit>
    void keep(int n, const Lit& lit) {
        for (int f = 0; f <= m_layers.count; ++f) {
            Vec4& pending = m_pending[f][n];
            if (pending[3] == 0) continue;
            Vec4 color = lit(pending, pending[3]);
            color[3] = pending[3];
            pending = Vec4{};
            float* const pixel = m_layers.rgba[f] + 4 * m_pixel[n];
            for (int i = 0; i < 4; ++i) pixel[i] += color[i];
        }
    }
    void keepUnlit(unsigned bits) {
        for (; bits != 0; bits &= bits - 1) keep(__builtin_ctz(bits), [](Vec4 rgb, float) { return rgb; });
    }

    /// How far along a course this part of what it absorbs has been absorbed; both in [0, 1].
    float wayTo(const Course& course, float part) const {
        part = part < 0 ? 0 : (part > 1 ? 1 : part);
        const float whole = opacityOf(course);
        if (whole == 0) return part;
        float low = 0, high = 1;
        for (int i = 0; i < 16; ++i) { // 1/65536 of a step
            const float middle = 0.5f * (low + high);
            const float reached = opacityOf(course.upTo(middle)) / whole;
            (reached < part ? low : high) = middle;
        }
        return 0.5f * (low + high);
    }

    /// Half of the rays in `bits` is absorbed at u, where the gradient in camera coordinates is `gradient`.
    void keepMiddle(const Rays& rays, Vec8 u, const Vec8 (&gradient)[3], unsigned bits) {
        for (; bits != 0; bits &= bits - 1) {
            const int n = __builtin_ctz(bits);
            const float lengthPerDepth = m_s.step / rays.depthPerStep[n];
            m_layers.depth[m_pixel[n]] = (rays.depth[n] + u[n] * rays.depthPerStep[n] - m_layers.eye) * lengthPerDepth;
            float squared = 0, facing = 0;
            for (int a = 0; a < 3; ++a) {
                squared += gradient[a][n] * gradient[a][n];
                facing += gradient[a][n] * rays.view[a][n];
            }
            if (squared < 1e-12f) continue; // inside a homogeneous region there is none
            const float scale = (facing < 0 ? -1 : 1) / __builtin_sqrtf(squared);
            for (int a = 0; a < 3; ++a) m_layers.normal[3 * m_pixel[n] + a] = scale * gradient[a][n];
        }
    }

private:
    static constexpr float kRounding = 1e-5f; ///< less of a weight is no rest of its own

    /// Of a running integral, `sum(cell)` where a cell begins.
    template <class Sum>
    float along(const Course& c, const Sum& sum) const {
        const auto inside = [&](int cell) { // nothing lies beyond the last cell
            return static_cast<float>(cell) < m_s.lastEntry ? static_cast<float>(sum(cell + 1) - sum(cell)) : 0.0f;
        };
        return static_cast<float>(sum(c.to) - sum(c.from)) + c.toFraction * inside(c.to) -
               c.fromFraction * inside(c.from);
    }
    /// The running integral of τ along a course, in units of the table; negative downward.
    float opacityOf(const Course& c) const {
        return along(c, [this](int cell) { return m_s.integral[cell] >> 1; });
    }
    void put(int f, int n, Vec4 color, float weight) {
        color[3] = weight;
        m_pending[f][n] += color;
    }

    const PacketScene& m_s;
    const PacketLayers& m_layers;
    std::int64_t m_pixel[kWide];
    Vec4 m_pending[kMostSurfaces][kWide]; ///< not in the layers yet: colours, and weight
};

} // namespace
} // namespace pellucid
