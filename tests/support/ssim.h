// How alike two pictures are.
#pragma once

#include "render/image.h"

namespace pellucid::test {

/// The structural similarity of Wang et al. (2004) of the luminance over black, mean over windows of 8×8 pixels that
/// overlap by half: 1 for equal pictures.
inline double ssim(const Image& a, const Image& b) {
    constexpr int kWindow = 8, kStride = 4;
    constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
    const auto luminance = [](const float* p) {
        return static_cast<double>(p[3]) * (0.2126 * static_cast<double>(p[0]) + 0.7152 * static_cast<double>(p[1]) +
                                            0.0722 * static_cast<double>(p[2]));
    };
    double sum = 0;
    int windows = 0;
    for (int y0 = 0; y0 + kWindow <= a.height; y0 += kStride)
        for (int x0 = 0; x0 + kWindow <= a.width; x0 += kStride, ++windows) {
            double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
            for (int y = y0; y < y0 + kWindow; ++y)
                for (int x = x0; x < x0 + kWindow; ++x) {
                    const double la = luminance(a.pixel(x, y)), lb = luminance(b.pixel(x, y));
                    ma += la;
                    mb += lb;
                    aa += la * la;
                    bb += lb * lb;
                    ab += la * lb;
                }
            constexpr double n = kWindow * kWindow;
            ma /= n;
            mb /= n;
            const double va = aa / n - ma * ma, vb = bb / n - mb * mb, cov = ab / n - ma * mb;
            sum += (2 * ma * mb + kC1) * (2 * cov + kC2) / ((ma * ma + mb * mb + kC1) * (va + vb + kC2));
        }
    return windows == 0 ? 1 : sum / windows;
}

} // namespace pellucid::test
