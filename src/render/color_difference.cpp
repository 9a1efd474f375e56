#include "render/color_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "tf/lch.h"

namespace pellucid {

namespace {

using Lab = std::array<double, 3>;

Lab labOfLinear(double r, double g, double b) {
    const double x = (0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / (0.4124564 + 0.3575761 + 0.1804375);
    const double y = (0.2126729 * r + 0.7151522 * g + 0.0721750 * b) / (0.2126729 + 0.7151522 + 0.0721750);
    const double z = (0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / (0.0193339 + 0.1191920 + 0.9503041);
    const double fx = labCurve(x), fy = labCurve(y), fz = labCurve(z);
    return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

double distance(const Lab& p, const Lab& q) {
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) square += (p[c] - q[c]) * (p[c] - q[c]);
    return std::sqrt(square);
}

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

} // namespace

double meanDeltaE(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height)
        throw Error("the pictures differ in size", "colour difference", "draw them in one size");
    if (a.rgba.empty()) return 0;
    const auto& light = screenLight();
    std::vector<double> rows(static_cast<std::size_t>(a.height), 0.0);
    parallelFor(rows.size(), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < a.width; ++x) {
            const auto p = shown(a.pixel(x, y)), q = shown(b.pixel(x, y));
            if (p == q) continue;
            rows[row] += distance(labOfLinear(light[p[0]], light[p[1]], light[p[2]]),
                                  labOfLinear(light[q[0]], light[q[1]], light[q[2]]));
        }
    });
    double sum = 0;
    for (const double row : rows) sum += row;
    return sum / (static_cast<double>(a.width) * a.height);
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
            const Lab lab = labOfLinear(light(0), light(1), light(2));
            std::copy(lab.begin(), lab.end(), &out[3 * pixel]);
        }
    });
    return out;
}

} // namespace pellucid
