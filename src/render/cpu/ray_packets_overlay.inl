// Two volumes along the same eight rays, in one pass (docs/method.md, "The overlay"). Both absorb and emit; what they
// do between two samples is spread evenly over the piece between them, which is halved where that shows.
#pragma once

#include "render/cpu/ray_packets_modes.inl"

namespace pellucid {
namespace {

/// Rays through one of two volumes: u counts from where they enter the first of the two that they meet, up to where
/// they have left both. The part inside this one's kept box is [enter, exit], empty where the ends are the same.
struct Course {
    Rays rays;
    Vec8 enter, exit;
};

/// `a` and `b` have the same directions and lengths in the world.
inline void join(const Rays& a, const Rays& b, Course& first, Course& second) {
    const Int8 some = a.count > 0, others = b.count > 0;
    const Vec8 begin = some ? (others ? least(a.depth, b.depth) : a.depth) : b.depth;
    const auto placed = [&](const Rays& own, Int8 any, Course& course) {
        course.rays = own;
        const Vec8 back = (begin - own.depth) / own.depthPerStep;
        for (int axis = 0; axis < 3; ++axis) course.rays.point[axis] += back * own.step[axis];
        course.rays.depth = begin;
        course.rays.clearFrom -= back;
        course.rays.clearTo -= back;
        course.enter = any ? -back : Vec8{};
        course.exit = any ? own.count - back : Vec8{};
    };
    placed(a, some, first);
    placed(b, others, second);
    first.rays.count = second.rays.count = most(first.exit, second.exit);
}

/// One of two volumes, along eight rays.
class Medium {
public:
    Medium(const PacketScene& s, const Samples& samples, const Course& course)
        : m_s(s), m_samples(samples), m_lighting(s, samples), m_voxelColors(s, samples), m_course(course) {}

    /// A sample, and where the transfer function's running integral stands there.
    struct Met {
        Vec8 v;               ///< u, held within the volume
        Vec8 entry, fraction; ///< place in the table, and in its cell
        Int8 cell, integral;  ///< integral up to the cell, and its bit
        Vec8 opacity, within; ///< of the cell; and what it adds up to `entry`
        Vec8 share;           ///< of valid voxels
    };
    void meet(Vec8 u, Met& m) const {
        m.v = most(m_course.enter, least(u, m_course.exit));
        Vec8 position[3];
        positionAt(m_course.rays, m.v, position);
        const Cells cells = m_samples.cellsAt(position);
        const Intensity intensity =
            m_s.valid ? m_samples.intensityIn<true>(cells) : m_samples.intensityIn<false>(cells);
        m.entry = intensity.code * m_s.cellOfCode + 0.5f;
        m.share = intensity.share;
        m.cell = toInt(m.entry);
        m.fraction = m.entry - toFloat(m.cell);
        m.integral = gathered(m_s.integral, m.cell);
        m.opacity =
            none(m.integral & 1) ? Vec8{} : toFloat((gathered(m_s.integral + 1, m.cell) >> 1) - (m.integral >> 1));
        m.within = m.fraction * m.opacity;
    }

    /// What lies between two samples, were the intensity linear there.
    struct Piece {
        Vec8 depth; ///< optical
        Vec8 place; ///< about the middle of what is absorbed, were the opacity linear
        Vec8 met;   ///< opacity by which the colours below are weighted
        Vec8 fromFraction, toFraction;
        Int8 from, to; ///< cells
    };
    Piece between(const Met& a, const Met& b) const {
        if (!m_s.valid) return pieceOf(a, b, all(1));
        Met from = a, to = b; // where nothing is known the other end stands for both
        take(from, b, (a.share == 0) & (b.share > 0));
        take(to, a, (b.share == 0) & (a.share > 0));
        return pieceOf(from, to, 0.5f * (a.share + b.share));
    }

    /// What the intensity may meet beyond those of three samples, as far as they are off a straight line: optical
    /// depth.
    Vec8 hidden(const Met& last, const Met& middle, const Met& next) const {
        const Vec8 off = positive(middle.entry - 0.5f * (last.entry + next.entry));
        const Vec8 low = least(middle.entry, least(last.entry, next.entry)),
                   high = most(middle.entry, most(last.entry, next.entry));
        const Vec8 end = all(m_s.lastEntry);
        const Int8 above =
                       gathered(m_s.integral, toInt(least(high + off + 1, end))) - gathered(m_s.integral, toInt(high)),
                   below = gathered(m_s.integral, toInt(low)) - gathered(m_s.integral, toInt(most(low - off, Vec8{})));
        const Vec8 met = toFloat((above > below ? above : below) >> 1);
        return met / (off + 1) * (m_s.depthUnit * m_s.stepInD0) * (next.v - last.v);
    }

