// Rays in storage order, eight neighbours at a time (see sheared_rays.h). Included by one .cpp per instruction set. In
// reading order:
//   sweep_vectors.inl          vectors of eight and the functions on them
//   ray_packets_light.inl      what light makes of colours
//   sheared_rays_samples.inl   what eight neighbours meet in a slice
//   sheared_rays_warp.inl      from the rays to the picture
// docs/method.md, "The quick picture", says what is computed.
#include <new>

#include "render/cpu/sheared_rays_samples.inl"
#include "render/cpu/sheared_rays_warp.inl"

namespace pellucid {
namespace {

/// Segments between two looks at the blocks, where rays are in one that is not passed over.
constexpr int kShearedRun = 4;
constexpr int kEnded = 1 << 30; ///< in the place of a slice
constexpr int kMostPackets = kShearedTileWidth / kWide;
/// Slices before memory is needed that it is asked for.
constexpr int kAskedAhead = 9;
/// What rays have gathered is lit as one until one of eight has this opacity.
constexpr float kShearedLitAtOnce = 1.0f / 64;

/// Emission and absorption along eight neighbours, from slice to slice. Between two the intensity goes linearly, and
/// what it meets there comes from running integrals over the transfer function.
template <class Code, bool kInvalid, bool kLight>
class ShearedRays {
public:
    ShearedRays(const ShearedScene& s, const Slices<Code>& slices, const Lighting& lighting, int x, int y)
        : m_s(s), m_scene(*s.scene), m_slices(slices), m_lighting(lighting), m_x(x), m_y(y) {
        m_next = start() ? m_firstSlice : kEnded;
    }

    /// The next slice that they have to be taken on from; kEnded: none.
    int next() const { return m_next; }
    int end() const { return m_lastSlice; }

    /// Looks what lies between slice next() and the one behind it, or leaps on. In two parts, each for all packets of a
    /// row in turn, so that the processor works on several of them at a time.
    void look() {
        const int n = m_next;
        if (m_left == 0) {
            const int leap = m_scene.leap ? slicesToLeap(n) : 0;
            if (leap > 0) {
                m_known = false;
                goOn(n + leap);
                for (int ahead = 0; ahead < kAskedAhead && m_next + ahead < m_lastSlice; ++ahead)
                    m_slices.prefetch(m_x, m_x + kWide, m_y, m_next + ahead);
                return;
            }
            m_left = kShearedRun;
        }
        if (!m_known) meet(n, m_met[m_last]);
        m_known = true;
        meet(n + 1, m_met[1 - m_last]);
        m_looked = true;
    }
    void step() {
        if (!m_looked) return;
        m_looked = false;
        const int n = m_next;
        const bool ended =
            absorb(n, m_met[m_last], m_met[1 - m_last]) && none((m_clear >= kDark) & (m_exit > static_cast<float>(n)));
        m_last = 1 - m_last;
        --m_left;
        goOn(ended ? kEnded : n + 1);
    }

    void finish() {
        if constexpr (kLight) light(m_pending > 0);
        store();
    }

private:
    void goOn(int slice) { m_next = slice < m_lastSlice ? slice : kEnded; }

    /// What is met where a ray passes a slice.
    struct Met {
        Vec8 code, share; ///< share of the valid voxels
        Int8 cell;
        Int8 sums[4]; ///< red, green, blue of the running integral, and 2·(that of τ) + (the cell is opaque)
    };

    /// False where none meets the volume.
    bool start() {
        const Vec8 grid = all(static_cast<float>(m_x)) + kIota;
        m_u0 = all(m_s.first[0]) + grid * m_s.pitch[0];
        m_v0 = m_s.first[1] + static_cast<float>(m_y) * m_s.pitch[1];
        m_way[0] = m_u0 * m_s.scale[1] + m_s.shift[0][1];
        m_way[1] = all(m_v0 * m_s.scale[1] + m_s.shift[1][1]);
        const auto component = [&](const float(&by)[3]) { return m_way[0] * by[0] + m_way[1] * by[1] + by[2]; };
        const Vec8 right = component(m_s.right), down = component(m_s.down), ahead = component(m_s.ahead),
                   length = squareRoot(right * right + down * down + ahead * ahead), perLength = 1.0f / length;
        m_view[0] = -right * perLength;
        m_view[1] = down * perLength;
        m_view[2] = ahead * perLength;
        m_length = length * (1 / m_s.d0);

        m_enter = all(-1);
        m_exit = all(static_cast<float>(m_s.dims[2]));
        const Vec8 u = m_u0 * m_s.scale[0] + m_s.shift[0][0];
        const float v = m_v0 * m_s.scale[0] + m_s.shift[1][0];
        const Vec8 point[3] = {u, all(v), Vec8{}}, way[3] = {m_way[0], m_way[1], all(1)};
        cut(m_s.planes, m_scene.planeCount, point, way, m_enter, m_exit);
        if (m_scene.faintCount > 0) {
            m_clearFrom = all(-kNever);
            m_clearTo = all(kNever);
            cut(m_s.faintPlanes, m_scene.faintCount, point, way, m_clearFrom, m_clearTo);
        }
        const Int8 meets = m_enter < m_exit;
        m_exit = meets ? m_exit : all(-2);
        if (none(meets)) return false;
        m_firstSlice = larger(-1, floorInt(lowest(meets ? m_enter : all(kNever))));
        m_lastSlice = smaller(m_s.dims[2], ceilInt(highest(m_exit)));
        m_allIn = highest(meets ? m_enter : all(-2));
        m_allOut = none(~meets) ? lowest(m_exit) : -2;
        return true;
    }

