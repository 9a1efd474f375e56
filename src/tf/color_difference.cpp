#include "tf/color_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "tf/lch.h"

namespace pellucid {

namespace {

/// Linear light of the 256 values that a screen has.
const std::array<double, 256>& screenLight() {
    static const std::array<double, 256> kLight = [] {
        std::array<double, 256> light{};
        for (std::size_t i = 0; i < light.size(); ++i) light[i] = linearFromSrgb(static_cast<double>(i) / 255);
        return light;
    }();
    return kLight;
}

std::array<std::size_t, 3> shown(const float* pixel) {
    std::array<std::size_t, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double v = static_cast<double>(pixel[c]) * static_cast<double>(pixel[3]);
        out[c] = v > 0 ? static_cast<std::size_t>(std::lround(std::min(v, 1.0) * 255)) : 0; // NaN: 0
    }
    return out;
}

/// Of two pixels as a screen shows them.
double differenceOf(const float* a, const float* b) {
    const auto p = shown(a), q = shown(b);
    if (p == q) return 0;
    const auto& light = screenLight();
    return deltaE(labFromLinear({light[p[0]], light[p[1]], light[p[2]]}),
                  labFromLinear({light[q[0]], light[q[1]], light[q[2]]}));
}

void requireOneSize(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height)
        throw Error("the pictures differ in size", "colour difference", "draw them in one size");
}

} // namespace

double meanDeltaE(const Image& a, const Image& b) {
    requireOneSize(a, b);
    if (a.rgba.empty()) return 0;
    std::vector<double> rows(static_cast<std::size_t>(a.height), 0.0);
    parallelFor(rows.size(), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < a.width; ++x) rows[row] += differenceOf(a.pixel(x, y), b.pixel(x, y));
    });
    double sum = 0;
    for (const double row : rows) sum += row;
    return sum / (static_cast<double>(a.width) * a.height);
}

Plane deltaEOf(const Image& a, const Image& b) {
    requireOneSize(a, b);
    Plane difference(a.width, a.height);
    parallelFor(static_cast<std::size_t>(a.height), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < a.width; ++x)
            difference.row(y)[x] = static_cast<float>(differenceOf(a.pixel(x, y), b.pixel(x, y)));
    });
    return difference;
}

std::vector<double> labPixels(const Image& image) {
    std::vector<double> out(image.rgba.size() / 4 * 3);
    const std::size_t width = static_cast<std::size_t>(image.width);
    parallelFor(static_cast<std::size_t>(image.height), [&](std::size_t row) {
        for (std::size_t pixel = row * width; pixel < (row + 1) * width; ++pixel) {
            const float* p = &image.rgba[4 * pixel];
            const auto light = [&](int c) {
                return linearFromSrgb(static_cast<double>(p[c]) * static_cast<double>(p[3]));
            };
            const auto [l, a, b] = labFromLinear({light(0), light(1), light(2)});
            out[3 * pixel] = l;
            out[3 * pixel + 1] = a;
            out[3 * pixel + 2] = b;
        }
    });
    return out;
}

} // namespace pellucid
