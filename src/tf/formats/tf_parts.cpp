#include "tf/formats/tf_parts.h"

#include <algorithm>

#include "base/check.h"
#include "tf/formats/tf_curves.h"
#include "tf/tf_range.h"

namespace pellucid {

namespace {

TransferFunction placed(TransferFunction tf, const ValueRange& own, const ValueRange& range) {
    if (!tf.range) tf.range = own;
    return inRange(tf, range);
}

bool isFixed(const std::vector<ControlPoint>& points, double x) {
    const auto same = std::ranges::find(points, x, &ControlPoint::x);
    return same == points.end() || same->fixed;
}

} // namespace

TransferFunction withParts(const TransferFunction& now, const TransferFunction& other, const TfParts& parts) {
    PELLUCID_CHECK(now.range || other.range);
    const ValueRange nowRange = now.range.value_or(other.range.value_or(ValueRange{}));
    const ValueRange otherRange = other.range.value_or(nowRange);
    const ValueRange range = parts.range ? otherRange : nowRange;
    const TransferFunction ofNow = placed(now, nowRange, range), ofOther = placed(other, otherRange, range);
    if (parts.colors == parts.opacities) return parts.colors ? ofOther : ofNow;

    const TransferFunction& shapes = parts.opacities ? ofOther : ofNow;
    const TransferFunction& hues = parts.colors ? ofOther : ofNow;
    TfCurves curves;
    for (const ControlPoint& p : shapes.pointsWithEnds()) curves.opacities.push_back({p.x, p.opacity, {}});
    for (const ControlPoint& p : hues.pointsWithEnds()) curves.colors.push_back({p.x, p.color, {}});
    TransferFunction result = shapes;
    result.points = pointsOf(curves, {0, 1}).points;
    for (ControlPoint& p : result.points) p.fixed = isFixed(shapes.points, p.x);
    for (Feature& f : result.features) f.color = result.color((f.a + f.b) / 2);
    return result;
}

} // namespace pellucid
