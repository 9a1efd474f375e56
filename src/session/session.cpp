#include "session/session.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

namespace pellucid {

const Part<TransferFunction>* TfTrack::at(int frame) const {
    if (keys.empty()) return nullptr;
    const auto next = keys.upper_bound(frame);
    return next == keys.begin() ? &next->second : &std::prev(next)->second;
}

const TransferFunction* Session::tf() const {
    if (isEmpty()) return nullptr;
    const Part<TransferFunction>* part = variable().track.at(frame);
    return part == nullptr ? nullptr : &part->get();
}

namespace {

/// Gives the features of `tf` that have no identity that of a feature of `before` which `same` calls the same, if
/// nobody else has it.
void adopt(TransferFunction& tf, const TransferFunction& before, std::set<FeatureId>& taken,
           const std::function<bool(const Feature&, const Feature&)>& same) {
    for (Feature& f : tf.features) {
        if (f.id != 0) continue;
        const auto match = std::find_if(before.features.begin(), before.features.end(), [&](const Feature& b) {
            return b.id != 0 && taken.count(b.id) == 0 && same(f, b);
        });
        if (match == before.features.end()) continue;
        f.id = match->id;
        taken.insert(f.id);
    }
}

} // namespace

void Session::setTf(TransferFunction tf) {
    std::set<FeatureId> taken;
    for (Feature& f : tf.features)
        if (f.id != 0 && !taken.insert(f.id).second) f.id = 0; // a copy of a feature is another one
    if (const TransferFunction* before = this->tf()) {
        const auto sameName = [](const Feature& a, const Feature& b) { return a.name == b.name; };
        const auto samePlace = [](const Feature& a, const Feature& b) { return a.a == b.a && a.b == b.b; };
        adopt(tf, *before, taken,
              [&](const Feature& a, const Feature& b) { return sameName(a, b) && samePlace(a, b); });
        adopt(tf, *before, taken, sameName);
        adopt(tf, *before, taken, samePlace);
    }
    FeatureId next = goals->empty() ? 1 : goals->rbegin()->first + 1;
    for (const FeatureId id : taken) next = std::max(next, id + 1);
    for (Feature& f : tf.features)
        if (f.id == 0) f.id = next++;
    // Every feature has a goal from its first day on; a new one is wanted as much as the others are on average.
    const std::vector<double> targets = targetsOf(tf, *goals);
    goals.edit([&](FeatureGoals& all) {
        for (std::size_t i = 0; i < tf.features.size(); ++i)
            all.try_emplace(tf.features[i].id, FeatureGoal{targets[i], false, 0, 1});
    });
    variables.edit([&](std::vector<Variable>& all) {
        auto& keys = all.front().track.keys;
        const auto after = keys.upper_bound(frame);
        const int key = keys.empty() ? 0 : after == keys.begin() ? after->first : std::prev(after)->first;
        const auto there = keys.find(key);
        const auto sameIdentities = [&](const TransferFunction& old) {
            return std::equal(old.features.begin(), old.features.end(), tf.features.begin(), tf.features.end(),
                              [](const Feature& a, const Feature& b) { return a.id == b.id; });
        };
        if (there != keys.end() && *there->second == tf && sameIdentities(*there->second)) return;
        keys[key] = Part<TransferFunction>(std::move(tf));
    });
}

void Session::addRun(Run run) {
    runs.edit([&](std::vector<Run>& all) {
        all.push_back(std::move(run));
        if (all.size() > kMostRuns) all.erase(all.begin());
    });
}

std::vector<double> targetsOf(const TransferFunction& tf, const FeatureGoals& goals) {
    const std::size_t n = tf.features.size();
    std::vector<double> targets(n, -1.0);
    double sum = 0;
    std::size_t known = 0;
    for (std::size_t i = 0; i < n; ++i)
        if (const auto goal = goals.find(tf.features[i].id); goal != goals.end()) {
            targets[i] = goal->second.target;
            sum += targets[i];
            ++known;
        }
    if (!(sum > 0)) return std::vector<double>(n, n == 0 ? 0.0 : 1.0 / static_cast<double>(n));
    const double mean = sum / static_cast<double>(known);
    for (double& t : targets)
        if (t < 0) {
            t = mean;
            sum += mean;
        }
    // Shares that sum to 1 already keep their bits.
    if (std::abs(sum - 1) > 1e-12)
        for (double& t : targets) t /= sum;
    return targets;
}

FeatureGoals withTargets(FeatureGoals goals, const TransferFunction& tf, const std::vector<double>& targets) {
    for (std::size_t i = 0; i < targets.size() && i < tf.features.size(); ++i)
        goals[tf.features[i].id].target = targets[i];
    return goals;
}

std::vector<double> withTarget(std::vector<double> targets, std::size_t feature, double value) {
    if (feature >= targets.size() || targets.size() == 1) return targets; // one feature has it all
    value = std::clamp(value, 0.0, 1.0);
    const double others = std::accumulate(targets.begin(), targets.end(), 0.0) - targets[feature];
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (i == feature) continue;
        targets[i] = others > 1e-9 ? targets[i] / others * (1.0 - value)
                                   : (1.0 - value) / static_cast<double>(targets.size() - 1);
    }
    targets[feature] = value;
    return targets;
}

} // namespace pellucid
