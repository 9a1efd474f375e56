#include "tf/tf_range.h"

#include <algorithm>

namespace pellucid {

namespace {

/// From intensities of one window to those of another, by way of data values.
struct Rescale {
    ValueRange from, to;
    double operator()(double x) const {
        const double value = from.lo + x * (from.hi - from.lo);
        return (value - to.lo) / (to.hi - to.lo);
    }
};

/// `tf` in the intensities of the new window, which may lie outside [0,1]. The ends that go without saying are written
/// out where the curve meets them and they are ends no longer.
std::vector<ControlPoint> rescaledPoints(const TransferFunction& tf, const Rescale& rescale) {
    std::vector<ControlPoint> points = tf.points;
    if (points.empty()) return points;
    const auto implied = [](double x, const ControlPoint& neighbour) {
        return ControlPoint{x, 0.0, neighbour.color, true, {}};
    };
    const bool startsInside = points.front().x > 0, endsInside = points.back().x < 1;
    if (startsInside && points.front().opacity > 0 && rescale(0) != 0)
        points.insert(points.begin(), implied(0, points.front()));
    if (endsInside && points.back().opacity > 0 && rescale(1) != 1) points.push_back(implied(1, points.back()));
    for (ControlPoint& p : points) p.x = rescale(p.x);
    // Values beyond the old window were drawn as its ends are.
    if (!startsInside && points.front().x > 0 && points.front().opacity > 0) {
        points.insert(points.begin(), points.front());
        points.front().x = 0;
    }
    if (!endsInside && points.back().x < 1 && points.back().opacity > 0) {
        points.push_back(points.back());
        points.back().x = 1;
    }
    return points;
}

/// The curve at x between two points, as a point.
ControlPoint between(const ControlPoint& p, const ControlPoint& q, double x) {
    const double t = q.x > p.x ? (x - p.x) / (q.x - p.x) : 1;
    ControlPoint cut;
    cut.x = x;
    cut.opacity = p.opacity + (q.opacity - p.opacity) * t;
    cut.color = {p.color.r + (q.color.r - p.color.r) * t, p.color.g + (q.color.g - p.color.g) * t,
                 p.color.b + (q.color.b - p.color.b) * t};
    cut.fixed = p.fixed && q.fixed;
    return cut;
}

} // namespace

TransferFunction inRange(const TransferFunction& tf, const ValueRange& range) {
    TransferFunction result = tf;
    result.range = range;
    if (!tf.range || *tf.range == range || !(range.lo < range.hi)) return result;
    const Rescale rescale{*tf.range, range};

    const std::vector<ControlPoint> points = rescaledPoints(tf, rescale);
    result.points.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i > 0 && points[i - 1].x < 0 && points[i].x > 0)
            result.points.push_back(between(points[i - 1], points[i], 0));
        if (i > 0 && points[i - 1].x < 1 && points[i].x > 1)
            result.points.push_back(between(points[i - 1], points[i], 1));
        if (points[i].x >= 0 && points[i].x <= 1) result.points.push_back(points[i]);
    }

    result.features.clear();
    for (Feature f : tf.features) {
        f.a = f.a <= 0 && rescale(0) > 0 ? 0 : std::max(0.0, rescale(f.a));
        f.b = f.b >= 1 && rescale(1) < 1 ? 1 : std::min(1.0, rescale(f.b));
        if (f.a < f.b) result.features.push_back(std::move(f));
    }
    return result;
}

} // namespace pellucid
