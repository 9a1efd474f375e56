#include "tf/transfer_function.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "tf/change_opacities.h"

namespace pellucid {

namespace {

Rgb mix(const Rgb& a, const Rgb& b, double t) {
    return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

bool inUnit(double v) { return v >= 0.0 && v <= 1.0; } // false for NaN too

/// α just left of x (the first of the points that share x).
double opacityBefore(const TransferFunction& tf, double x) {
    const std::vector<ControlPoint> points = tf.pointsWithEnds();
    const auto first = std::ranges::find(points, x, &ControlPoint::x);
    return first != points.end() ? first->opacity : tf.opacity(x);
}

double peakOf(const TransferFunction& tf, const Feature& f) {
    double peak = std::max(tf.opacity(f.a), opacityBefore(tf, f.b));
    if (f.b >= 1.0) peak = std::max(peak, tf.opacity(1.0));
    for (const ControlPoint& p : tf.points)
        if (p.x > f.a && p.x < f.b) peak = std::max(peak, p.opacity);
    return peak;
}

/// Makes x a step (two points that share it), so that its two sides can be scaled apart. α(·) stays as it is.
void splitAt(TransferFunction& tf, double x) {
    const auto first = std::ranges::lower_bound(tf.points, x, {}, &ControlPoint::x);
    const auto last = std::ranges::upper_bound(tf.points, x, {}, &ControlPoint::x);
    if (last - first >= 2) return;
    const bool any = first != last;
    const ControlPoint p = any ? *first : ControlPoint{x, tf.opacity(x), tf.color(x), false, {}};
    tf.points.insert(first, any ? 1 : 2, p);
}

bool isMovableInside(const ControlPoint& p, const Feature& f) { return p.x > f.a && p.x < f.b && !p.fixed; }

void raiseFlatFeature(TransferFunction& tf, const Feature& f, double opacity) {
    bool any = false;
    for (ControlPoint& p : tf.points)
        if (isMovableInside(p, f)) {
            p.opacity = opacity;
            any = true;
        }
    if (!any && opacity > 0)
        throw Error("feature '" + f.name + "' has no movable control point inside its interval", "",
                    "add one, or give it an opacity above 0");
}

template <class Number>
Number parseNumber(const std::string& text, const std::string& spec) {
    Number value{};
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (ec != std::errc{} || end != text.data() + text.size())
        throw UsageError("'" + text + "' is not a number", "transfer function '" + spec + "'",
                         "write tents:N[:PEAK] or ramp:N");
    return value;
}

} // namespace

int featureAt(std::span<const Feature> features, double s) {
    const auto found = std::ranges::find_if(features, [s](const Feature& f) { return f.contains(s); });
    return found == features.end() ? -1 : static_cast<int>(found - features.begin());
}

std::vector<ControlPoint> TransferFunction::pointsWithEnds() const {
    std::vector<ControlPoint> all;
    all.reserve(points.size() + 2);
    const Rgb black;
    if (points.empty() || points.front().x > 0.0)
        all.push_back({0.0, 0.0, points.empty() ? black : points.front().color, true, {}});
    all.insert(all.end(), points.begin(), points.end());
    if (points.empty() || points.back().x < 1.0)
        all.push_back({1.0, 0.0, points.empty() ? black : points.back().color, true, {}});
    return all;
}

double TransferFunction::opacity(double s) const { return TfSampler(*this).opacity(s); }
Rgb TransferFunction::color(double s) const { return TfSampler(*this).color(s); }

void TransferFunction::validate() const {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::string place = "/points/" + std::to_string(i);
        if (!inUnit(points[i].x))
            throw Error("the position is outside [0,1]", place + "/x", "use normalised intensities");
        if (!inUnit(points[i].opacity)) throw Error("the opacity is outside [0,1]", place + "/opacity", "correct it");
        const Rgb& c = points[i].color;
        if (!inUnit(c.r) || !inUnit(c.g) || !inUnit(c.b))
            throw Error("the colour is outside [0,1]", place + "/color", "correct it");
        if (i > 0 && points[i].x < points[i - 1].x)
            throw Error("points are not sorted by x", place + "/x", "sort them");
    }
    for (std::size_t i = 0; i < features.size(); ++i) {
        const std::string place = "/features/" + std::to_string(i) + "/range";
        const Feature& f = features[i];
        if (!inUnit(f.a) || !inUnit(f.b) || !(f.a < f.b))
            throw Error("a feature needs 0 <= a < b <= 1", place, "correct it");
        for (std::size_t j = 0; j < i; ++j)
            if (std::max(f.a, features[j].a) < std::min(f.b, features[j].b))
                throw Error("features '" + features[j].name + "' and '" + f.name + "' overlap", place,
                            "make them disjoint");
    }
    if (range && (!std::isfinite(range->hi - range->lo) || !(range->lo < range->hi)))
        throw Error("the range needs lo < hi, both finite, a finite distance apart", "/range", "correct it");
}

std::size_t TfSampler::segment(double s) const {
    const auto next = std::ranges::upper_bound(m_points, s, {}, &ControlPoint::x);
    return next == m_points.begin() ? 0 : static_cast<std::size_t>(next - m_points.begin()) - 1;
}

double TfSampler::opacity(double s) const {
    s = std::clamp(s, 0.0, 1.0);
    const std::size_t i = segment(s);
    const ControlPoint& p = m_points[i];
    if (i + 1 == m_points.size()) return p.opacity;
    const ControlPoint& q = m_points[i + 1];
    return p.opacity + (q.opacity - p.opacity) * (s - p.x) / (q.x - p.x);
}

Rgb TfSampler::color(double s) const {
    s = std::clamp(s, 0.0, 1.0);
    const std::size_t i = segment(s);
    if (i + 1 == m_points.size()) return m_points[i].color;
    return mix(m_points[i].color, m_points[i + 1].color, (s - m_points[i].x) / (m_points[i + 1].x - m_points[i].x));
}

TransferFunction tents(int count, double peak) {
    if (count < 1 || count > 64)
        throw UsageError("a transfer function has 1 to 64 tents", "tents:N", "give N in this range");
    if (!inUnit(peak)) throw UsageError("a peak opacity lies in [0,1]", "tents:N:PEAK", "give PEAK in this range");
    TransferFunction tf;
    for (int i = 0; i < count; ++i) {
        const double centre = (i + 0.5) / count;
        const double half = 0.4 / count;
        const Rgb color = rgbFromHsv(360.0 * centre, 1, 1);
        tf.points.push_back({centre - half, 0.0, color, true, {}});
        tf.points.push_back({centre, peak, color, false, {}});
        tf.points.push_back({centre + half, 0.0, color, true, {}});
        tf.features.push_back({"f" + std::to_string(i + 1), centre - half, centre + half, color, {}});
    }
    return tf;
}

TransferFunction ramp(int count) {
    if (count < 1 || count > 256) throw UsageError("a ramp has 1 to 256 points", "ramp:N", "give N in this range");
    TransferFunction tf;
    for (int i = 0; i < count; ++i) {
        const double x = (i + 0.5) / count;
        tf.points.push_back({x, 1.0 / 6.0, rgbFromHsv(360.0 * x, 1, 1), false, {}});
    }
    tf.features = deriveFeatures(tf);
    return tf;
}

std::optional<TransferFunction> tfFromSpec(const std::string& text) {
    const std::vector<std::string> parts = splitAt(':', text);
    if (parts.size() < 2) return {};
    const bool isTents = parts[0] == "tents", isRamp = parts[0] == "ramp";
    if (!isTents && !isRamp) return {};
    if (parts.size() > (isTents ? 3u : 2u))
        throw UsageError("too many parts", "transfer function '" + text + "'", "write tents:N[:PEAK] or ramp:N");
    const int count = parseNumber<int>(parts[1], text);
    if (isRamp) return ramp(count);
    return tents(count, parts.size() == 3 ? parseNumber<double>(parts[2], text) : kDefaultPeak);
}

std::vector<Feature> deriveFeatures(const TransferFunction& tf) {
    std::vector<Feature> features;
    const auto points = tf.pointsWithEnds();
    for (std::size_t i = 0; i + 1 < points.size();) {
        if (points[i].opacity == 0.0 && points[i + 1].opacity == 0.0) {
            ++i;
            continue;
        }
        std::size_t last = i + 1, peak = points[i].opacity > 0 ? i : i + 1;
        for (; last < points.size(); ++last) {
            if (points[last].opacity > points[peak].opacity) peak = last;
            if (points[last].opacity == 0.0) break;
        }
        last = std::min(last, points.size() - 1);
        if (points[i].x < points[last].x)
            features.push_back(
                {"f" + std::to_string(features.size() + 1), points[i].x, points[last].x, points[peak].color, {}});
        i = last;
    }
    return features;
}

std::vector<double> featureOpacities(const TransferFunction& tf) {
    std::vector<double> opacities;
    for (const Feature& f : tf.features) opacities.push_back(peakOf(tf, f));
    return opacities;
}

void changeOpacities(TransferFunction& tf, const Feature& f, const std::function<double(const ControlPoint&)>& change) {
    const bool stepAtA = f.a > 0.0 && tf.opacity(f.a) != 0.0;
    const bool stepAtB = f.b < 1.0 && opacityBefore(tf, f.b) != 0.0;
    if (stepAtA) splitAt(tf, f.a);
    if (stepAtB) splitAt(tf, f.b);
    auto& points = tf.points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double x = points[i].x;
        const bool lastOfX = i + 1 == points.size() || points[i + 1].x != x;
        const bool firstOfX = i == 0 || points[i - 1].x != x;
        const bool inside = x > f.a && x < f.b;
        const bool startsIt = x == f.a && (lastOfX || f.a == 0.0);
        const bool endsIt = x == f.b && ((f.b >= 1.0) || (stepAtB && firstOfX));
        if (inside || startsIt || endsIt) points[i].opacity = change(points[i]);
    }
}

TransferFunction withFeatureOpacities(const TransferFunction& tf, const std::vector<double>& x) {
    PELLUCID_CHECK(x.size() == tf.features.size());
    TransferFunction result = tf;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Feature& f = tf.features[i];
        const double target = std::clamp(x[i], 0.0, 1.0);
        const double peak = peakOf(result, f);
        if (peak == target) continue;
        if (peak > 0)
            changeOpacities(result, f, [factor = target / peak](const ControlPoint& p) {
                return std::min(1.0, p.opacity * factor);
            });
        else
            raiseFlatFeature(result, f, target);
    }
    return result;
}

TransferFunction withFullPeaks(const TransferFunction& tf) {
    const auto raisable = [&](const Feature& f) {
        return peakOf(tf, f) > 0 ||
               std::ranges::any_of(tf.points, [&](const ControlPoint& p) { return isMovableInside(p, f); });
    };
    std::vector<double> peaks;
    for (const Feature& f : tf.features) peaks.push_back(raisable(f) ? 1.0 : 0.0);
    return withFeatureOpacities(tf, peaks);
}

} // namespace pellucid
