// From the grid of rays to the picture: each pixel by Catmull and Rom's cubic between 4×4 rays.
#pragma once

#include "render/cpu/ray_packets_samples.inl"
#include "render/cpu/sheared_rays.h"

namespace pellucid {
namespace {

/// Weights of four neighbours for places `f` of the way from the second to the third; their sum is 1.
inline void cubicWeights(Vec8 f, Vec8 (&weights)[4]) {
    const Vec8 g = 1 - f;
    weights[0] = -0.5f * f * g * g;
    weights[1] = g * (g * (2 - 1.5f * g) + 0.5f);
    weights[2] = f * (f * (2 - 1.5f * f) + 0.5f);
    weights[3] = -0.5f * g * f * f;
}

/// What lies behind the pixels of a row: straight colour and alpha.
inline Vec4 behindRow(const PacketScene& s, int y) {
    if (!s.hasBackground) return Vec4{};
    const float up = 1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(s.height);
    Vec4 color{0, 0, 0, 1};
    for (int c = 0; c < 3; ++c) color[c] = s.background[c] + up * (s.backgroundTop[c] - s.background[c]);
    return color;
}

/// Straight colour and alpha of a pixel, of colour times alpha and alpha over what lies behind.
inline Vec4 over(Vec4 color, Vec4 behind, bool hasBackground) {
    const float alpha = color[3];
    if (hasBackground) return color + (1 - alpha) * behind;
    if (alpha > 0) {
        color /= alpha;
        color[3] = alpha;
    }
    return color;
}

/// screenPixel() of a colour that lies within [0, 1].
inline std::uint32_t pixelOf(Vec4 color) {
    const Int4 v = __builtin_convertvector(color * 255 + 0.5f, Int4);
#ifdef __AVX2__
    const __m128i bytes = _mm_shuffle_epi8(reinterpret_cast<__m128i>(v),
                                           _mm_setr_epi8(8, 4, 0, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1));
    return 0xff000000u | static_cast<std::uint32_t>(_mm_cvtsi128_si32(bytes));
#else
    return 0xff000000u | static_cast<std::uint32_t>(v[0] << 16 | v[1] << 8 | v[2]);
#endif
}

inline Vec4 lowHalf(Vec8 v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
inline Vec4 highHalf(Vec8 v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
/// Four times a, four times b.
inline Vec8 twice4(float a, float b) { return Vec8{a, a, a, a, b, b, b, b}; }

/// Eight pixels of a row: where their rays pass the grid.
struct WarpedRow {
    Int8 inside, column, row;
    Vec8 across[4], downward[4];

    WarpedRow(const ShearedScene& s, int x, int y) {
        const Vec8 px = all(static_cast<float>(x) + 0.5f) + kIota;
        const float py = static_cast<float>(y) + 0.5f;
        const auto ofPixel = [&](int n) { return s.ofPixel[n][1] * px + (s.ofPixel[n][0] + s.ofPixel[n][2] * py); };
        const Vec8 below = ofPixel(2), i = ofPixel(0) / below, j = ofPixel(1) / below;
        inside = (below > 0) & (i >= 1) & (j >= 1) & (i < static_cast<float>(s.width - 2)) &
                 (j < static_cast<float>(s.height - 2));
        column = toInt(inside ? i : Vec8{});
        row = toInt(inside ? j : Vec8{});
        if (none(inside)) return;
        cubicWeights(i - toFloat(column), across);
        cubicWeights(j - toFloat(row), downward);
    }

    /// Colour times alpha, and alpha, of pixel n.
    Vec4 at(const ShearedScene& s, int n) const {
        const Vec8 first = twice4(across[0][n], across[1][n]), second = twice4(across[2][n], across[3][n]);
        const float* from = s.rgba + (row[n] - 1) * s.stride + 4 * (column[n] - 1);
        Vec8 sum{};
        for (int r = 0; r < 4; ++r, from += s.stride)
            sum += downward[r][n] * (first * load(from) + second * load(from + kWide));
        Vec4 color = lowHalf(sum) + highHalf(sum);
        // A cubic may overshoot.
        color = color > 0 ? color : Vec4{};
        const float alpha = color[3] < 1 ? color[3] : 1;
        const Vec4 limit = Vec4{} + alpha;
        return color < limit ? color : limit;
    }
};

/// A pixel as floats, wherever it lies in memory.
struct Rgba {
    float red, green, blue, alpha;
};

/// The pixels, bit n for number n, around which some ray may have met something.
inline unsigned drawnOf(const ShearedScene& s, const WarpedRow& pixels) {
    unsigned bits = bitsOf(pixels.inside);
    for (unsigned left = bits; left != 0; left &= left - 1) {
        const int n = __builtin_ctz(left), row = pixels.row[n], column = pixels.column[n];
        if (column + 2 < s.extents[2 * row] || column - 1 > s.extents[2 * row + 1]) bits &= ~(1u << n);
    }
    return bits;
}

/// Writes all pixels of a tile: `toPixel` makes one of a straight colour.
template <class Pixel, class ToPixel>
void warpTileTo(const ShearedScene& s, const PacketTile& tile, Pixel* pixels, const ToPixel& toPixel) {
    const PacketScene& scene = *s.scene;
    for (int y = tile.y0; y < tile.y1; ++y) {
        const Vec4 behind = behindRow(scene, y);
        const Pixel empty = toPixel(behind);
        Pixel* const row = pixels + static_cast<std::int64_t>(y) * scene.width;
        for (int x = tile.x0; x < tile.x1; x += kWide) {
            const int count = smaller(kWide, tile.x1 - x);
            for (int n = 0; n < count; ++n) row[x + n] = empty;
            const WarpedRow rays(s, x, y);
            for (unsigned left = drawnOf(s, rays); left != 0; left &= left - 1) {
                const int n = __builtin_ctz(left);
                if (n < count) row[x + n] = toPixel(over(rays.at(s, n), behind, scene.hasBackground));
            }
        }
    }
}

void warpTile(const ShearedScene& s, const PacketTile& tile) {
    if (s.pixels)
        warpTileTo(s, tile, s.pixels, pixelOf);
    else
        warpTileTo(s, tile, reinterpret_cast<Rgba*>(s.scene->rgba), [](Vec4 color) {
            return Rgba{color[0], color[1], color[2], color[3]};
        });
}

} // namespace
} // namespace pellucid