    /// The straight colour of what ray n absorbs in a piece whose depth is above 0.
    Vec4 colorOf(const Piece& p, int n) const {
        const std::int32_t *a = m_s.colors + 4 * static_cast<std::int64_t>(p.from[n]),
                           *b = m_s.colors + 4 * static_cast<std::int64_t>(p.to[n]);
        const Int4 a0 = colorAt(a), a1 = colorAt(a + 4), b0 = colorAt(b), b1 = colorAt(b + 4);
        return (floats(b0 - a0) + p.toFraction[n] * floats(b1 - b0) - p.fromFraction[n] * floats(a1 - a0)) / p.met[n];
    }

    /// Adds what the piece emits, of which `weight` is seen, to what waits for light; without light, to `sum`.
    template <bool kLight>
    void emit(const Piece& p, Vec8 weight, Colors& sum) {
        const unsigned bits = bitsOf(weight > 0);
        if (bits == 0) return;
        Vec4 voxels[kWide];
        if (m_s.voxelColors) {
            Vec8 position[3];
            positionAt(m_course.rays, p.place, position);
            m_voxelColors.at(position, bits, voxels);
        }
        for (unsigned lanes = bits; lanes != 0; lanes &= lanes - 1) {
            const int n = __builtin_ctz(lanes);
            (kLight ? m_unlit[n] : sum.rgb[n]) += weight[n] * (m_s.voxelColors ? voxels[n] : colorOf(p, n));
        }
        if constexpr (kLight) {
            m_pending += weight;
            m_lastPlace = weight > 0 ? p.place : m_lastPlace;
            light(m_pending > kLitAtOnce, p.place, sum);
        }
    }
    /// What still waits, at the end.
    void lightRest(Colors& sum) { light(m_pending > 0, m_lastPlace, sum); }

    /// What is left of the depth of a piece under the light's gradient opacity.
    Vec8 depthShare(const Piece& p) const {
        const unsigned bits = bitsOf(p.depth > 0);
        if (bits == 0) return all(1);
        Vec8 inCamera[3], position[3];
        gradientAt(p.place, bits, position, inCamera);
        return m_lighting.depthShare(Lighting::lengthOf(inCamera));
    }

    /// Whole steps from u on, before which no ray comes to a block in which something is opaque.
    int stepsToLeap(Vec8 u) const {
        Vec8 position[3];
        positionAt(m_course.rays, u, position);
        const Int8 before = u < m_course.enter;
        Rays within = m_course.rays;
        within.count = m_course.exit;
        const int inside =
            stepsThrough(m_s, within, position, m_samples.cellsAt(position), u, before | (u >= m_course.exit),
                         [&](Int8 block) { return bytesAt(m_s.blockDistance, block); });
        const int outside = static_cast<int>(lowest(before ? m_course.enter - u : all(65536)));
        return inside < outside ? inside : outside;
    }

private:
    Piece pieceOf(const Met& last, const Met& next, Vec8 share) const {
        Piece p;
        p.met = toFloat((next.integral >> 1) - (last.integral >> 1)) + (next.within - last.within);
        const Vec8 way = next.entry - last.entry;
        const Int8 resting = positive(way) < 0.01f; // as good as in one place
        const Vec8 mean = most(Vec8{}, resting ? next.opacity : p.met / way);
        p.depth = mean * share * (next.v - last.v) * (m_s.depthUnit * m_s.stepInD0);
        if (m_s.faintCount > 0) p.depth *= thinned(m_s, m_course.rays, last.v, next.v);
        const Vec8 ends = last.opacity + next.opacity;
        const Vec8 part = ends > 0 ? (last.opacity + 2.0f * next.opacity) / (3.0f * ends) : all(0.5f);
        p.place = last.v + part * (next.v - last.v);
        p.met = resting ? next.opacity : p.met;
        p.from = resting ? next.cell : last.cell;
        p.to = next.cell;
        p.fromFraction = resting ? Vec8{} : last.fraction;
        p.toFraction = resting ? all(1) : next.fraction;
        return p;
    }
    static void take(Met& to, const Met& from, Int8 where) {
        if (none(where)) return;
        to.entry = where ? from.entry : to.entry;
        to.fraction = where ? from.fraction : to.fraction;
        to.cell = where ? from.cell : to.cell;
        to.integral = where ? from.integral : to.integral;
        to.opacity = where ? from.opacity : to.opacity;
        to.within = where ? from.within : to.within;
    }
    static Int4 colorAt(const std::int32_t* p) { return *reinterpret_cast<const Int4InMemory*>(p); }
    static Vec4 floats(Int4 v) { return __builtin_convertvector(v, Vec4); }

