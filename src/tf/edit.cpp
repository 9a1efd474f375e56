#include "tf/edit.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "tf/shapes.h"

namespace pellucid {
namespace {

bool holds(const TransferFunction& tf, int index) {
    return index >= 0 && static_cast<std::size_t>(index) < tf.points.size();
}

/// The ends of features that lie at `from` go to `to` with a point that has gone there: the first or the last of those
/// that shared the place, or both where it was alone.
void moveFeatureEnds(TransferFunction& tf, double from, double to, bool wasFirst, bool wasLast) {
    Feature *below = nullptr, *above = nullptr; // that end and start there
    double lowest = 0, highest = 1;             // ends of the others
    for (Feature& f : tf.features) {
        if (f.b == from) below = &f;
        if (f.a == from) above = &f;
        if (f.b < from) lowest = std::max(lowest, f.b);
        if (f.a > from) highest = std::min(highest, f.a);
    }
    if (below != nullptr) lowest = below->a + kSmallestFeature;
    if (above != nullptr) highest = above->b - kSmallestFeature;
    const bool touching = below != nullptr && above != nullptr;
    if (lowest > highest) return;
    to = std::clamp(to, lowest, highest);
    // Of a step, the side that a feature owns takes the end along; a bottom that stays keeps it.
    if (below != nullptr && (touching ? wasFirst : wasLast))
        below->b = touching ? std::min(to, wasLast ? 1.0 : from) : to;
    if (above != nullptr && (touching ? wasLast : wasFirst))
        above->a = touching ? std::max(to, wasFirst ? 0.0 : from) : to;
}

} // namespace

TransferFunction withPointMoved(const TransferFunction& tf, int index, double x, double opacity) {
    if (!holds(tf, index)) return tf;
    TransferFunction result = tf;
    const auto i = static_cast<std::size_t>(index);
    const double lowest = i == 0 ? 0.0 : tf.points[i - 1].x;
    const double highest = i + 1 == tf.points.size() ? 1.0 : tf.points[i + 1].x;
    ControlPoint& point = result.points[i];
    const double from = point.x;
    point.x = std::clamp(x, lowest, highest);
    point.opacity = std::clamp(opacity, 0.0, 1.0);
    if (point.x == from) return result;
    const bool isFirst = i == 0 || tf.points[i - 1].x != from;
    const bool isLast = i + 1 == tf.points.size() || tf.points[i + 1].x != from;
    moveFeatureEnds(result, from, point.x, isFirst, isLast);
    return result;
}

AddedPoint withPointAdded(const TransferFunction& tf, double x, double opacity) {
    AddedPoint added{tf, 0};
    ControlPoint point;
    point.x = std::clamp(x, 0.0, 1.0);
    point.opacity = std::clamp(opacity, 0.0, 1.0);
    point.color = tf.points.empty() ? Rgb{1, 1, 1} : tf.color(point.x);
    auto& points = added.tf.points;
    const auto place = std::ranges::upper_bound(points, point.x, {}, &ControlPoint::x);
    added.index = static_cast<int>(place - points.begin());
    points.insert(place, point);
    return added;
}

TransferFunction withPointRemoved(const TransferFunction& tf, int index) {
    if (!holds(tf, index)) return tf;
    TransferFunction result = tf;
    result.points.erase(result.points.begin() + index);
    return result;
}

TransferFunction withPointColor(const TransferFunction& tf, int index, const Rgb& color) {
    if (!holds(tf, index)) return tf;
    TransferFunction result = tf;
    ControlPoint& point = result.points[static_cast<std::size_t>(index)];
    point.color = color;
    const int feature = featureAt(tf.features, point.x);
    if (feature < 0) return result;
    const bool isHighest = std::ranges::none_of(pointsOfFeature(tf, feature), [&](int i) {
        return tf.points[static_cast<std::size_t>(i)].opacity > point.opacity;
    });
    if (isHighest) result.features[static_cast<std::size_t>(feature)].color = color;
    return result;
}

TransferFunction withPointFixed(const TransferFunction& tf, int index, bool fixed) {
    if (!holds(tf, index)) return tf;
    TransferFunction result = tf;
    result.points[static_cast<std::size_t>(index)].fixed = fixed;
    return result;
}

TransferFunction withFeatureColor(const TransferFunction& tf, int feature, const Rgb& color) {
    TransferFunction result = tf;
    result.features.at(static_cast<std::size_t>(feature)).color = color;
    for (const int i : pointsOfFeature(tf, feature)) result.points[static_cast<std::size_t>(i)].color = color;
    return result;
}

TransferFunction withFeatureName(const TransferFunction& tf, int feature, const std::string& name) {
    TransferFunction result = tf;
    result.features.at(static_cast<std::size_t>(feature)).name = name;
    return result;
}

TransferFunction withDensity(const TransferFunction& tf, double factor) {
    PELLUCID_CHECK(factor > 0 && std::isfinite(factor));
    if (factor == 1) return tf;
    TransferFunction result = tf;
    for (ControlPoint& p : result.points)
        p.opacity = std::clamp(-std::expm1(factor * std::log1p(-p.opacity)), 0.0, 1.0);
    return result;
}

TransferFunction withFeatureOpacity(const TransferFunction& tf, int feature, double opacity) {
    std::vector<double> opacities = featureOpacities(tf);
    opacities.at(static_cast<std::size_t>(feature)) = std::clamp(opacity, 0.0, 1.0);
    return withFeatureOpacities(tf, opacities);
}

} // namespace pellucid
