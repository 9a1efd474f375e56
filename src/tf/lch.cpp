#include "tf/lch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid {

namespace {

double labCurveInverse(double f) {
    constexpr double kDelta = 6.0 / 29.0;
    return f > kDelta ? f * f * f : 3 * kDelta * kDelta * (f - 4.0 / 29.0);
}

/// Linear light; outside [0,1] where sRGB does not have the colour.
Rgb linearFromLch(const Lch& lch) {
    const double radians = lch.hueDegrees * std::numbers::pi / 180;
    const double fy = (lch.lightness + 16) / 116;
    const double fx = fy + lch.chroma * std::cos(radians) / 500, fz = fy - lch.chroma * std::sin(radians) / 200;
    const double x = labCurveInverse(fx) * (0.4124564 + 0.3575761 + 0.1804375);
    const double y = labCurveInverse(fy) * (0.2126729 + 0.7151522 + 0.0721750);
    const double z = labCurveInverse(fz) * (0.0193339 + 0.1191920 + 0.9503041);
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

bool isLight(const Rgb& linear) {
    constexpr double kRounding = 1e-6;
    const auto fits = [](double v) { return v >= -kRounding && v <= 1 + kRounding; };
    return fits(linear.r) && fits(linear.g) && fits(linear.b);
}

} // namespace

double labCurve(double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29.0;
}

double linearFromSrgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
double srgbFromLinear(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

Rgb srgbFromLch(const Lch& wanted) {
    Lch lch = wanted;
    lch.lightness = std::clamp(lch.lightness, 0.0, 100.0);
    if (!isLight(linearFromLch(lch))) {
        double inside = 0, outside = lch.chroma;
        for (int i = 0; i < 40; ++i) {
            lch.chroma = (inside + outside) / 2;
            (isLight(linearFromLch(lch)) ? inside : outside) = lch.chroma;
        }
        lch.chroma = inside;
    }
    const Rgb linear = linearFromLch(lch);
    const auto encoded = [](double v) { return std::clamp(srgbFromLinear(std::clamp(v, 0.0, 1.0)), 0.0, 1.0); };
    return {encoded(linear.r), encoded(linear.g), encoded(linear.b)};
}

Lab labFromLinear(const Rgb& linear) {
    const auto [r, g, b] = linear;
    // The sRGB primaries under D65, each row divided by its own sum, which is the white point's X, Y or Z: so white
    // gives L* = 100 and C* = 0 exactly.
    const double fx = labCurve((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / (0.4124564 + 0.3575761 + 0.1804375));
    const double fy = labCurve((0.2126729 * r + 0.7151522 * g + 0.0721750 * b) / (0.2126729 + 0.7151522 + 0.0721750));
    const double fz = labCurve((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / (0.0193339 + 0.1191920 + 0.9503041));
    return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

Lab labFromSrgb(const Rgb& srgb) {
    return labFromLinear({linearFromSrgb(srgb.r), linearFromSrgb(srgb.g), linearFromSrgb(srgb.b)});
}

double deltaE(const Lab& p, const Lab& q) {
    const double l = p.lightness - q.lightness, a = p.a - q.a, b = p.b - q.b;
    return std::sqrt(l * l + a * a + b * b);
}

Lch lchFromSrgb(const Rgb& srgb) {
    const Lab lab = labFromSrgb(srgb);
    Lch lch;
    lch.lightness = lab.lightness;
    lch.chroma = std::hypot(lab.a, lab.b);
    lch.hueDegrees = std::fmod(std::atan2(lab.b, lab.a) * 180 / std::numbers::pi + 360.0, 360.0);
    return lch;
}

} // namespace pellucid