    Vec8 uAt(float w) const {
        return m_u0 * (m_s.scale[0] + w * m_s.scale[1]) + (m_s.shift[0][0] + w * m_s.shift[0][1]);
    }
    float vAt(float w) const {
        return m_v0 * (m_s.scale[0] + w * m_s.scale[1]) + (m_s.shift[1][0] + w * m_s.shift[1][1]);
    }

    /// How many slices rays can go on from slice n before any leaves blocks that may be passed over; 0 where one may
    /// not.
    int slicesToLeap(int n) const {
        const float w = static_cast<float>(n);
        const Int8 done = (m_clear < kDark) | (m_exit <= w);
        const Vec8 u = uAt(w), v = all(vAt(w));
        const Int8 block[3] = {blockOf(u, m_s.dims[0]), blockOf(v, m_s.dims[1]),
                               Int8{} + (cellAlongAxis(n) >> kRayBlockShift)};
        Int8 index = Int8{};
        for (int a = 0; a < 3; ++a) index += block[a] * m_slices.blockStep(a);
        const Int8 distance = bytesAt(m_scene.blockDistance, index);
        if (!none(~done & (distance == 0))) return 0;
        Vec8 room = roomAlong(u, m_way[0], block[0], distance);
        room = least(room, roomAlong(v, m_way[1], block[1], distance));
        room = done ? all(65536) : least(room, toFloat(slicesWithin(n, block[2], distance)));
        room = m_exit - w <= room ? all(65536) : room; // it ends before
        return static_cast<int>(lowest(room) - 0.01f);
    }
    static Int8 blockOf(Vec8 at, int count) {
        return toInt(most(Vec8{}, least(at, all(static_cast<float>(count - 2))))) >> kRayBlockShift;
    }
    /// Of the segment behind slice n.
    int cellAlongAxis(int n) const {
        const int cell = clampTo(n, 0, m_s.dims[2] - 2);
        return m_s.reversed ? m_s.dims[2] - 2 - cell : cell;
    }
    Vec8 roomAlong(Vec8 at, Vec8 way, Int8 block, Int8 distance) const {
        const Vec8 low = toFloat((block - distance + 1) << kRayBlockShift),
                   high = toFloat((block + distance) << kRayBlockShift);
        const Vec8 speed = positive(way) > 1e-6f ? way : all(1e-6f);
        return ((speed < 0 ? low : high) - at) / speed;
    }
    Int8 slicesWithin(int n, Int8 block, Int8 distance) const {
        const int cell = cellAlongAxis(n), before = larger(0, -n); // slice −1 comes before all cells
        return before + (m_s.reversed ? cell + 1 - ((block - distance + 1) << kRayBlockShift)
                                      : ((block + distance) << kRayBlockShift) - cell);
    }

    void meet(int n, Met& m) const {
        const float w = static_cast<float>(n);
        const Lanes lanes = m_slices.lanesAt(uAt(w), vAt(w), n);
        m.code = m_slices.codes(lanes);
        if constexpr (kInvalid) {
            m.share = m_slices.validShare(lanes);
            m.code = m.share > 0 ? m.code / m.share : Vec8{};
        }
        lookUp(m);
    }
    void lookUp(Met& m) const {
        m.cell = toInt(m.code * m_scene.cellOfCode + 0.5f);
        entriesAt(m_scene.colors, m.cell, m.sums);
    }

