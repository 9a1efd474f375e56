// A picture's rays, eight at a time (see ray_packets.h). Included by one .cpp per instruction set. In reading order:
//   sweep_vectors.inl        vectors of eight and the functions on them
//   ray_packets_samples.inl  where rays run and what they meet
//   ray_packets_light.inl    gradients, and what light makes of colours
//   ray_packets_modes.inl    the modes that do not composite
//   ray_packets_overlay.inl  two volumes in one pass
//   ray_packets_layers.inl   what the picture is made of, beside it
// docs/method.md, "The picture", says what is computed.
#include "render/cpu/ray_packets_layers.inl"
#include "render/cpu/ray_packets_overlay.inl"

namespace pellucid {
namespace {

/// Emission and absorption along eight rays. Between two samples the intensity goes linearly, and what it meets there
/// comes from running integrals over the transfer function, so that thin tents and steps count in full. `kLayers`: what
/// is met is told to `layers`, too.
template <bool kLight, bool kInvalid, bool kVoxelColors, bool kLayers = false>
class Compositing {
public:
    Compositing(const PacketScene& s, const Samples& samples, const Rays& rays, LayerSums* layers = nullptr)
        : m_s(s), m_samples(samples), m_lighting(s, samples), m_voxelColors(s, samples), m_rays(rays),
          m_layers(layers) {}

    Gathered run() {
        float end = endOf(m_rays);
        if (!(highest(m_rays.count) > 0)) return {m_color, m_clear};
        bool known = false; // the sample n, in *last
        Met met[2], *last = &met[0], *next = &met[1];
        for (float n = 0; n < end;) {
            Vec8 u = placeOf(m_rays, n);
            Vec8 position[3];
            positionAt(m_rays, u, position);
            const Cells cells = m_samples.cellsAt(position);
            if (m_s.leap) {
                const int leap = stepsToLeap(m_s, m_rays, position, cells, u);
                if (leap > 0) {
                    n += static_cast<float>(leap);
                    known = false;
                    continue;
                }
            }
            if (!known) {
                meet(u, cells, *last);
                finish(*last);
            }
            known = true;
            for (int i = 0; i < kRun && n < end; ++i) {
                n += 1;
                u = placeOf(m_rays, n);
                positionAt(m_rays, u, position);
                meet(u, m_samples.cellsAt(position), *next);
                if (follow(*last, *next, m_s.halvings)) end = endOf(m_rays);
                Met* const old = last;
                last = next;
                next = old;
            }
        }
        if constexpr (kLight) light(m_pending > 0, m_lastPlace);
        return {m_color, m_clear};
    }

private:
    /// A sample, and where the transfer function's running integral stands there.
    struct Met {
        Vec8 u;
        Vec8 entry, fraction; ///< place in the table, and in its cell
        Int8 cell, integral;  ///< integral up to the cell, and its bit
        Vec8 opacity, within; ///< of the cell; and what it adds up to `entry`
        Vec8 share;
    };

    void meet(Vec8 u, const Cells& cells, Met& m) const {
        const Intensity intensity = m_samples.intensityIn<kInvalid>(cells);
        m.u = u;
        m.entry = intensity.code * m_s.cellOfCode + 0.5f;
        if constexpr (kInvalid) m.share = intensity.share;
        m.cell = toInt(m.entry);
        m.fraction = m.entry - toFloat(m.cell);
        m.integral = gathered(m_s.integral, m.cell);
        m.opacity = Vec8{};
        m.within = Vec8{};
    }
    /// Of the cell, in units of the integral.
    Vec8 opacityOf(const Met& m) const {
        if (none(m.integral & 1)) return Vec8{};
        return toFloat((gathered(m_s.integral + 1, m.cell) >> 1) - (m.integral >> 1));
    }

    /// What lies between two samples, were the intensity linear there.
    struct Piece {
        Vec8 depth; ///< optical
        Vec8 place; ///< about the middle of what is absorbed, were the opacity linear
        Vec8 met;   ///< opacity by which the colours below are weighted
        Vec8 fromFraction, toFraction;
        Int8 from, to; ///< cells
    };

