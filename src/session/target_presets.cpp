#include "session/target_presets.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "tf/shapes.h"

namespace pellucid {

double peakIntensity(const TransferFunction& tf, std::size_t feature) {
    const Feature& f = tf.features.at(feature);
    double most = -1, first = 0, last = 0;
    for (const int index : pointsOfFeature(tf, static_cast<int>(feature))) {
        const ControlPoint& p = tf.points[static_cast<std::size_t>(index)];
        if (p.opacity > most) {
            most = p.opacity;
            first = p.x;
        }
        if (p.opacity == most) last = p.x;
    }
    return most < 0 ? (f.a + f.b) / 2 : (first + last) / 2;
}

std::vector<double> targetsByWeights(const TransferFunction& tf, const FeatureGoals& goals,
                                     const std::vector<double>& weights) {
    PELLUCID_CHECK(weights.size() == tf.features.size());
    std::vector<double> targets = targetsOf(tf, goals);
    const std::vector<bool> held = heldTargets(tf, goals);
    double kept = 0, sum = 0, free = 0;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (held[i]) {
            kept += targets[i];
        } else {
            sum += weights[i];
            ++free;
        }
    }
    const double room = std::max(0.0, 1 - kept);
    for (std::size_t i = 0; i < targets.size(); ++i)
        if (!held[i]) targets[i] = room * (sum > 0 ? weights[i] / sum : 1 / free);
    return targets;
}

std::vector<double> presetTargets(TargetPreset preset, const TransferFunction& tf, const FeatureGoals& goals) {
    const std::size_t n = tf.features.size();
    std::vector<double> weights(n, 1.0);
    if (preset == TargetPreset::Equal) return targetsByWeights(tf, goals, weights);
    for (std::size_t i = 0; i < n; ++i) weights[i] = peakIntensity(tf, i);
    if (preset == TargetPreset::Diagonal) return targetsByWeights(tf, goals, weights);

    // In reverse order among those that are free: locked and hidden ones are passed over.
    const std::vector<double> present = targetsOf(tf, goals);
    const std::vector<bool> held = heldTargets(tf, goals);
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < n; ++i)
        if (!held[i]) free.push_back(i);
    const auto differs = [&](std::size_t i) { return std::abs(present[i] - present[free.front()]) > 1e-9; };
    const std::vector<double> from = std::any_of(free.begin(), free.end(), differs) ? present : weights;
    for (std::size_t i = 0; i < free.size(); ++i) weights[free[i]] = from[free[free.size() - 1 - i]];
    return targetsByWeights(tf, goals, weights);
}

std::vector<double> targetsForOne(const TransferFunction& tf, const FeatureGoals& goals, std::size_t feature) {
    std::vector<double> weights(tf.features.size(), 0.0);
    weights.at(feature) = 1;
    return targetsByWeights(tf, goals, weights);
}

} // namespace pellucid