    /// Takes the rays on from slice n to the next. True where something has been absorbed.
    bool absorb(int n, const Met& last, Met& next) {
        const float w = static_cast<float>(n);
        if (w >= m_allIn && w + 1 <= m_allOut) {
            if constexpr (!kInvalid) {
                if (none((next.sums[3] ^ last.sums[3]) | (next.sums[3] & 1))) return false;
                return take(n, last, next, m_scene.faintCount > 0 ? thinnedBetween(all(w), all(w + 1)) : all(1));
            }
        }
        // The part of the way between the slices that lies within what is drawn.
        const Vec8 from = least(all(1), most(Vec8{}, m_enter - w)), to = least(all(1), most(Vec8{}, m_exit - w)),
                   part = most(Vec8{}, to - from);
        if (none(part > 0)) return false;
        Met a = last, b = next;
        if constexpr (kInvalid) { // where nothing is known the other end stands for both
            a.code = last.share > 0 ? last.code : next.code;
            b.code = next.share > 0 ? next.code : last.code;
        }
        const Vec8 difference = b.code - a.code, start = a.code;
        a.code = start + from * difference;
        b.code = start + to * difference;
        lookUp(a);
        lookUp(b);
        Vec8 share = part;
        if constexpr (kInvalid) share *= 0.5f * (last.share + next.share);
        if (none((b.sums[3] ^ a.sums[3]) | (b.sums[3] & 1))) return false;
        if (m_scene.faintCount > 0) share *= thinnedBetween(w + from, w + to);
        return take(n, a, b, share);
    }
    /// What of its own the way between two w keeps.
    Vec8 thinnedBetween(Vec8 from, Vec8 to) const {
        return thinned(m_scene.faintDensity, m_clearFrom, m_clearTo, from, to);
    }

    /// `share` of the segment's length counts.
    bool take(int n, const Met& last, const Met& next, Vec8 share) {
        Vec8 met[4]; // as the cells between count: red, green, blue, τ
        Vec8 way = toFloat(next.cell - last.cell);
        const Int8 resting = next.cell == last.cell;
        Int8 difference[4];
        for (int c = 0; c < 3; ++c) difference[c] = next.sums[c] - last.sums[c];
        difference[3] = (next.sums[3] >> 1) - (last.sums[3] >> 1);
        if (!none(resting & next.sums[3] & 1)) {
            Int8 end[4];
            entriesAt(m_scene.colors, next.cell + 1, end);
            for (int c = 0; c < 3; ++c) difference[c] = resting ? end[c] - next.sums[c] : difference[c];
            difference[3] = resting ? (end[3] >> 1) - (next.sums[3] >> 1) : difference[3];
        }
        way = resting ? all(1) : way;
        for (int c = 0; c < 4; ++c) met[c] = toFloat(difference[c]);
        Vec8 depth = met[3] / way * (m_length * m_scene.depthUnit);
        depth *= share;
        depth = depth > 0 ? depth : Vec8{};
        if (none(depth > 0)) return false;
        if constexpr (kLight) {
            m_place = n;
            if (m_scene.light.gradientOpacity > 0) {
                Vec8 inCamera[3];
                gradientInCamera(depth > 0, inCamera);
                depth *= m_lighting.depthShare(Lighting::lengthOf(inCamera));
            }
        }
        const Vec8 left = m_clear * expMinus(depth), weight = m_clear - left;
        m_clear = left;
        const Vec8 per = (weight > 0) & (met[3] != 0) ? weight / met[3] : Vec8{};
        for (int c = 0; c < 3; ++c) colors()[c] += per * met[c];
        if constexpr (kLight) {
            m_pending += weight;
            if (!none(m_pending > kShearedLitAtOnce)) light(m_pending > 0);
        }
        return true;
    }

    Vec8 (&colors())[3] {
        if constexpr (kLight)
            return m_unlit;
        else
            return m_rgb;
    }

    void gradientInCamera(Int8 which, Vec8 (&inCamera)[3]) const {
        const float w = static_cast<float>(m_place);
        Vec8 gradient[3]; // along u, v, w
        m_slices.gradient(uAt(w), vAt(w), m_place, bitsOf(which), gradient);
        for (int row = 0; row < 3; ++row) {
            const float(&by)[3] = m_s.cameraFromGradient[row];
            inCamera[row] = by[0] * gradient[0] + by[1] * gradient[1] + by[2] * gradient[2];
        }
    }

    /// Lights what is pending of the rays in `which` by the gradient at m_place. Not inlined: there are too few
    /// registers for it and step() at a time.
    __attribute__((noinline)) void light(Int8 which) {
        const unsigned bits = bitsOf(which);
        if (bits == 0) return;
        Vec8 inCamera[3], position[3]{}, depth{};
        gradientInCamera(which, inCamera);
        if (m_scene.light.openness || m_scene.light.depthCue > 0) {
            const float w = static_cast<float>(m_place);
            const Vec8 uvw[3] = {uAt(w), all(vAt(w)), all(w)};
            for (int a = 0; a < 3; ++a)
                position[m_s.axis[a]] = a == 2 && m_s.reversed ? all(static_cast<float>(m_s.dims[2] - 1)) - w : uvw[a];
            depth = m_s.depthAtZero + uvw[0] * m_s.ahead[0] + uvw[1] * m_s.ahead[1] + uvw[2] * m_s.ahead[2];
        }
        const Shade shade = m_lighting.shadeOf(m_view, inCamera, position, depth, bits);
        for (int c = 0; c < 3; ++c) {
            Vec8 lit = least(m_unlit[c] * shade.scale + shade.add * m_pending, m_pending) * shade.dim;
            lit += shade.cue * (m_scene.light.cueColor[c] * m_pending - lit);
            m_rgb[c] += which ? lit : Vec8{};
            m_unlit[c] = which ? Vec8{} : m_unlit[c];
        }
        m_pending = which ? Vec8{} : m_pending;
    }