    /// Takes the rays on from one sample to the next, which is finished where it matters: in halves of halves where the
    /// picture hangs on what lies between. True where one has ended.
    bool follow(const Met& last, Met& next, int halvings) {
        if (halvings == 0) return absorb(last, next);
        Met middle;
        const Vec8 u = 0.5f * (last.u + next.u);
        Vec8 position[3];
        positionAt(m_rays, u, position);
        meet(u, m_samples.cellsAt(position), middle);
        if (halvings > 1 && isCoarse(last, middle, next)) {
            const bool ended = follow(last, middle, halvings - 1);
            return follow(middle, next, halvings - 1) | ended;
        }
        const bool ended = absorb(last, middle);
        return absorb(middle, next) | ended;
    }

    /// Whether two halves of a segment look otherwise than the whole does, as if the intensity were linear.
    bool isCoarse(const Met& last, Met& middle, Met& next) {
        const Int8 alive = m_rays.count > last.u;
        Vec8 error = hidden(last, middle, next);
        const Int8 some = (middle.integral ^ last.integral) | (next.integral ^ last.integral) | (next.integral & 1);
        if (none(some)) return !none((error > kHalvingTolerance) & alive);
        finish(middle);
        finish(next);
        const Piece whole = pieceBetween(last, next), first = pieceBetween(last, middle),
                    second = pieceBetween(middle, next);
        const Vec8 clear = m_clear * expMinus(first.depth), ofFirst = m_clear - clear,
                   ofSecond = clear - clear * expMinus(second.depth),
                   ofWhole = m_clear - m_clear * expMinus(whole.depth);
        error += positive(ofWhole - ofFirst - ofSecond);
        if constexpr (kLight || kVoxelColors)
            error += kLightTurn * m_s.stepInD0 *
                     positive(whole.place * (ofFirst + ofSecond) - first.place * ofFirst - second.place * ofSecond);
        if constexpr (!kVoxelColors)
            for (unsigned lanes = bitsOf((ofFirst + ofSecond > kHalvingTolerance) & alive); lanes != 0;
                 lanes &= lanes - 1) {
                const int n = __builtin_ctz(lanes);
                Vec4 away{};
                if (ofWhole[n] > 0) away += ofWhole[n] / whole.met[n] * colorsOf(whole, n);
                if (ofFirst[n] > 0) away -= ofFirst[n] / first.met[n] * colorsOf(first, n);
                if (ofSecond[n] > 0) away -= ofSecond[n] / second.met[n] * colorsOf(second, n);
                away = away < 0 ? -away : away;
                const float most = away[0] > away[1] ? away[0] : away[1];
                const float largest = most > away[2] ? most : away[2];
                error[n] = error[n] > largest ? error[n] : largest;
            }
        return !none((error > kHalvingTolerance) & alive);
    }

    /// What the intensity may meet beyond those of three samples, as far as they are off a straight line.
    Vec8 hidden(const Met& last, const Met& middle, const Met& next) const {
        const Vec8 off = positive(middle.entry - 0.5f * (last.entry + next.entry));
        const Vec8 low = least(middle.entry, least(last.entry, next.entry)),
                   high = most(middle.entry, most(last.entry, next.entry));
        const Vec8 end = all(m_s.lastEntry);
        const Int8 above =
                       gathered(m_s.integral, toInt(least(high + off + 1, end))) - gathered(m_s.integral, toInt(high)),
                   below = gathered(m_s.integral, toInt(low)) - gathered(m_s.integral, toInt(most(low - off, Vec8{})));
        const Vec8 met = toFloat((above > below ? above : below) >> 1);
        return m_clear * least(all(1), met / (off + 1) * (m_s.depthUnit * m_s.stepInD0) * (next.u - last.u));
    }

