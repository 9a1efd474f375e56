#include "tf/overlay_look.h"

#include <algorithm>
#include <cmath>

#include "tf/tf_range.h"
#include "volume/robust_range.h"
#include "volume/voxel_survey.h"

namespace pellucid {

namespace {

/// Of the values that are not 0, on either side of it, where a map has two sides.
constexpr double kLeastSide = 0.05;
/// Of the magnitudes of a map with two sides: so many lie below the threshold, and so many below the top.
constexpr double kThresholdAt = 0.95, kTopAt = 0.999;
constexpr double kThresholdOfLargest = 0.1;
/// Of the top, at least, where a map has two sides: smooth maps are nearly 0 nearly everywhere.
constexpr double kLeastThresholdOfTop = 0.25;
constexpr int kColors = 32;      ///< pieces of the colour map on either side
constexpr double kBeyond = 1e-7; ///< of the range of values: that far beyond the threshold drawing begins

double withTwoDigits(double value) {
    if (value == 0) return 0;
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 1);
    return std::round(value / unit) * unit;
}

OverlayLook rounded(const OverlayLook& look) {
    const OverlayLook round{look.twoSided, withTwoDigits(look.threshold), withTwoDigits(look.top)};
    return round.threshold < round.top ? round : look;
}

/// A value, or its distance from 0, and its opacity as a part of the largest.
struct LookPoint {
    double value, opacity;
};

/// From the threshold on, outward.
std::vector<LookPoint> pointsOf(const OverlayLook& look, double step) {
    const double threshold = look.twoSided ? std::max(0.0, look.threshold) : look.threshold;
    const double first = threshold + step, last = std::max(look.top, first + step);
    std::vector<LookPoint> points{{first, 0}};
    for (int i = 0; i <= kColors; ++i) {
        const double part = static_cast<double>(i) / kColors;
        points.push_back({std::lerp(first, last, part), 0.5 + 0.5 * part});
    }
    return points;
}

/// Whether no fewer of these distances lie near 0 than near the largest: as of a map of differences, not of a CT, whose
/// air is all on one end.
bool fallsFromZero(std::vector<double>& distances) {
    std::ranges::sort(distances);
    const double third = quantile(distances, kTopAt) / 3;
    const auto upTo = [&](double value) { return std::ranges::upper_bound(distances, value) - distances.begin(); };
    return upTo(third) >= static_cast<std::ptrdiff_t>(distances.size()) - upTo(2 * third);
}

} // namespace

OverlayLook oneSidedLook(const ValueRange& values) {
    const double from = values.hi > 0 ? 0 : values.lo;
    return rounded({false, std::lerp(from, values.hi, kThresholdOfLargest), values.hi});
}

OverlayLook twoSidedLook(const ValueRange& values) {
    const double largest = std::max(std::abs(values.lo), std::abs(values.hi));
    return rounded({true, kThresholdOfLargest * largest, largest});
}

OverlayLook usualLook(const Volume& volume, const JobControl& job) {
    std::vector<double> above, below; // distances from 0
    for (const double v : surveyVoxels(volume, {job.stop, {}}).values) {
        if (!std::isfinite(v) || v == 0) continue;
        (v > 0 ? above : below).push_back(std::abs(v));
    }
    std::vector<double> magnitudes = above;
    magnitudes.insert(magnitudes.end(), below.begin(), below.end());
    const auto least = static_cast<std::size_t>(kLeastSide * static_cast<double>(magnitudes.size()));
    if (std::min(above.size(), below.size()) <= least || !fallsFromZero(above) || !fallsFromZero(below))
        return oneSidedLook(volume.dataRange());
    std::ranges::sort(magnitudes);
    const double top = quantile(magnitudes, kTopAt);
    return rounded({true, std::max(quantile(magnitudes, kThresholdAt), kLeastThresholdOfTop * top), top});
}

const ColorMap& usualColorMap(const OverlayLook& look) { return colorMapNamed(look.twoSided ? "blue-red" : "ember"); }

TransferFunction overlayTf(const OverlayLook& look, const ColorMap& colors, double opacity, const ValueRange& range) {
    const std::vector<LookPoint> points = pointsOf(look, kBeyond * (range.hi - range.lo));
    const double last = points.back().value, base = look.twoSided ? 0 : std::min(0.0, points.front().value);
    const bool bothWays = look.twoSided && colors.kind == ColorMap::Kind::Diverging;
    TransferFunction tf;
    const ValueRange window{look.twoSided ? -last : base, last};
    tf.range = window;
    const auto add = [&](const LookPoint& p, double sign) {
        const double part = (p.value - base) / (last - base);
        const Rgb color = colors.colorAt(bothWays ? 0.5 + 0.5 * sign * part : part);
        const double x = (sign * p.value - window.lo) / (window.hi - window.lo);
        tf.points.push_back({std::clamp(x, 0.0, 1.0), opacity * p.opacity, color, false, {}});
    };
    if (look.twoSided)
        for (std::size_t i = points.size(); i-- > 0;) add(points[i], -1);
    for (const LookPoint& p : points) add(p, 1);
    return inRange(tf, range);
}

} // namespace pellucid
