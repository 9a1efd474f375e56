// From the grid of rays to the picture: each pixel by Catmull and Rom's cubic between 4×4 rays.
//
// Colours and weights are numbers of 16 bits, sixteen at a time: four channels of four rays, or of four pixels. A
// product of two is off by at most 2⁻¹⁵ of what a colour can be, which is a hundredth of a level of the screen.
#pragma once

#include "render/cpu/ray_packets_samples.inl"
#include "render/cpu/sheared_rays.h"

namespace pellucid {
namespace {

typedef std::int16_t Short4 __attribute__((vector_size(8)));
typedef std::int16_t Short16 __attribute__((vector_size(32)));
typedef std::int16_t Short16InMemory __attribute__((vector_size(32), aligned(2), may_alias));
typedef std::uint8_t UChar16 __attribute__((vector_size(16)));
typedef unsigned UInt4 __attribute__((vector_size(16)));
typedef std::int64_t Long4 __attribute__((vector_size(32)));

constexpr std::int16_t kColorOne = 1 << 14; ///< leaves room for what a cubic overshoots
constexpr float kWeightOne = 1 << 15;       ///< what is above it, 1 itself too, is held a hair below

inline Short16 load(const std::int16_t* p) { return *reinterpret_cast<const Short16InMemory*>(p); }
inline Short16 all16(int v) { return Short16{} + static_cast<std::int16_t>(v); }

/// Their product over 2¹⁵, rounded.
inline Short16 timesWeight(Short16 a, Short16 weight) {
#ifdef __AVX2__
    return reinterpret_cast<Short16>(
        _mm256_mulhrs_epi16(reinterpret_cast<__m256i>(a), reinterpret_cast<__m256i>(weight)));
#else
    typedef int Int16 __attribute__((vector_size(64)));
    return __builtin_convertvector(
        (__builtin_convertvector(a, Int16) * __builtin_convertvector(weight, Int16) + 0x4000) >> 15, Short16);
#endif
}

inline std::int16_t asWeight(float v) {
    const float scaled = v * kWeightOne;
    return static_cast<std::int16_t>(scaled < kWeightOne - 1 ? scaled : kWeightOne - 1);
}

/// Four numbers for each of eight places, as they lie in memory place by place.
inline void storeFours(std::int16_t* to, const Int8 (&numbers)[4]) {
    const Int8 low = (numbers[0] & 0xffff) | (numbers[1] << 16), high = (numbers[2] & 0xffff) | (numbers[3] << 16);
    const Int8 first = __builtin_shufflevector(low, high, 0, 8, 1, 9, 2, 10, 3, 11),
               second = __builtin_shufflevector(low, high, 4, 12, 5, 13, 6, 14, 7, 15);
    __builtin_memcpy(to, &first, sizeof first);
    __builtin_memcpy(to + 2 * kWide, &second, sizeof second);
}

/// Weights of four neighbours for places `f` of the way from the second to the third; their sum is 1.
inline void cubicWeights(Vec8 f, std::int16_t* weights) {
    const Vec8 g = 1 - f;
    const Vec8 w[4] = {-0.5f * f * g * g, g * (g * (2 - 1.5f * g) + 0.5f), f * (f * (2 - 1.5f * f) + 0.5f),
                       -0.5f * g * f * f};
    Int8 whole[4];
    for (int k = 0; k < 4; ++k) whole[k] = toInt(least(w[k] * kWeightOne, all(kWeightOne - 1)));
    storeFours(weights, whole);
}

/// Whether some ray may have met something, of those around places of the grid that begin and end there. Columns and
/// rows go one way along a row of pixels.
inline bool anyMet(const ShearedScene& s, int column0, int row0, int column1, int row1) {
    const int left = smaller(column0, column1) - 1, right = larger(column0, column1) + 2;
    for (int r = smaller(row0, row1); r <= larger(row0, row1); ++r)
        if (right >= s.extents[2 * r] && left <= s.extents[2 * r + 1]) return true;
    return false;
}

/// Pixels x0 … x1 − 1 of row y: false where none can show anything.
inline bool anyMet(const ShearedScene& s, int x0, int x1, int y) {
    if (s.width < 4 || s.height < 4) return false; // no pixel has four rays around it, and there may be no row at all
    const auto ofPixel = [&](int n, int x) {
        return s.ofPixel[n][0] + s.ofPixel[n][1] * (static_cast<float>(x) + 0.5f) +
               s.ofPixel[n][2] * (static_cast<float>(y) + 0.5f);
    };
    int at[2][2];
    for (int end = 0; end < 2; ++end) {
        const int x = end == 0 ? x0 : x1 - 1;
        const float below = ofPixel(2, x);
        if (!(below > 0)) return true; // it is looked at pixel by pixel
        for (int a = 0; a < 2; ++a) {
            const float place = ofPixel(a, x) / below;
            const float last = static_cast<float>((a == 0 ? s.width : s.height) - 1);
            at[end][a] = static_cast<int>(place < 0 ? 0 : (place < last ? place : last));
        }
    }
    return anyMet(s, at[0][0], at[0][1], at[1][0], at[1][1]);
}

/// Eight pixels of a row: where their rays pass the grid.
struct WarpedRow {
    Int8 inside;                                         ///< farther off lies nothing
    Int8 column, row;                                    ///< of the second of four; as near as there are four
    std::int16_t across[4 * kWide], downward[4 * kWide]; ///< pixel by pixel: weights of four columns, and of four rows