    /// Takes the rays on from one sample to the next as if the intensity were linear between them.
    bool absorb(const Met& last, Met& next) {
        if constexpr (kInvalid) {
            // Where nothing is known the other end stands for both.
            finish(next);
            Met from = last, to = next;
            take(from, next, (last.share == 0) & (next.share > 0));
            take(to, last, (next.share == 0) & (last.share > 0));
            return absorbBetween(from, to);
        } else {
            if (none((next.integral ^ last.integral) | (next.integral & 1))) return false;
            finish(next);
            return absorbBetween(last, next);
        }
    }
    Piece pieceBetween(const Met& last, const Met& next) const {
        Piece p;
        p.met = toFloat((next.integral >> 1) - (last.integral >> 1)) + (next.within - last.within);
        const Vec8 way = next.entry - last.entry;
        const Int8 resting = positive(way) < 0.01f; // as good as in one place
        const Vec8 mean = most(Vec8{}, resting ? next.opacity : p.met / way);
        // A ray that has ended within a halved step is clamped to where it ended, before the last sample.
        p.depth = mean * most(Vec8{}, next.u - last.u) * (m_s.depthUnit * m_s.stepInD0);
        if constexpr (kInvalid) p.depth *= 0.5f * (last.share + next.share);
        if (m_s.faintCount > 0) p.depth *= thinned(m_s, m_rays, last.u, next.u);
        // Where it is lit, and where colours of voxels are taken.
        const Vec8 ends = last.opacity + next.opacity;
        const Vec8 part = ends > 0 ? (last.opacity + 2.0f * next.opacity) / (3.0f * ends) : all(0.5f);
        p.place = last.u + part * (next.u - last.u);
        p.met = resting ? next.opacity : p.met;
        p.from = resting ? next.cell : last.cell;
        p.to = next.cell;
        p.fromFraction = resting ? Vec8{} : last.fraction;
        p.toFraction = resting ? all(1) : next.fraction;
        return p;
    }
    /// The running integral of τ·rgb, of ray n.
    Vec4 colorsOf(const Piece& p, int n) const {
        const std::int32_t *a = m_s.colors + 4 * static_cast<std::int64_t>(p.from[n]),
                           *b = m_s.colors + 4 * static_cast<std::int64_t>(p.to[n]);
        const Int4 a0 = colorAt(a), a1 = colorAt(a + 4), b0 = colorAt(b), b1 = colorAt(b + 4);
        return floats(b0 - a0) + p.toFraction[n] * floats(b1 - b0) - p.fromFraction[n] * floats(a1 - a0);
    }
    bool absorbBetween(const Met& last, const Met& next) {
        if (none((next.integral ^ last.integral) | (next.integral & 1))) return false;
        Piece p = pieceBetween(last, next);
        const Int8 some = p.depth > 0;
        if (none(some)) return false;

        Vec8 gradient[3], position[3];
        const bool early = kLight && m_s.light.gradientOpacity > 0;
        if (early) {
            positionAt(m_rays, p.place, position);
            for (auto& g : gradient) g = Vec8{};
            m_lighting.gradientsAt(position, bitsOf(some), gradient);
            Vec8 inCamera[3];
            m_lighting.toCamera(gradient, inCamera);
            p.depth *= m_lighting.depthShare(Lighting::lengthOf(inCamera));
        }
        const Vec8 left = m_clear * expMinus(p.depth), weight = m_clear - left;
        if constexpr (kLayers) findMiddle(p, last.u, next.u, left);
        m_clear = left;

        const unsigned bits = bitsOf(weight > 0);
        if constexpr (kVoxelColors) {
            Vec4 rgb[kWide];
            positionAt(m_rays, p.place, position);
            m_voxelColors.at(position, bits, rgb);
            for (unsigned lanes = bits; lanes != 0; lanes &= lanes - 1) {
                const int n = __builtin_ctz(lanes);
                unlit()[n] += weight[n] * rgb[n];
                if constexpr (kLayers)
                    m_layers->add(n, courseOf(p, n), weight[n],
                                  [&](const LayerSums::Course&, float share) { return weight[n] * share * rgb[n]; });
            }
        } else {
            const Vec8 per = weight / p.met;
            for (unsigned lanes = bits; lanes != 0; lanes &= lanes - 1) {
                const int n = __builtin_ctz(lanes);
                unlit()[n] += per[n] * colorsOf(p, n);
                if constexpr (kLayers)
                    m_layers->add(n, courseOf(p, n), weight[n], [&](const LayerSums::Course& part, float) {
                        return per[n] * m_layers->colorsOf(part);
                    });
            }
        }
        if constexpr (kLayers && !kLight) m_layers->keepUnlit(bits);
        if constexpr (kLight) {
            m_pending += weight;
            m_lastPlace = weight > 0 ? p.place : m_lastPlace;
            light(m_pending > kLitAtOnce, p.place);
        }
        const Int8 ended = (m_clear < kDark) & (m_rays.count > 0);
        if (none(ended)) return false;
        m_rays.count = ended ? least(m_rays.count, most(next.u, Vec8{})) : m_rays.count;
        return true;
    }