    void gradientAt(Vec8 place, unsigned bits, Vec8 (&position)[3], Vec8 (&inCamera)[3]) const {
        Vec8 gradient[3];
        positionAt(m_course.rays, place, position);
        for (auto& g : gradient) g = Vec8{};
        m_lighting.gradientsAt(position, bits, gradient);
        m_lighting.toCamera(gradient, inCamera);
    }
    /// Lights what waits of the rays in `which` by the gradient at `place`.
    void light(Int8 which, Vec8 place, Colors& sum) {
        const unsigned bits = bitsOf(which);
        if (bits == 0) return;
        Vec8 position[3], inCamera[3];
        gradientAt(place, bits, position, inCamera);
        const Rays& r = m_course.rays;
        const Shade shade = m_lighting.shadeOf(r.view, inCamera, position, r.depth + place * r.depthPerStep, bits);
        for (unsigned lanes = bits; lanes != 0; lanes &= lanes - 1) {
            const int n = __builtin_ctz(lanes);
            sum.rgb[n] += m_lighting.lit(m_unlit[n], m_pending[n], shade, n);
            m_unlit[n] = Vec4{};
        }
        m_pending = which ? Vec8{} : m_pending;
    }

    const PacketScene& m_s;
    const Samples& m_samples;
    Lighting m_lighting;
    VoxelColorSamples m_voxelColors;
    const Course& m_course;
    Vec4 m_unlit[kWide]{};
    Vec8 m_pending = Vec8{}, m_lastPlace = Vec8{};
};

/// Emission and absorption of both along eight rays.
template <bool kLight>
class TwoMedia {
public:
    TwoMedia(const PacketScene& s, const Samples& samples, const Course& course, const Samples& overSamples,
             const Course& overCourse)
        : m_s(s), m_first(s, samples, course), m_second(*s.overlay, overSamples, overCourse), m_rays(course.rays) {}

    Gathered run() {
        float end = endOf(m_rays);
        if (!(highest(m_rays.count) > 0)) return {m_color, m_clear};
        bool known = false; // the sample n, in *last
        Met met[2], *last = &met[0], *next = &met[1];
        for (float n = 0; n < end;) {
            const Vec8 u = placeOf(m_rays, n);
            if (const int leap = m_s.leap ? stepsToLeap(u) : 0; leap > 0) {
                n += static_cast<float>(leap);
                known = false;
                continue;
            }
            if (!known) meet(u, *last);
            known = true;
            for (int i = 0; i < kRun && n < end; ++i) {
                n += 1;
                meet(placeOf(m_rays, n), *next);
                if (follow(*last, *next, m_s.halvings)) end = endOf(m_rays);
                Met* const old = last;
                last = next;
                next = old;
            }
        }
        if constexpr (kLight) {
            m_first.lightRest(m_color);
            m_second.lightRest(m_color);
        }
        return {m_color, m_clear};
    }

private:
    struct Met {
        Vec8 u;
        Medium::Met first, second;
    };
    struct Piece {
        Medium::Piece first, second;
        Vec8 depth() const { return first.depth + second.depth; }
    };

    void meet(Vec8 u, Met& m) const {
        m.u = u;
        m_first.meet(u, m.first);
        m_second.meet(u, m.second);
    }
    int stepsToLeap(Vec8 u) const {
        const int first = m_first.stepsToLeap(u), second = m_second.stepsToLeap(u);
        return first < second ? first : second;
    }
    Piece between(const Met& a, const Met& b) const {
        return {m_first.between(a.first, b.first), m_second.between(a.second, b.second)};
    }

