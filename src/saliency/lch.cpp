#include "saliency/lch.h"

#include <cmath>
#include <numbers>

namespace pellucid {

namespace {

double linearFromSrgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

double labCurve(double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29.0;
}

} // namespace

Lch lchFromSrgb(const Rgb& srgb) {
    const double r = linearFromSrgb(srgb.r), g = linearFromSrgb(srgb.g), b = linearFromSrgb(srgb.b);
    // The sRGB primaries under D65, each row divided by its own sum, which is the white point's X, Y or Z: so white
    // gives L* = 100 and C* = 0 exactly.
    const double fx = labCurve((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / (0.4124564 + 0.3575761 + 0.1804375));
    const double fy = labCurve((0.2126729 * r + 0.7151522 * g + 0.0721750 * b) / (0.2126729 + 0.7151522 + 0.0721750));
    const double fz = labCurve((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / (0.0193339 + 0.1191920 + 0.9503041));
    const double aStar = 500 * (fx - fy), bStar = 200 * (fy - fz);
    Lch lch;
    lch.lightness = 116 * fy - 16;
    lch.chroma = std::hypot(aStar, bStar);
    lch.hueDegrees = std::fmod(std::atan2(bStar, aStar) * 180 / std::numbers::pi + 360.0, 360.0);
    return lch;
}

Appearance appearanceOf(const Rgb& srgb) {
    const Lch lch = lchFromSrgb(srgb);
    return {lch.lightness / 100, lch.chroma / 100};
}

} // namespace pellucid
