// Distance factors of the control points (docs/method.md, "Entropy refinement", (3.6) and (3.10) to (3.11)).
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "optimize/refine/refine.h"

namespace pellucid {

namespace {

/// A place in the HSV cylinder: S cos H, S sin H, V.
using CylinderPlace = std::array<double, 3>;

CylinderPlace placeOf(const Rgb& color) {
    const Hsv hsv = hsvFromRgb(color);
    const double hue = hsv.hueDegrees * std::numbers::pi / 180;
    return {hsv.saturation * std::cos(hue), hsv.saturation * std::sin(hue), hsv.value};
}

/// D(R, i) (3.10).
double distanceToRegion(const CylinderPlace& point, const std::vector<std::pair<CylinderPlace, double>>& region) {
    double sum = 0;
    for (const auto& [place, count] : region) {
        const double a = place[0] - point[0], b = place[1] - point[1], c = place[2] - point[2];
        sum += count * std::sqrt(a * a + b * b + c * c);
    }
    return sum;
}

std::vector<double> regionFactors(const TransferFunction& tf, const std::vector<ControlPoint>& all,
                                  const std::vector<RegionColor>& colors) {
    std::vector<std::pair<CylinderPlace, double>> region;
    region.reserve(colors.size());
    for (const RegionColor& c : colors) region.emplace_back(placeOf(c.color), c.count);
    std::vector<double> factors;
    for (std::size_t i = 0; i < all.size(); ++i)
        // The two sides of a tent, and an added end and its neighbour, have one colour.
        factors.push_back(i > 0 && all[i].color == all[i - 1].color ? factors.back()
                                                                    : distanceToRegion(placeOf(all[i].color), region));
    const std::size_t firstOwn = tf.points.empty() || tf.points.front().x > 0 ? 1 : 0;
    double sum = 0; // over the user's points (3.11)
    for (std::size_t i = 0; i < tf.points.size(); ++i) sum += factors[i + firstOwn];
    const double n = static_cast<double>(std::max<std::size_t>(tf.points.size(), 1));
    for (double& f : factors) f = sum > 0 ? f / sum : 1 / n;
    return factors;
}

/// Of the published profile: hues in turns, the way round 0 counted as far as it is; 1 where one of them is grey.
double plainHueDistance(const Hsv& a, const Hsv& b) {
    if (!(a.saturation > 0) || !(b.saturation > 0)) return 1;
    return std::abs(a.hueDegrees - b.hueDegrees) / 360;
}

/// Distances of all points over their sum; where all are 0, as regionFactors() has it.
std::vector<double> publishedFactors(const std::vector<ControlPoint>& all, const RefinePriority& priority) {
    std::vector<std::pair<Hsv, double>> region;
    for (const RegionColor& c : priority.region) region.emplace_back(hsvFromRgb(c.color), c.count);
    std::vector<double> factors;
    double sum = 0;
    for (const ControlPoint& p : all) {
        double distance = priority.intensity ? std::abs(*priority.intensity - p.x) : 0;
        for (const auto& [hsv, count] : region) distance += count * plainHueDistance(hsv, hsvFromRgb(p.color));
        factors.push_back(distance);
        sum += distance;
    }
    for (double& f : factors) f = sum > 0 ? f / sum : 1 / static_cast<double>(all.size());
    return factors;
}

double hueDistance(double a, double b) {
    const double d = std::fmod(std::abs(a - b), 360.0);
    return std::min(d, 360.0 - d);
}

} // namespace

std::vector<double> pointFactors(const TransferFunction& tf, const RefinePriority& priority, Profile profile) {
    RefineOptions options;
    options.priority = priority;
    options.validate();
    const std::vector<ControlPoint> all = tf.pointsWithEnds();
    if (profile == Profile::Published && priority.any()) return publishedFactors(all, priority);
    if (!priority.region.empty()) return regionFactors(tf, all, priority.region);
    std::vector<double> factors;
    for (const ControlPoint& p : all) factors.push_back(priority.intensity ? std::abs(*priority.intensity - p.x) : 1.0);
    return factors;
}

double intensityOfHue(const TransferFunction& tf, double hueDegrees) {
    hueDegrees = std::fmod(std::fmod(hueDegrees, 360.0) + 360.0, 360.0);
    // The control points themselves, and places between them closer than a bin of 16-bit data is to a colour of 8 bits.
    constexpr int kPlaces = 4096;
    constexpr double kSame = 1e-9; // degrees; hues of one colour that was mixed of itself
    std::vector<double> places;
    for (const ControlPoint& p : tf.points) places.push_back(p.x);
    for (int i = 0; i <= kPlaces; ++i) places.push_back(static_cast<double>(i) / kPlaces);
    std::ranges::sort(places);

    const TfSampler sampler(tf);
    double best = -1, bestDistance = 0, bestOpacity = 0;
    for (const double x : places) {
        const Hsv hsv = hsvFromRgb(sampler.color(x));
        if (!(hsv.saturation > 0 && hsv.value > 0)) continue;
        const double distance = hueDistance(hsv.hueDegrees, hueDegrees), opacity = sampler.opacity(x);
        const bool nearer = best < 0 || distance < bestDistance - kSame;
        if (!nearer && !(distance <= bestDistance + kSame && opacity > bestOpacity)) continue;
        best = x;
        bestDistance = distance;
        bestOpacity = opacity;
    }
    if (best < 0)
        throw Error("no colour has a hue", "transfer function", "prioritize an intensity, or give it colours");
    return best;
}

} // namespace pellucid
