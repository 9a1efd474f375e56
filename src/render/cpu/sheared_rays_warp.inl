// From the grid of rays to the picture: each pixel by Catmull and Rom's cubic between 4×4 rays.
#pragma once

#include "render/cpu/ray_packets_samples.inl"
#include "render/cpu/sheared_rays.h"

namespace pellucid {
namespace {

/// Weights of four neighbours for a place `f` of the way from the second to the third; their sum is 1.
inline Vec4 cubicWeights(float f) {
    const float g = 1 - f;
    const Vec4 outer{-f * g * g, 0, 0, -g * f * f};
    const float third = f * (f * (2 - 1.5f * f) + 0.5f), second = g * (g * (2 - 1.5f * g) + 0.5f);
    return 0.5f * outer + Vec4{0, second, third, 0};
}

/// Straight colour and alpha of a pixel over what lies behind it.
inline Vec4 overBackground(const PacketScene& s, int y, Vec4 color) {
    const float clear = 1 - color[3];
    if (s.hasBackground) {
        const float up = 1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(s.height);
        for (int c = 0; c < 3; ++c) color[c] += clear * (s.background[c] + up * (s.backgroundTop[c] - s.background[c]));
        color[3] = 1;
    } else if (color[3] > 0) {
        const float alpha = color[3];
        color /= alpha;
        color[3] = alpha;
    }
    return color;
}

inline Vec4 rayAt(const float* p) {
    Vec4 v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}

void warpTile(const ShearedScene& s, const PacketTile& tile) {
    const PacketScene& scene = *s.scene;
    const auto ofPixel = [&](int n, float x, float y) {
        return s.ofPixel[n][0] + s.ofPixel[n][1] * x + s.ofPixel[n][2] * y;
    };
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) {
            const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
            const float below = ofPixel(2, px, py), i = ofPixel(0, px, py) / below, j = ofPixel(1, px, py) / below;
            Vec4 color{};
            const bool inside = below > 0 && i >= 1 && j >= 1 && i < static_cast<float>(s.width - 2) &&
                                j < static_cast<float>(s.height - 2);
            const int column = inside ? static_cast<int>(i) : 0, row = inside ? static_cast<int>(j) : 0;
            if (inside && column + 2 >= s.extents[2 * row] && column - 1 <= s.extents[2 * row + 1]) {
                const Vec4 across = cubicWeights(i - static_cast<float>(column)),
                           downward = cubicWeights(j - static_cast<float>(row));
                const float* from = s.rgba + (row - 1) * s.stride + 4 * (column - 1);
                for (int r = 0; r < 4; ++r, from += s.stride)
                    color += downward[r] * (across[0] * rayAt(from) + across[1] * rayAt(from + 4) +
                                            across[2] * rayAt(from + 8) + across[3] * rayAt(from + 12));
                // A cubic may overshoot.
                color = color > 0 ? color : Vec4{};
                const float alpha = color[3] < 1 ? color[3] : 1;
                const Vec4 limit = Vec4{} + alpha;
                color = color < limit ? color : limit;
            }
            color = overBackground(scene, y, color);
            __builtin_memcpy(scene.rgba + 4 * (static_cast<std::int64_t>(y) * scene.width + x), &color, sizeof color);
        }
}

} // namespace
} // namespace pellucid
