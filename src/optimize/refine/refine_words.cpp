#include "optimize/refine/refine_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "base/check.h"

namespace pellucid {

namespace {

constexpr double kLeast = 0.01; ///< a change below this part of the opacity is not told
constexpr double kNone = 1e-9;  ///< an opacity below this is none
constexpr double kGone = 1e-3;  ///< nor is one that is this part of what it was
constexpr std::size_t kMost = 4;

/// Mean of α over [a, b): exact, since α is linear between points.
double meanOpacity(const TransferFunction& tf, double a, double b) {
    const std::vector<ControlPoint> points = tf.pointsWithEnds();
    double area = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const ControlPoint &p = points[i], &q = points[i + 1];
        const double lo = std::max(a, p.x), hi = std::min(b, q.x);
        if (!(hi > lo)) continue;
        const double middle = ((lo + hi) / 2 - p.x) / (q.x - p.x);
        area += (hi - lo) * (p.opacity + (q.opacity - p.opacity) * middle);
    }
    return b > a ? area / (b - a) : 0;
}

std::string shortNumber(double value) {
    char text[32];
    const double size = std::abs(value);
    std::snprintf(text, sizeof text, size >= 100 && size < 1e6 ? "%.0f" : "%.3g", size);
    return (value < 0 ? "−" : "") + std::string(text);
}

/// How much was changed, whatever the direction: |ln(after/before)|.
double sizeOf(const OpacityChange& c) {
    const bool was = c.before > kNone, is = c.after > kNone;
    if (!was && !is) return 0;
    return was && is ? std::abs(std::log(c.after / c.before)) : std::numeric_limits<double>::infinity();
}

std::string wordsOf(const OpacityChange& c) {
    if (!(c.before > kNone)) return c.feature + " appears";
    const double ratio = c.after / c.before;
    if (!(c.after > kNone && ratio >= kGone)) return c.feature + " disappears";
    char text[32];
    if (ratio >= 2)
        std::snprintf(text, sizeof text, ratio < 9.95 ? " × %.2g" : " × %.0f", ratio);
    else
        std::snprintf(text, sizeof text, ratio < 0.005 ? " %s%.1f %%" : " %s%.0f %%", ratio < 1 ? "−" : "+",
                      100 * std::abs(ratio - 1));
    return c.feature + text;
}

} // namespace

std::string valueName(const TransferFunction& tf, double x) {
    return shortNumber(tf.range ? tf.range->lo + x * (tf.range->hi - tf.range->lo) : x);
}

std::vector<OpacityChange> opacityChanges(const TransferFunction& before, const TransferFunction& after) {
    PELLUCID_CHECK(before.features.size() == after.features.size());
    std::vector<OpacityChange> changes;
    if (before.features.size() >= 2) {
        for (const Feature& f : before.features)
            changes.push_back({f.name, meanOpacity(before, f.a, f.b), meanOpacity(after, f.a, f.b)});
        return changes;
    }
    PELLUCID_CHECK(before.points.size() == after.points.size());
    for (std::size_t i = 0; i < before.points.size(); ++i) {
        const ControlPoint& p = before.points[i];
        if (!p.fixed) changes.push_back({"at " + valueName(before, p.x), p.opacity, after.points[i].opacity});
    }
    return changes;
}

std::string changeText(const std::vector<OpacityChange>& changes) {
    std::vector<OpacityChange> told;
    std::ranges::copy_if(
        changes, std::back_inserter(told), [](double size) { return size >= std::log1p(kLeast); }, sizeOf);
    std::ranges::stable_sort(told, std::greater{}, sizeOf);
    if (told.size() > kMost) told.resize(kMost);
    std::string text;
    for (const OpacityChange& c : told) text += (text.empty() ? "" : ", ") + wordsOf(c);
    return text.empty() ? "nothing changed" : text;
}

} // namespace pellucid
