#include "tf/emphasis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/check.h"
#include "tf/change_opacities.h"
#include "tf/opacity.h"

namespace pellucid {

namespace {

/// Whether anything of `f` has changed.
bool scaleExtinction(TransferFunction& tf, const Feature& f, double factor) {
    TransferFunction changed = tf;
    bool any = false;
    changeOpacities(changed, f, [&](const ControlPoint& p) {
        if (p.fixed || p.opacity == 0) return p.opacity;
        const double opacity = std::clamp(opacityOfStep(p.opacity, factor), 0.0, 1.0);
        any = any || opacity != p.opacity;
        return opacity;
    });
    if (any) tf = std::move(changed);
    return any;
}

} // namespace

Emphasis withEmphasis(const TransferFunction& tf, std::size_t feature, double steps, const std::vector<double>& inFront,
                      const std::vector<bool>& held) {
    const std::size_t n = tf.features.size();
    PELLUCID_CHECK(feature < n && inFront.size() == n && held.size() == n && steps != 0);
    Emphasis result{tf, {}};
    const auto change = [&](std::size_t f, double factor) {
        if (held[f] || tf.features[f].hidden) return;
        if (scaleExtinction(result.tf, tf.features[f], factor)) result.changes.push_back({f, factor});
    };
    change(feature, std::pow(kMoreOfIt, steps));
    for (std::size_t f = 0; f < n; ++f)
        if (f != feature && inFront[f] > 0) change(f, std::pow(kLessOfOthers, -steps));
    return result;
}

std::string emphasisText(const Emphasis& emphasis) {
    std::string text;
    for (const EmphasisChange& change : emphasis.changes) {
        char factor[32];
        std::snprintf(factor, sizeof factor, "%.3g", std::max(change.factor, 1 / change.factor));
        text += (text.empty() ? "" : ", ") + emphasis.tf.features[change.feature].name +
                (change.factor >= 1 ? " × " : " ÷ ") + factor;
    }
    return text;
}

} // namespace pellucid