    /// Takes the rays on from one sample to the next, in halves of halves where the picture hangs on what lies between.
    /// True where one has ended.
    bool follow(const Met& last, const Met& next, int halvings) {
        if (halvings == 0) return absorb(between(last, next), next.u);
        Met middle;
        meet(0.5f * (last.u + next.u), middle);
        const Piece first = between(last, middle), second = between(middle, next);
        if (halvings > 1 && isCoarse(last, middle, next, first, second)) {
            const bool ended = follow(last, middle, halvings - 1);
            return follow(middle, next, halvings - 1) | ended;
        }
        const bool ended = absorb(first, middle.u);
        return absorb(second, next.u) | ended;
    }

    /// Whether two halves of a segment look otherwise than the whole does, as if both intensities were linear.
    bool isCoarse(const Met& last, const Met& middle, const Met& next, const Piece& first, const Piece& second) const {
        const Int8 alive = m_rays.count > last.u;
        Vec8 error = m_clear * least(all(1), m_first.hidden(last.first, middle.first, next.first) +
                                                 m_second.hidden(last.second, middle.second, next.second));
        const Piece whole = between(last, next);
        const Vec8 clear = m_clear * expMinus(first.depth()), ofFirst = m_clear - clear,
                   ofSecond = clear - clear * expMinus(second.depth()),
                   ofWhole = m_clear - m_clear * expMinus(whole.depth());
        error += positive(ofWhole - ofFirst - ofSecond);
        if (kLight || m_s.voxelColors)
            error += kLightTurn * m_s.stepInD0 *
                     positive(middleOf(whole) * (ofFirst + ofSecond) - middleOf(first) * ofFirst -
                              middleOf(second) * ofSecond);
        for (unsigned lanes = bitsOf((ofFirst + ofSecond > kHalvingTolerance) & alive); lanes != 0;
             lanes &= lanes - 1) {
            const int n = __builtin_ctz(lanes);
            Vec4 away = seen(whole, ofWhole, n) - seen(first, ofFirst, n) - seen(second, ofSecond, n);
            away = away < 0 ? -away : away;
            for (int c = 0; c < 3; ++c) error[n] = error[n] > away[c] ? error[n] : away[c];
        }
        return !none((error > kHalvingTolerance) & alive);
    }
    /// About the middle of what both absorb.
    static Vec8 middleOf(const Piece& p) {
        const Vec8 depth = p.depth();
        return depth > 0 ? (p.first.place * p.first.depth + p.second.place * p.second.depth) / depth : p.first.place;
    }
    /// Colour that ray n gets of a piece, of which `weight` is seen.
    Vec4 seen(const Piece& p, Vec8 weight, int n) const {
        Vec4 sum{};
        const float per = weight[n] / (p.first.depth[n] + p.second.depth[n]);
        if (!(weight[n] > 0)) return sum;
        if (p.first.depth[n] > 0) sum += per * p.first.depth[n] * m_first.colorOf(p.first, n);
        if (p.second.depth[n] > 0) sum += per * p.second.depth[n] * m_second.colorOf(p.second, n);
        return sum;
    }

    bool absorb(Piece p, Vec8 end) {
        if (none(p.depth() > 0)) return false;
        if (kLight && m_s.light.gradientOpacity > 0) {
            p.first.depth *= m_first.depthShare(p.first);
            p.second.depth *= m_second.depthShare(p.second);
        }
        const Vec8 depth = p.depth(), left = m_clear * expMinus(depth), weight = m_clear - left;
        m_clear = left;
        const Vec8 per = depth > 0 ? weight / depth : Vec8{};
        m_first.emit<kLight>(p.first, per * p.first.depth, m_color);
        m_second.emit<kLight>(p.second, per * p.second.depth, m_color);
        const Int8 ended = (m_clear < kDark) & (m_rays.count > 0);
        if (none(ended)) return false;
        m_rays.count = ended ? least(m_rays.count, most(end, Vec8{})) : m_rays.count;
        return true;
    }

    const PacketScene& m_s;
    Medium m_first, m_second;
    Rays m_rays;
    Vec8 m_clear = all(1); ///< transmittance
    Colors m_color{};
};

} // namespace
} // namespace pellucid
