#include "tf/color_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "tf/edit.h"
#include "tf/lch.h"
#include "tf/shapes.h"

namespace pellucid {

namespace {

double between(double from, double to, double t) { return from + (to - from) * t; }

Rgb hueMap(double t) { return rgbFromHsv(360 * t, 1, 1); }
Rgb grey(double t) { return srgbFromLch({100 * t, 0, 0}); }

// Lightness rises evenly; hue turns meanwhile; chroma swells towards the middle, where sRGB has room for it.
Rgb spiral(double t) {
    return srgbFromLch({between(16, 92, t), 28 + 16 * std::sin(std::numbers::pi * t) + 8 * t, between(305, 100, t)});
}
Rgb ember(double t) {
    return srgbFromLch({between(10, 95, t), 18 + 48 * std::sin(std::numbers::pi * t), between(285, 455, t)});
}
// Eyes without red or green cones tell blue from yellow, and lightness: nothing else changes here.
Rgb sand(double t) {
    const double aStar = between(8, -4, t), bStar = between(-36, 52, t);
    return srgbFromLch(
        {between(16, 92, t), std::hypot(aStar, bStar), std::atan2(bStar, aStar) * 180 / std::numbers::pi});
}

Rgb diverging(double t, double hueBelow, double hueAbove, double chroma) {
    const double away = std::abs(2 * t - 1);
    return srgbFromLch({between(95, 42, away), chroma * away, t < 0.5 ? hueBelow : hueAbove});
}
Rgb blueOrange(double t) { return diverging(t, 265, 60, 42); }
Rgb blueRed(double t) { return diverging(t, 272, 28, 46); }

/// Linear light as eyes without one kind of cone have it (Machado, Oliveira and Fernandes 2009, severity 1).
using Matrix = std::array<std::array<double, 3>, 3>;
constexpr Matrix kProtanopia{
    {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}};
constexpr Matrix kDeuteranopia{
    {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}};

Rgb seen(const Rgb& color, const Matrix& m) {
    const std::array<double, 3> in{linearFromSrgb(color.r), linearFromSrgb(color.g), linearFromSrgb(color.b)};
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = srgbFromLinear(std::clamp(m[i][0] * in[0] + m[i][1] * in[1] + m[i][2] * in[2], 0.0, 1.0));
    return {out[0], out[1], out[2]};
}

/// The least ΔE of the three kinds of eyes.
double safeDifference(const Rgb& a, const Rgb& b) {
    return std::min({colorDifference(a, b), colorDifference(seen(a, kProtanopia), seen(b, kProtanopia)),
                     colorDifference(seen(a, kDeuteranopia), seen(b, kDeuteranopia))});
}

/// The candidate whose least difference from all of `present` is largest.
template <class Difference>
Rgb farthestFrom(const std::vector<Rgb>& present, const std::vector<Rgb>& candidates, const Difference& difference) {
    double most = -1;
    Rgb best;
    for (const Rgb& candidate : candidates) {
        double least = 1e9;
        for (const Rgb& other : present) least = std::min(least, difference(candidate, other));
        if (least <= most) continue;
        most = least;
        best = candidate;
    }
    return best;
}

constexpr std::size_t kCategories = 8;
constexpr double kWholeEyes = 0.5;

/// Each colour is the one of a grid of calm ones that is farthest from those before it; the first is a blue. Eyes that
/// see all colours expect more of a difference than those to whom lightness and blue or yellow are all there is.
const std::vector<Rgb>& categories() {
    static const std::vector<Rgb> kColors = [] {
        constexpr double kChroma = 46;
        std::vector<Rgb> candidates;
        for (const double lightness : {44.0, 53.0, 62.0, 71.0, 80.0})
            for (int hue = 0; hue < 360; hue += 10) {
                const Rgb color = srgbFromLch({lightness, kChroma, 1.0 * hue});
                if (lchFromSrgb(color).chroma > 0.9 * kChroma) candidates.push_back(color); // sRGB has it
            }
        std::vector<Rgb> chosen{srgbFromLch({53, kChroma, 270})};
        const auto difference = [](const Rgb& a, const Rgb& b) {
            return std::min(safeDifference(a, b), kWholeEyes * colorDifference(a, b));
        };
        while (chosen.size() < kCategories) chosen.push_back(farthestFrom(chosen, candidates, difference));
        return chosen;
    }();
    return kColors;
}

Rgb categorical(double t) {
    const auto i = static_cast<std::size_t>(t * static_cast<double>(kCategories));
    return categories()[std::min(i, kCategories - 1)];
}

Rgb inverted(const Rgb& color) {
    Lch lch = lchFromSrgb(color);
    lch.lightness = 100 - lch.lightness;
    return srgbFromLch(lch);
}

/// Features by intensity.
std::vector<int> ascending(const TransferFunction& tf) {
    std::vector<int> order(tf.features.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, [&](int f) { return tf.features[static_cast<std::size_t>(f)].a; });
    return order;
}

void colorFeaturesByPeaks(TransferFunction& tf) {
    const auto opacityOf = [&](int i) { return tf.points[static_cast<std::size_t>(i)].opacity; };
    for (std::size_t f = 0; f < tf.features.size(); ++f) {
        Feature& feature = tf.features[f];
        const std::vector<int> own = pointsOfFeature(tf, static_cast<int>(f));
        const auto peak = std::ranges::max_element(own, {}, opacityOf);
        feature.color = peak == own.end() ? tf.color((feature.a + feature.b) / 2)
                                          : tf.points[static_cast<std::size_t>(*peak)].color;
    }
}

/// Appends the points that the line from p to q needs between them, by intensity.
template <class ColorAt>
void refineSegment(const ControlPoint& p, const ControlPoint& q, const ColorAt& colorAt,
                   std::vector<ControlPoint>& points) {
    // Sixths and halves, where maps have their corners, are among the places that are tried.
    constexpr double kPlaces = 768;
    double worst = kColorTolerance, place = -1;
    for (double i = std::floor(p.x * kPlaces) + 1; i / kPlaces < q.x; ++i) {
        const double x = i / kPlaces;
        if (x <= p.x) continue;
        const double t = (x - p.x) / (q.x - p.x);
        const Rgb line{between(p.color.r, q.color.r, t), between(p.color.g, q.color.g, t),
                       between(p.color.b, q.color.b, t)};
        const double error = colorDifference(line, colorAt(x));
        if (error <= worst) continue;
        worst = error;
        place = x;
    }
    if (place < 0) return;
    const double t = (place - p.x) / (q.x - p.x);
    const ControlPoint added{place, between(p.opacity, q.opacity, t), colorAt(place), p.fixed && q.fixed, {}};
    refineSegment(p, added, colorAt, points);
    points.push_back(added);
    refineSegment(added, q, colorAt, points);
}

} // namespace

std::span<const ColorMap> colorMaps() {
    using Kind = ColorMap::Kind;
    static const std::array<ColorMap, 8> kMaps{{
        {"hue", "Hue spectrum, as in the thesis", Kind::Hue, false, hueMap},
        {"spiral", "Viridis-like: violet, green, yellow", Kind::Sequential, true, spiral},
        {"ember", "Inferno-like: violet, red, yellow", Kind::Sequential, true, ember},
        {"sand", "Cividis-like: blue to yellow, safe for colour-blind viewers", Kind::Sequential, true, sand},
        {"grey", "Black to white in even steps of lightness", Kind::Sequential, true, grey},
        {"blue-orange", "Blue, white in the middle, orange", Kind::Diverging, true, blueOrange},
        {"blue-red", "Blue, white in the middle, red", Kind::Diverging, true, blueRed},
        {"categorical", "One colour per feature, safe for colour-blind viewers", Kind::Categorical, true, categorical},
    }};
    return kMaps;
}

const ColorMap& colorMapNamed(const std::string& name) {
    const std::span<const ColorMap> maps = colorMaps();
    if (const auto map = std::ranges::find(maps, name, &ColorMap::name); map != maps.end()) return *map;
    throw UsageError("there is no colour map '" + name + "'", "",
                     "choose one of " + joined(maps, ", ", &ColorMap::name));
}

Rgb colorOf(const ColorMap& map, double t, const ColorMapOptions& options) {
    t = std::clamp(t, 0.0, 1.0);
    const Rgb color = map.colorAt(options.reversed ? 1 - t : t);
    return options.inverted ? inverted(color) : color;
}

double colorDifference(const Rgb& a, const Rgb& b) {
    const Lch p = lchFromSrgb(a), q = lchFromSrgb(b);
    const double radians = std::numbers::pi / 180;
    return std::hypot(p.lightness - q.lightness,
                      p.chroma * std::cos(p.hueDegrees * radians) - q.chroma * std::cos(q.hueDegrees * radians),
                      p.chroma * std::sin(p.hueDegrees * radians) - q.chroma * std::sin(q.hueDegrees * radians));
}

TransferFunction withColorMap(const TransferFunction& tf, const ColorMap& map, const ColorMapOptions& options) {
    TransferFunction result = tf;
    if (options.overFeatures || map.kind == ColorMap::Kind::Categorical) {
        const std::vector<int> order = ascending(tf);
        for (std::size_t k = 0; k < order.size(); ++k) {
            // A categorical map gives its colours one after the other, and begins anew after the last.
            const bool categories = map.kind == ColorMap::Kind::Categorical;
            const double n = categories ? static_cast<double>(kCategories) : static_cast<double>(order.size());
            const double place = static_cast<double>(categories ? k % kCategories : k);
            const Rgb color = colorOf(map, (place + 0.5) / n, options);
            result = withFeatureColor(result, order[k], color);
        }
        return result;
    }
    const auto colorAt = [&](double x) { return colorOf(map, x, options); };
    for (ControlPoint& p : result.points) p.color = colorAt(p.x);
    std::vector<ControlPoint> points;
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        const ControlPoint& q = result.points[i];
        if (i > 0) {
            const ControlPoint& p = result.points[i - 1];
            if (p.x < q.x && (p.opacity > 0 || q.opacity > 0)) refineSegment(p, q, colorAt, points);
        }
        points.push_back(q);
    }
    result.points = std::move(points);
    colorFeaturesByPeaks(result);
    result.validate();
    return result;
}

TransferFunction withColorsReversed(const TransferFunction& tf) {
    TransferFunction result = tf;
    for (ControlPoint& p : result.points) p.color = tf.color(1 - p.x);
    colorFeaturesByPeaks(result);
    return result;
}

TransferFunction withColorsInverted(const TransferFunction& tf) {
    TransferFunction result = tf;
    for (ControlPoint& p : result.points) p.color = inverted(p.color);
    for (Feature& f : result.features) f.color = inverted(f.color);
    return result;
}

Rgb colorApartFrom(const std::vector<Rgb>& present) { return farthestFrom(present, categories(), safeDifference); }

} // namespace pellucid