    void store() const {
        const std::int64_t at = m_y * m_s.stride + 4 * static_cast<std::int64_t>(m_x);
        const Vec8 color[4] = {m_rgb[0], m_rgb[1], m_rgb[2], 1.0f - m_clear};
        m_s.touched[at / (4 * kWide)] = !none(color[3] > 0);
        Int8 whole[4];
        for (int c = 0; c < 4; ++c) whole[c] = toInt(color[c] * static_cast<float>(kColorOne) + 0.5f);
        storeFours(m_s.rgba + at, whole);
    }

    const ShearedScene& m_s;
    const PacketScene& m_scene;
    const Slices<Code>& m_slices;
    const Lighting& m_lighting;
    int m_x, m_y;               ///< of the first ray in the grid
    int m_next = 0, m_left = 0; ///< slice; and how many to the next look at the blocks
    int m_last = 0;             ///< where what is met in slice m_next is in m_met
    bool m_known = false;       ///< whether it is
    bool m_looked = false;      ///< so is what is met in the slice behind
    Met m_met[2];
    Vec8 m_u0, m_way[3]; ///< per slice
    float m_v0 = 0;
    Vec8 m_length;               ///< of the way from slice to slice, in d0
    Vec8 m_view[3];              ///< unit vector toward the viewer: right, up, backward
    Vec8 m_enter, m_exit;        ///< in w
    Vec8 m_clearFrom, m_clearTo; ///< in w; where something is faint, between them nothing is
    int m_firstSlice = 0, m_lastSlice = 0;
    float m_allIn = 0, m_allOut = 0; ///< between these no ray enters or leaves
    Vec8 m_clear = all(1), m_rgb[3]{}, m_unlit[3]{}, m_pending = Vec8{};
    int m_place = 0; ///< slice where what is pending is lit
};

/// A row of a tile: all its rays go from slice to slice together, as the voxels lie in memory.
template <class Code, bool kInvalid, bool kLight>
void castRow(const ShearedScene& s, const Slices<Code>& slices, const Lighting& lighting, int x0, int x1, int y) {
    using Packet = ShearedRays<Code, kInvalid, kLight>;
    alignas(Packet) unsigned char memory[kMostPackets * sizeof(Packet)];
    auto* const packets = reinterpret_cast<Packet*>(memory);
    int count = 0, first = kEnded, end = 0;
    for (int x = x0; x < x1; x += kWide, ++count) {
        const Packet* const packet =
            ::new (memory + static_cast<std::size_t>(count) * sizeof(Packet)) Packet(s, slices, lighting, x, y);
        if (packet->next() == kEnded) continue;
        first = smaller(first, packet->next());
        end = larger(end, packet->end());
    }
    for (int n = first; n < end;) {
        for (int p = 0; p < count; ++p)
            if (packets[p].next() == n) packets[p].look();
        int next = kEnded;
        for (int p = 0; p < count; ++p) {
            packets[p].step();
            next = smaller(next, packets[p].next());
        }
        if (next <= n + 1) slices.prefetch(x0, x1, y, n + 1 + kAskedAhead);
        n = next;
    }
    for (int p = 0; p < count; ++p) packets[p].finish();
}

template <class Code, bool kInvalid>
void castTileOf(const ShearedScene& s, const PacketTile& tile) {
    const Slices<Code> slices(s);
    const Samples samples(*s.scene);
    const Lighting lighting(*s.scene, samples);
    for (int y = tile.y0; y < tile.y1; ++y) {
        if (s.scene->light.any)
            castRow<Code, kInvalid, true>(s, slices, lighting, tile.x0, tile.x1, y);
        else
            castRow<Code, kInvalid, false>(s, slices, lighting, tile.x0, tile.x1, y);
    }
}

void castTile(const ShearedScene& s, const PacketTile& tile) {
    if (!s.codes)
        castTileOf<std::uint8_t, false>(s, tile); // narrow: all voxels are valid
    else if (s.valid)
        castTileOf<std::uint16_t, true>(s, tile);
    else
        castTileOf<std::uint16_t, false>(s, tile);
}

} // namespace
} // namespace pellucid