    WarpedRow(const ShearedScene& s, int x, int y) {
        const Vec8 px = all(static_cast<float>(x) + 0.5f) + kIota;
        const float py = static_cast<float>(y) + 0.5f;
        const auto ofPixel = [&](int n) { return s.ofPixel[n][1] * px + (s.ofPixel[n][0] + s.ofPixel[n][2] * py); };
        const Vec8 below = ofPixel(2), i = ofPixel(0) / below, j = ofPixel(1) / below;
        const auto within = [&](Vec8 at, int count) { return (at >= 1) & (at < static_cast<float>(count - 2)); };
        inside = (below > 0) & within(i, s.width) & within(j, s.height);
        if (none(inside)) return;
        const auto held = [&](Vec8 at, int count) {
            return most(all(1), least(at, all(static_cast<float>(count - 3))));
        };
        column = toInt(held(i, s.width));
        row = toInt(held(j, s.height));
        cubicWeights(i - toFloat(column), across);
        cubicWeights(j - toFloat(row), downward);
    }

    bool maybeDrawn(const ShearedScene& s) const {
        constexpr int kEnd = kWide - 1;
        return !none(inside) && anyMet(s, column[0], row[0], column[kEnd], row[kEnd]);
    }

    /// Colour times alpha, and alpha, of the pixels from number n on. A cubic may overshoot.
    Short16 fourFrom(const ShearedScene& s, const int (&first)[kWide], int n) const {
        Long4 sums[4];
        for (int k = 0; k < 4; ++k) {
            const int pixel = n + k;
            const std::int16_t* from = s.rgba + first[pixel];
            Short16 sum{};
            for (int r = 0; r < 4; ++r, from += s.stride)
                sum += timesWeight(load(from), all16(downward[4 * pixel + r]));
            sums[k] = reinterpret_cast<Long4>(timesWeight(sum, fourTimes(across + 4 * pixel)));
        }
        // Of each, the four columns.
        const auto added = [](Long4 a, Long4 b) {
            return reinterpret_cast<Long4>(reinterpret_cast<Short16>(a) + reinterpret_cast<Short16>(b));
        };
        const auto halves = [&](Long4 a, Long4 b) {
            return added(__builtin_shufflevector(a, b, 0, 4, 2, 6), __builtin_shufflevector(a, b, 1, 5, 3, 7));
        };
        const Long4 low = halves(sums[0], sums[1]), high = halves(sums[2], sums[3]);
        return reinterpret_cast<Short16>(
            added(__builtin_shufflevector(low, high, 0, 1, 4, 5), __builtin_shufflevector(low, high, 2, 3, 6, 7)));
    }

private:
    /// Each of four.
    static Short16 fourTimes(const std::int16_t* w) {
        Short4 four;
        __builtin_memcpy(&four, w, sizeof four);
#ifdef __AVX2__
        const __m256i both = _mm256_set1_epi64x(reinterpret_cast<long long>(four));
        return reinterpret_cast<Short16>(
            _mm256_shuffle_epi8(both, _mm256_setr_epi8(0, 1, 0, 1, 0, 1, 0, 1, 2, 3, 2, 3, 2, 3, 2, 3, //
                                                       4, 5, 4, 5, 4, 5, 4, 5, 6, 7, 6, 7, 6, 7, 6, 7)));
#else
        return __builtin_shufflevector(four, four, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
#endif
    }
};

/// Four times what lies behind the pixels of a row, as weights: colour and alpha.
inline Short16 behindRow(const PacketScene& s, int y) {
    if (!s.hasBackground) return Short16{};
    const float up = 1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(s.height);
    Short4 behind{0, 0, 0, asWeight(1)};
    for (int c = 0; c < 3; ++c) behind[c] = asWeight(s.background[c] + up * (s.backgroundTop[c] - s.background[c]));
    return __builtin_shufflevector(behind, behind, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
}

/// Colour times alpha, and alpha, of four pixels over what lies behind.
inline Short16 over(Short16 color, Short16 behind) {
    const Short16 limit = all16(kColorOne);
    Short16 alpha = __builtin_shufflevector(color, color, 3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15);
    alpha = alpha < limit ? alpha : limit;
    color = color < alpha ? color : alpha;
    color = color > 0 ? color : Short16{};
    return color + timesWeight(behind, limit - (alpha > 0 ? alpha : Short16{}));
}

/// A pixel as floats, wherever it lies in memory: straight colour and alpha.
struct Rgba {
    float red, green, blue, alpha;
};
inline void putPixels(Rgba* to, Short16 color, int count) {
    for (int n = 0; n < count; ++n) {
        const auto channel = [&](int c) { return static_cast<float>(color[4 * n + c]) / kColorOne; };
        const float alpha = channel(3), per = alpha > 0 ? 1 / alpha : 0;
        to[n] = {channel(0) * per, channel(1) * per, channel(2) * per, alpha};
    }
}
/// As screenPixel() has them.
inline void putPixels(std::uint32_t* to, Short16 color, int count) {
    const Short16 levels = timesWeight(color, all16(2 * 255)),
                  ordered =
                      __builtin_shufflevector(levels, levels, 2, 1, 0, 3, 6, 5, 4, 7, 10, 9, 8, 11, 14, 13, 12, 15);
    const UInt4 opaque{0xff000000u, 0xff000000u, 0xff000000u, 0xff000000u},
        pixels = opaque | reinterpret_cast<UInt4>(__builtin_convertvector(ordered, UChar16));
    __builtin_memcpy(to, &pixels, static_cast<std::size_t>(count) * sizeof *to);
}

/// Writes all pixels of a tile.
template <class Pixel>
void warpTileTo(const ShearedScene& s, const PacketTile& tile, Pixel* pixels) {
    const PacketScene& scene = *s.scene;
    for (int y = tile.y0; y < tile.y1; ++y) {
        const Short16 behind = behindRow(scene, y), empty = over(Short16{}, behind);
        Pixel* const row = pixels + static_cast<std::int64_t>(y) * scene.width;
        // Pixels x0 … x1 − 1, four at a time; color(n) is of the four from the n-th on.
        const auto fill = [&](int x0, int x1, auto color) {
            for (int x = x0; x < x1; x += 4) putPixels(row + x, color(x - x0), smaller(4, x1 - x));
        };
        const auto nothing = [&](int) { return empty; };
        if (!anyMet(s, tile.x0, tile.x1, y)) {
            fill(tile.x0, tile.x1, nothing);
            continue;
        }
        for (int x = tile.x0; x < tile.x1; x += kWide) {
            const int end = smaller(x + kWide, tile.x1);
            const WarpedRow rays(s, x, y);
            if (!rays.maybeDrawn(s)) {
                fill(x, end, nothing);
                continue;
            }
            int first[kWide];
            store(first, (rays.row - 1) * static_cast<int>(s.stride) + (rays.column - 1) * 4);
            fill(x, end, [&](int n) {
                const Int4 inside{rays.inside[n], rays.inside[n + 1], rays.inside[n + 2], rays.inside[n + 3]};
                return over(rays.fourFrom(s, first, n) &
                                reinterpret_cast<Short16>(__builtin_convertvector(inside, Long4)),
                            behind);
            });
        }
    }
}

void warpTile(const ShearedScene& s, const PacketTile& tile) {
    if (s.pixels)
        warpTileTo(s, tile, s.pixels);
    else
        warpTileTo(s, tile, reinterpret_cast<Rgba*>(s.scene->rgba));
}

} // namespace
} // namespace pellucid
