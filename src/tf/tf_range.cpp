#include "tf/tf_range.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

namespace {

/// From intensities of one window to those of another, by way of data values. The ends of the one are met exactly where
/// the windows share them.
struct Rescale {
    ValueRange from, to;
    double operator()(double x) const { return (std::lerp(from.lo, from.hi, x) - to.lo) / (to.hi - to.lo); }
};

/// A point of the curve in the intensities of the new window, which may lie outside [0,1].
struct CurvePoint {
    ControlPoint point;
    bool made = false; ///< by us: it goes again where the curve is the same without it
    double x() const { return point.x; }
};

CurvePoint madeAt(double x, const ControlPoint& like) { return {{x, like.opacity, like.color, true, {}}, true}; }

CurvePoint between(const ControlPoint& p, const ControlPoint& q, double x) {
    const double t = (x - p.x) / (q.x - p.x);
    const auto mix = [t](double a, double b) { return a + (b - a) * t; };
    const Rgb color{mix(p.color.r, q.color.r), mix(p.color.g, q.color.g), mix(p.color.b, q.color.b)};
    return {{x, mix(p.opacity, q.opacity), color, p.fixed && q.fixed, {}}, true};
}

/// The whole curve, from x ≤ 0 to x ≥ 1.
std::vector<CurvePoint> wholeCurve(const TransferFunction& tf, const Rescale& rescale) {
    std::vector<CurvePoint> curve;
    for (const ControlPoint& p : tf.pointsWithEnds()) {
        curve.push_back({p, false});
        curve.back().point.x = rescale(p.x);
    }
    curve.front().made = tf.points.empty() || tf.points.front().x > 0;
    curve.back().made = tf.points.empty() || tf.points.back().x < 1;
    // Values beyond the old window were drawn as its ends are.
    if (curve.front().x() > 0) curve.insert(curve.begin(), madeAt(0, curve.front().point));
    if (curve.back().x() < 1) curve.push_back(madeAt(1, curve.back().point));
    return curve;
}

std::vector<CurvePoint> cut(const std::vector<CurvePoint>& curve) {
    std::vector<CurvePoint> inside;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (i > 0)
            for (const double x : {0.0, 1.0})
                if (curve[i - 1].x() < x && curve[i].x() > x)
                    inside.push_back(between(curve[i - 1].point, curve[i].point, x));
        if (curve[i].x() >= 0 && curve[i].x() <= 1) inside.push_back(curve[i]);
    }
    return inside;
}

/// Whether TransferFunction::pointsWithEnds() makes up for the outermost point, which lies at `end` or inward of it.
bool goesWithoutSaying(const CurvePoint& outermost, const CurvePoint& next, double end) {
    return outermost.made && outermost.point.opacity == 0 && outermost.point.color == next.point.color &&
           (outermost.x() == end || next.point.opacity == 0);
}

void removeNeedless(std::vector<CurvePoint>& points) {
    while (points.size() > 1 && goesWithoutSaying(points[0], points[1], 0)) points.erase(points.begin());
    while (points.size() > 1 && goesWithoutSaying(points.back(), points[points.size() - 2], 1)) points.pop_back();
    const CurvePoint black{{}, false}; // what there is without any point
    if (points.size() == 1 && goesWithoutSaying(points[0], black, points[0].x())) points.clear();
}

} // namespace

TransferFunction inRange(const TransferFunction& tf, const ValueRange& range) {
    TransferFunction result = tf;
    result.range = range;
    if (!tf.range || *tf.range == range || !(range.lo < range.hi)) return result;
    const Rescale rescale{*tf.range, range};

    std::vector<CurvePoint> points = cut(wholeCurve(tf, rescale));
    removeNeedless(points);
    result.points.clear();
    for (CurvePoint& p : points) result.points.push_back(std::move(p.point));

    result.features.clear();
    for (Feature f : tf.features) {
        f.a = f.a <= 0 && rescale(0) > 0 ? 0 : std::max(0.0, rescale(f.a));
        f.b = f.b >= 1 && rescale(1) < 1 ? 1 : std::min(1.0, rescale(f.b));
        if (f.a < f.b) result.features.push_back(std::move(f));
    }
    return result;
}

} // namespace pellucid
