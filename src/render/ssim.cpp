#include "render/ssim.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"

namespace pellucid {

namespace {

constexpr int kRadius = 5; ///< of the window, pixels
constexpr double kDeviation = 1.5;
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;

std::vector<double> window(int pixels) {
    const int radius = std::min(kRadius, (pixels - 1) / 2);
    std::vector<double> weights;
    for (int i = -radius; i <= radius; ++i) weights.push_back(std::exp(-0.5 * i * i / (kDeviation * kDeviation)));
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& w : weights) w /= sum;
    return weights;
}

double luminance(const float* p) {
    return static_cast<double>(p[3]) * (0.2126 * static_cast<double>(p[0]) + 0.7152 * static_cast<double>(p[1]) +
                                        0.0722 * static_cast<double>(p[2]));
}

/// Windowed sums of a, b, a², b² and ab.
struct Moments {
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;

    void add(double weight, const Moments& m) {
        a += weight * m.a;
        b += weight * m.b;
        aa += weight * m.aa;
        bb += weight * m.bb;
        ab += weight * m.ab;
    }
    double similarity() const {
        const double varA = aa - a * a, varB = bb - b * b, covariance = ab - a * b;
        return (2 * a * b + kC1) * (2 * covariance + kC2) / ((a * a + b * b + kC1) * (varA + varB + kC2));
    }
};

} // namespace

double ssim(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height || a.rgba.empty() || b.rgba.empty())
        throw UsageError("the pictures differ in size, or are empty", "structural similarity",
                         "compare pictures of one size");
    const std::vector<double> across = window(a.width), down = window(a.height);
    const auto columns = static_cast<std::size_t>(a.width) - across.size() + 1,
               rows = static_cast<std::size_t>(a.height) - down.size() + 1;
    std::vector<double> sums(rows);
    parallelFor(rows, [&](std::size_t row) {
        // Down first: the sums of a column serve all windows that it lies in.
        std::vector<Moments> column(static_cast<std::size_t>(a.width));
        for (std::size_t j = 0; j < down.size(); ++j)
            for (int x = 0; x < a.width; ++x) {
                const int y = static_cast<int>(row + j);
                const double la = luminance(a.pixel(x, y)), lb = luminance(b.pixel(x, y));
                column[static_cast<std::size_t>(x)].add(down[j], {la, lb, la * la, lb * lb, la * lb});
            }
        for (std::size_t x = 0; x < columns; ++x) {
            Moments m;
            for (std::size_t i = 0; i < across.size(); ++i) m.add(across[i], column[x + i]);
            sums[row] += m.similarity();
        }
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0) / static_cast<double>(rows * columns);
}

} // namespace pellucid