    void finish(Met& m) const {
        m.opacity = opacityOf(m);
        m.within = m.fraction * m.opacity;
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
    Vec4* unlit() {
        if constexpr (kLight)
            return m_unlit;
        else
            return m_color.rgb;
    }

    /// Lights what is pending of the rays in `which` by the gradient at `place`.
    void light(Int8 which, Vec8 place) {
        const unsigned bits = bitsOf(which);
        if (bits == 0) return;
        Vec8 position[3], gradient[3], inCamera[3];
        positionAt(m_rays, place, position);
        for (auto& g : gradient) g = Vec8{};
        m_lighting.gradientsAt(position, bits, gradient);
        m_lighting.toCamera(gradient, inCamera);
        const Shade shade =
            m_lighting.shadeOf(m_rays.view, inCamera, position, m_rays.depth + place * m_rays.depthPerStep, bits);
        for (unsigned lanes = bits; lanes != 0; lanes &= lanes - 1) {
            const int n = __builtin_ctz(lanes);
            m_color.rgb[n] += m_lighting.lit(m_unlit[n], m_pending[n], shade, n);
            m_unlit[n] = Vec4{};
            if constexpr (kLayers)
                m_layers->keep(n, [&](Vec4 rgb, float weight) { return m_lighting.lit(rgb, weight, shade, n); });
        }
        m_pending = which ? Vec8{} : m_pending;
    }

    /// The places in the table that ray n runs through.
    static LayerSums::Course courseOf(const Piece& p, int n) {
        return {p.from[n], p.to[n], p.fromFraction[n], p.toFraction[n]};
    }
    /// Of the rays of which half is absorbed between u = `from` and `to`: where, and the gradient there. `left` of the
    /// light comes through.
    void findMiddle(const Piece& p, Vec8 from, Vec8 to, Vec8 left) {
        const unsigned bits = bitsOf((m_clear > kHalf) & (left <= kHalf));
        if (bits == 0) return;
        Vec8 u = from;
        for (unsigned lanes = bits; lanes != 0; lanes &= lanes - 1) {
            const int n = __builtin_ctz(lanes);
            const float part = __builtin_logf(m_clear[n] / kHalf) / p.depth[n];
            u[n] += m_layers->wayTo(courseOf(p, n), part) * (to[n] - from[n]);
        }
        Vec8 position[3], gradient[3], inCamera[3];
        positionAt(m_rays, u, position);
        for (auto& g : gradient) g = Vec8{};
        m_lighting.gradientsAt(position, bits, gradient);
        m_lighting.toCamera(gradient, inCamera);
        m_layers->keepMiddle(m_rays, u, inCamera, bits);
    }

    const PacketScene& m_s;
    const Samples& m_samples;
    Lighting m_lighting;
    VoxelColorSamples m_voxelColors;
    Rays m_rays;
    LayerSums* m_layers;   ///< null without kLayers
    Vec8 m_clear = all(1); ///< transmittance
    Colors m_color{};
    Vec4 m_unlit[kWide]{};
    Vec8 m_pending = Vec8{}, m_lastPlace = Vec8{};
};

/// Straight colours and alpha of a packet into the picture.
void store(const PacketScene& s, const PacketTile& tile, int x, int y, const Gathered& g) {
    for (int n = 0; n < kWide; ++n) {
        const int px = x + (n & 3), py = y + (n >> 2);
        if (px >= tile.x1 || py >= tile.y1) continue;
        const float clear = g.clear[n];
        Vec4 rgb = g.color.rgb[n];
        float alpha = 1 - clear;
        const std::int64_t at = static_cast<std::int64_t>(py) * s.width + px;
        if (s.groundDepth && s.groundDepth[at] < kNever) {
            for (int c = 0; c < 3; ++c)
                rgb[c] += clear * (static_cast<float>(s.ground[at] >> (8 * c) & 255u) * (1 / 255.0f));
            alpha = 1;
        } else if (s.hasBackground) {
            const float up = 1 - (static_cast<float>(py) + 0.5f) / static_cast<float>(s.height);
            for (int c = 0; c < 3; ++c)
                rgb[c] += clear * (s.background[c] + up * (s.backgroundTop[c] - s.background[c]));
            alpha = 1;
        } else if (alpha > 0) {
            rgb /= alpha;
        }
        float* pixel = s.rgba + 4 * at;
        for (int c = 0; c < 3; ++c) pixel[c] = rgb[c];
        pixel[3] = alpha;
    }
}

template <bool kInvalid>
Gathered gather(const PacketScene& s, const Samples& samples, const Rays& rays) {
    switch (s.mode) {
    case PacketMode::Composite:
        break;
    case PacketMode::Surface:
        return FirstHits<kInvalid>(s, samples, rays).run();
    default:
        return Grey<kInvalid>(s, samples, rays).run();
    }
    if (s.voxelColors) {
        if (s.light.any) return Compositing<true, kInvalid, true>(s, samples, rays).run();
        return Compositing<false, kInvalid, true>(s, samples, rays).run();
    }
    if (s.light.any) return Compositing<true, kInvalid, false>(s, samples, rays).run();
    return Compositing<false, kInvalid, false>(s, samples, rays).run();
}

Gathered gather(const PacketScene& s, const Samples& samples, const Rays& rays) {
    return s.valid ? gather<true>(s, samples, rays) : gather<false>(s, samples, rays);
}

/// Of both volumes. Modes other than Composite say of no place along the ray: the overlay lies in front of them.
Gathered gatherBoth(const PacketScene& s, const Samples& samples, const Rays& rays, const Samples& overSamples,
                    const Rays& overRays) {
    if (s.mode == PacketMode::Composite) {
        Course first, second;
        join(rays, overRays, first, second);
        if (s.light.any) return TwoMedia<true>(s, samples, first, overSamples, second).run();
        return TwoMedia<false>(s, samples, first, overSamples, second).run();
    }
    Gathered front = gather(*s.overlay, overSamples, overRays);
    const Gathered behind = gather(s, samples, rays);
    for (int n = 0; n < kWide; ++n) front.color.rgb[n] += front.clear[n] * behind.color.rgb[n];
    front.clear *= behind.clear;
    return front;
}

template <bool kInvalid>
Gathered gatherLayers(const PacketScene& s, const Samples& samples, const Rays& rays, LayerSums& layers) {
    if (s.voxelColors) {
        if (s.light.any) return Compositing<true, kInvalid, true, true>(s, samples, rays, &layers).run();
        return Compositing<false, kInvalid, true, true>(s, samples, rays, &layers).run();
    }
    if (s.light.any) return Compositing<true, kInvalid, false, true>(s, samples, rays, &layers).run();
    return Compositing<false, kInvalid, false, true>(s, samples, rays, &layers).run();
}

void layerTile(const PacketScene& s, const PacketTile& tile) {
    const Samples samples(s);
    const Int8 right{0, 1, 2, 3, 0, 1, 2, 3}, down{0, 0, 0, 0, 1, 1, 1, 1};
    for (int y = tile.y0; y < tile.y1; y += 2)
        for (int x = tile.x0; x < tile.x1; x += 4) {
            const Rays rays = raysOf(s, x + right, y + down);
            LayerSums layers(s, x + right, y + down);
            store(s, tile, x, y,
                  s.valid ? gatherLayers<true>(s, samples, rays, layers)
                          : gatherLayers<false>(s, samples, rays, layers));
        }
}

void renderTile(const PacketScene& s, const PacketTile& tile) {
    const Samples samples(s), overSamples(s.overlay ? *s.overlay : s);
    const Int8 right{0, 1, 2, 3, 0, 1, 2, 3}, down{0, 0, 0, 0, 1, 1, 1, 1};
    for (int y = tile.y0; y < tile.y1; y += 2)
        for (int x = tile.x0; x < tile.x1; x += 4) {
            const Rays rays = raysOf(s, x + right, y + down);
            if (s.overlay) {
                const Rays overRays = raysOf(*s.overlay, x + right, y + down);
                if (highest(overRays.count) > 0) {
                    store(s, tile, x, y, gatherBoth(s, samples, rays, overSamples, overRays));
                    continue;
                }
            }
            store(s, tile, x, y, gather(s, samples, rays));
        }
}

} // namespace
} // namespace pellucid
