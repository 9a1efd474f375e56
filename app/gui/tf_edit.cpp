#include "tf_edit.h"

#include <algorithm>

namespace pellucid::gui {
namespace {

constexpr double kSmallestFeature = 1.0 / 4096; // a feature of no width holds no voxel and cannot be seen or grabbed

bool holds(const TransferFunction& tf, int index) {
    return index >= 0 && static_cast<std::size_t>(index) < tf.points.size();
}

// Whether the point belongs to the feature's shape; its upper bottom lies at b, where no voxel of it is.
bool shapes(const TransferFunction& tf, const ControlPoint& point, std::size_t feature) {
    const Feature& f = tf.features[feature];
    if (f.contains(point.x)) return true;
    return point.x == f.b && featureAt(tf.features, point.x) < 0;
}

void moveFeatureEnds(TransferFunction& tf, double from, double to) {
    for (std::size_t i = 0; i < tf.features.size(); ++i) {
        Feature& f = tf.features[i];
        if (f.a == from && f.b > to + kSmallestFeature) {
            double lowest = 0;
            for (std::size_t j = 0; j < tf.features.size(); ++j) {
                if (j != i && tf.features[j].b <= f.a) lowest = std::max(lowest, tf.features[j].b);
            }
            f.a = std::max(to, lowest);
        }
        if (f.b == from && f.a + kSmallestFeature < to) {
            double highest = 1;
            for (std::size_t j = 0; j < tf.features.size(); ++j) {
                if (j != i && tf.features[j].a >= f.b) highest = std::min(highest, tf.features[j].a);
            }
            f.b = std::min(to, highest);
        }
    }
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
    if (point.x != from) moveFeatureEnds(result, from, point.x);
    return result;
}

AddedPoint withPointAdded(const TransferFunction& tf, double x, double opacity) {
    AddedPoint added{tf, 0};
    ControlPoint point;
    point.x = std::clamp(x, 0.0, 1.0);
    point.opacity = std::clamp(opacity, 0.0, 1.0);
    point.color = tf.points.empty() ? Rgb{1, 1, 1} : tf.color(point.x);
    auto& points = added.tf.points;
    const auto place = std::upper_bound(points.begin(), points.end(), point.x,
                                        [](double value, const ControlPoint& p) { return value < p.x; });
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
    const auto f = static_cast<std::size_t>(feature);
    const bool highest = std::none_of(tf.points.begin(), tf.points.end(), [&](const ControlPoint& other) {
        return shapes(tf, other, f) && other.opacity > point.opacity;
    });
    if (highest) result.features[f].color = color;
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
    const auto f = static_cast<std::size_t>(feature);
    result.features.at(f).color = color;
    for (ControlPoint& point : result.points) {
        if (shapes(tf, point, f)) point.color = color;
    }
    return result;
}

TransferFunction withFeatureName(const TransferFunction& tf, int feature, const std::string& name) {
    TransferFunction result = tf;
    result.features.at(static_cast<std::size_t>(feature)).name = name;
    return result;
}

TransferFunction withFeatureOpacity(const TransferFunction& tf, int feature, double opacity) {
    std::vector<double> opacities = featureOpacities(tf);
    opacities.at(static_cast<std::size_t>(feature)) = std::clamp(opacity, 0.0, 1.0);
    return withFeatureOpacities(tf, opacities);
}

} // namespace pellucid::gui
