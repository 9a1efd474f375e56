#include "optimize/refine/refine_live.h"

#include <algorithm>

#include "optimize/refine/refine_features.h"

namespace pellucid {
namespace {

constexpr double kMostGivenWay = 4; // factor between an opacity and what one edit makes of it

TransferFunction liveStartOfFeatures(const Histogram& histogram, const TransferFunction& before,
                                     TransferFunction start) {
    if (before.features.size() != start.features.size()) return start;
    const std::vector<double> was = opacityParts(histogram, before), is = opacityParts(histogram, start);
    double given = 0, others = 0;
    for (std::size_t f = 0; f < is.size(); ++f) (isHeld(start, start.features[f]) ? given : others) += is[f];
    for (std::size_t f = 0; f < is.size(); ++f)
        if (isHeld(start, start.features[f])) given -= was[f];
    if (!(others > 0)) return start;
    const double factor = std::clamp((others - given) / others, 1 / kMostGivenWay, kMostGivenWay);
    std::vector<double> peaks = featureOpacities(start);
    for (std::size_t f = 0; f < peaks.size(); ++f)
        if (!isHeld(start, start.features[f])) peaks[f] = std::min(1.0, factor * peaks[f]);
    return withFeatureOpacities(start, peaks);
}

} // namespace

bool refinesOtherwise(const TransferFunction& before, const TransferFunction& after, bool colorsCount) {
    return !std::equal(before.points.begin(), before.points.end(), after.points.begin(), after.points.end(),
                       [&](const ControlPoint& a, const ControlPoint& b) {
                           return a.x == b.x && a.opacity == b.opacity && a.fixed == b.fixed &&
                                  (!colorsCount || a.color == b.color);
                       });
}

std::vector<std::size_t> heldPoints(const TransferFunction& before, const TransferFunction& after) {
    const bool sameCount = before.points.size() == after.points.size();
    std::vector<std::size_t> held;
    std::size_t movable = 0;
    for (std::size_t i = 0; i < after.points.size(); ++i) {
        const ControlPoint& point = after.points[i];
        if (point.fixed) continue;
        ++movable;
        const auto isSame = [&](const ControlPoint& p) { return p.x == point.x && p.opacity == point.opacity; };
        const bool same =
            sameCount ? before.points[i].opacity == point.opacity : std::ranges::any_of(before.points, isSame);
        if (!same) held.push_back(i);
    }
    return held.size() == movable ? std::vector<std::size_t>() : held;
}

TransferFunction liveStart(const Histogram& histogram, const TransferFunction& before, const TransferFunction& after,
                           const std::vector<std::size_t>& held, const RefineOptions& options) {
    RefineOptions bare; // a choice makes no difference
    bare.profile = options.profile;
    TransferFunction start = after;
    for (const std::size_t i : held) start.points[i].fixed = true;
    if (held.empty()) return start;
    if (movesFeatures(after, bare)) return liveStartOfFeatures(histogram, before, std::move(start));
    if (before.points.size() != after.points.size()) return start;
    double given = 0, others = 0;
    for (const std::size_t i : held) given += after.points[i].opacity - before.points[i].opacity;
    for (const ControlPoint& point : start.points)
        if (!point.fixed) others += point.opacity;
    if (!(others > 0)) return start;
    const double factor = std::clamp((others - given) / others, 1 / kMostGivenWay, kMostGivenWay);
    for (ControlPoint& point : start.points)
        if (!point.fixed) point.opacity = std::min(1.0, factor * point.opacity);
    return start;
}

} // namespace pellucid
