#include "session/session.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "base/check.h"
#include "tf/color_maps.h"
#include "tf/shown_tf.h"
#include "tf/tf_between.h"

namespace pellucid {

std::shared_ptr<const TransferFunction> TfTrack::at(int frame) const {
    if (keys.empty()) return nullptr;
    const auto next = keys.upper_bound(frame);
    if (next == keys.begin()) return next->second.shared();
    const auto before = std::prev(next);
    if (next == keys.end() || before->first == frame) return before->second.shared();
    const double t = static_cast<double>(frame - before->first) / (next->first - before->first);
    if (auto between = tfBetween(*before->second, *next->second, t))
        return std::make_shared<const TransferFunction>(std::move(*between));
    return before->second.shared();
}

int TfTrack::keyBefore(int frame) const {
    if (keys.empty()) return -1;
    const auto next = keys.upper_bound(frame);
    return next == keys.begin() ? next->first : std::prev(next)->first;
}

std::map<FeatureId, double> targetsBetween(const TargetKeys& keys, int frame) {
    const auto next = keys.upper_bound(frame);
    if (next == keys.begin()) return next->second;
    const auto before = std::prev(next);
    if (next == keys.end()) return before->second;
    const double t = static_cast<double>(frame - before->first) / (next->first - before->first);
    std::map<FeatureId, double> targets = before->second;
    for (const auto& [id, target] : next->second) {
        const auto [found, isNew] = targets.try_emplace(id, target);
        if (!isNew) found->second += t * (target - found->second);
    }
    return targets;
}

bool HsbMapping::isKeptBy(const HsbMapping& later) const {
    HsbMapping same = *this;
    const auto keep = [](const std::string& now, const std::string& was, std::optional<double>& scale,
                         const std::optional<double>& next) {
        if (now != was || !scale) scale = next; // of another variable it means nothing
    };
    keep(saturation, found.saturation, same.found.a, later.found.a);
    keep(brightness, found.brightness, same.found.b, later.found.b);
    same.found.saturation = later.found.saturation;
    same.found.brightness = later.found.brightness;
    return same == later;
}

void checkFieldColorMap(const std::string& name) {
    if (name == kFeatureColorMap) return;
    try {
        colorMapNamed(name);
    } catch (const UsageError& e) {
        throw UsageError(e.problem(), e.where(), e.whatToDo() + "; or " + kFeatureColorMap);
    }
}

const Variable* Session::variableNamed(const std::string& name) const {
    for (const Variable& v : *variables)
        if (v.name == name) return &v;
    return nullptr;
}

std::shared_ptr<const TransferFunction> Session::tf() const { return tfAt(frame); }

std::shared_ptr<const TransferFunction> Session::tfAt(int at) const {
    if (isEmpty()) return nullptr;
    const TfTrack& track = variable().track;
    if (adapt->mode == AdaptSettings::Mode::Static || track.keys.empty()) return track.at(at);
    const int key = track.keyBefore(at);
    const auto next = track.adapted.upper_bound(at);
    if (next != track.adapted.begin() && std::prev(next)->first >= key) return std::prev(next)->second.shown().shared();
    return track.keys.at(key).shared();
}

namespace {

/// Gives the features of a transfer function their identities.
class Identification {
public:
    explicit Identification(TransferFunction& tf) : m_tf(tf) {
        for (Feature& f : tf.features)
            if (f.id != 0 && !m_taken.insert(f.id).second) f.id = 0; // a copy of a feature is another one
    }

    /// `before`: the transfer function that this one replaces.
    void adopt(const TransferFunction* before, const FeatureGoals& goals) {
        std::vector<Known> present, gone;
        if (before != nullptr)
            for (const Feature& f : before->features) present.push_back({f.id, f.name, f.a, f.b});
        for (const auto& [id, goal] : goals)
            if (goal.departed &&
                std::none_of(present.begin(), present.end(), [id = id](const Known& k) { return k.id == id; }))
                gone.push_back({id, goal.departed->name, goal.departed->a, goal.departed->b});
        const auto sameName = [](const Feature& f, const Known& k) { return f.name == k.name; };
        const auto samePlace = [](const Feature& f, const Known& k) { return f.a == k.a && f.b == k.b; };
        const auto same = [&](const Feature& f, const Known& k) { return sameName(f, k) && samePlace(f, k); };
        for (const auto& [by, among] :
             std::initializer_list<std::pair<Rule, const std::vector<Known>*>>{{same, &present},
                                                                               {same, &gone},
                                                                               {sameName, &present},
                                                                               {sameName, &gone},
                                                                               {samePlace, &present},
                                                                               {samePlace, &gone}})
            adopt(*among, by);
    }

    /// From `next` on.
    void addNew(FeatureId next) {
        for (const FeatureId id : m_taken) next = std::max(next, id + 1);
        for (Feature& f : m_tf.features)
            if (f.id == 0) f.id = next++;
    }

private:
    struct Known {
        FeatureId id;
        std::string name;
        double a, b;
    };
    using Rule = std::function<bool(const Feature&, const Known&)>;

    void adopt(const std::vector<Known>& among, const Rule& isSame) {
        for (Feature& f : m_tf.features) {
            if (f.id != 0) continue;
            const auto match = std::find_if(among.begin(), among.end(), [&](const Known& k) {
                return k.id != 0 && m_taken.count(k.id) == 0 && isSame(f, k);
            });
            if (match == among.end()) continue;
            f.id = match->id;
            m_taken.insert(f.id);
        }
    }

    TransferFunction& m_tf;
    std::set<FeatureId> m_taken;
};

/// Above all that the session has ever given.
FeatureId firstUnused(const Session& session) {
    FeatureId most = session.goals->empty() ? 0 : session.goals->rbegin()->first;
    for (const Variable& v : *session.variables)
        for (const auto& [from, tf] : v.track.keys)
            for (const Feature& f : tf->features) most = std::max(most, f.id);
    return most + 1;
}

const Feature* featureOf(const TransferFunction& tf, FeatureId id) {
    for (const Feature& f : tf.features)
        if (f.id == id) return &f;
    return nullptr;
}

/// Null where the feature has none.
const FeatureGoal* goalOf(const Feature& feature, const FeatureGoals& goals) {
    const auto goal = goals.find(feature.id);
    return goal == goals.end() ? nullptr : &goal->second;
}

/// What a feature without a goal is given: it is wanted as much as the others of its transfer function on average.
double averageTarget(const TransferFunction& tf, const FeatureGoals& goals) {
    double sum = 0;
    std::size_t known = 0;
    for (const Feature& f : tf.features)
        if (const FeatureGoal* goal = goalOf(f, goals)) {
            sum += goal->target;
            ++known;
        }
    return known > 0 ? sum / static_cast<double>(known) : 1.0 / static_cast<double>(tf.features.size());
}

bool sameIdentities(const TransferFunction& a, const TransferFunction& b) {
    return std::equal(a.features.begin(), a.features.end(), b.features.begin(), b.features.end(),
                      [](const Feature& f, const Feature& g) { return f.id == g.id; });
}

} // namespace

void Session::setTf(TransferFunction tf) {
    PELLUCID_CHECK(!isEmpty());
    const std::shared_ptr<const TransferFunction> held = this->tf();
    const TransferFunction* const before = held.get();
    Identification identification(tf);
    identification.adopt(before, *goals);
    identification.addNew(firstUnused(*this));

    // Every feature has a goal from its first day on, and is remembered when it leaves.
    goals.edit([&](FeatureGoals& all) {
        const double target = averageTarget(tf, all);
        FeatureGoal fresh;
        fresh.target = target;
        for (const Feature& f : tf.features) all.try_emplace(f.id, fresh);
        if (before == nullptr) return;
        for (const Feature& f : before->features)
            if (f.id != 0 && featureOf(tf, f.id) == nullptr) all[f.id].departed = {f.name, f.a, f.b};
    });

    std::vector<Variable> all = *variables;
    auto& keys = all.front().track.keys;
    const bool oneForAll = keys.size() <= 1 && adapt->mode == AdaptSettings::Mode::Static;
    const int key = keys.empty() ? 0 : oneForAll ? keys.begin()->first : frame;
    const auto there = keys.find(key);
    if (there != keys.end() && *there->second == tf && sameIdentities(*there->second, tf)) return;
    keys[key] = Part<TransferFunction>(std::move(tf));
    all.front().track.adapted.erase(key); // of another key; until it is made anew, what was set is shown
    variables = std::move(all);           // not edit(): equal features may have become other ones
}

void Session::identifyFeatures() {
    std::vector<Variable> all = *variables;
    FeatureId next = firstUnused(*this);
    bool changed = false;
    for (Variable& v : all) {
        const TransferFunction* before = nullptr;
        for (auto& [from, part] : v.track.keys) {
            TransferFunction tf = *part;
            Identification identification(tf);
            identification.adopt(before, *goals);
            identification.addNew(next);
            for (const Feature& f : tf.features) next = std::max(next, f.id + 1);
            if (!sameIdentities(tf, *part)) {
                part = Part<TransferFunction>(std::move(tf));
                changed = true;
            }
            before = &*part;
        }
    }
    if (changed) variables = std::move(all);
}

void Session::addRun(Run run) {
    runs.edit([&](std::vector<Run>& all) {
        run.number = 1;
        for (const Run& other : all) run.number = std::max(run.number, other.number + 1);
        all.push_back(std::move(run));
        if (all.size() > kMostRuns) all.erase(all.begin());
    });
}

std::vector<std::vector<double>> knownAnswers(const std::vector<Run>& runs, const std::vector<double>& targets) {
    constexpr double kSame = 1e-9; // of shares
    std::vector<std::vector<double>> answers;
    for (const Run& run : runs) {
        if (run.best >= run.history.size() || run.targets.size() != targets.size()) continue;
        double off = 0;
        for (std::size_t f = 0; f < targets.size(); ++f) off = std::max(off, std::abs(run.targets[f] - targets[f]));
        if (off < kSame) answers.push_back(run.history[run.best].opacity);
    }
    return answers;
}

Run runOf(const OptimizeResult& result, RunStart start) {
    Run run;
    run.kind = "optimize";
    run.ended = name(result.reason);
    for (const Feature& f : start.tf.features) run.features.push_back(f.name);
    run.targets = result.targets;
    run.history = result.history;
    run.best = result.best;
    if (!result.history.empty()) {
        run.before = result.history.front().objective;
        run.after = result.history[result.best].objective;
    }
    run.iterations = result.iterations();
    run.evaluations = result.evaluations;
    run.start = std::move(start);
    return run;
}

std::vector<double> targetsOf(const TransferFunction& tf, const FeatureGoals& goals) {
    const std::size_t n = tf.features.size();
    std::vector<double> targets(n, -1.0);
    double sum = 0;
    std::size_t known = 0;
    for (std::size_t i = 0; i < n; ++i)
        if (const FeatureGoal* goal = goalOf(tf.features[i], goals)) {
            targets[i] = goal->target;
            sum += targets[i];
            ++known;
        }
    if (!(sum > 0)) return shownShares(tf, std::vector<double>(n, n == 0 ? 0.0 : 1.0 / static_cast<double>(n)));
    const double mean = sum / static_cast<double>(known);
    for (double& t : targets)
        if (t < 0) {
            t = mean;
            sum += mean;
        }
    // Locked targets are shares; the others divide what they leave.
    double locked = 0, free = 0;
    const std::vector<bool> held = heldTargets(tf, goals);
    for (std::size_t i = 0; i < n; ++i)
        if (!tf.features[i].hidden) (held[i] ? locked : free) += targets[i];
    if (locked > 0 && locked <= 1 && free > 0) {
        // Shares that sum to 1 already keep their bits.
        const double factor = std::abs(locked + free - 1) > 1e-12 ? (1 - locked) / free : 1;
        for (std::size_t i = 0; i < n; ++i)
            if (tf.features[i].hidden)
                targets[i] = 0;
            else if (!held[i])
                targets[i] *= factor;
        return targets;
    }
    if (std::abs(sum - 1) > 1e-12)
        for (double& t : targets) t /= sum;
    return shownShares(tf, std::move(targets));
}

std::vector<OpacityLimits> limitsOf(const TransferFunction& tf, const FeatureGoals& goals) {
    std::vector<OpacityLimits> limits(tf.features.size());
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const Feature& feature = tf.features[i];
        if (const FeatureGoal* goal = goalOf(feature, goals)) limits[i] = {goal->lowest, goal->highest, goal->locked};
        limits[i].locked = limits[i].locked || feature.hidden;
    }
    return limits;
}

FeatureGoals withTargets(FeatureGoals goals, const TransferFunction& tf, const std::vector<double>& targets) {
    for (std::size_t i = 0; i < targets.size() && i < tf.features.size(); ++i)
        if (!tf.features[i].hidden) goals[tf.features[i].id].target = targets[i];
    return goals;
}

std::vector<bool> heldTargets(const TransferFunction& tf, const FeatureGoals& goals) {
    std::vector<bool> held;
    for (const Feature& f : tf.features) {
        const FeatureGoal* goal = goalOf(f, goals);
        held.push_back(f.hidden || (goal != nullptr && goal->targetLocked));
    }
    return held;
}

std::vector<double> withTarget(std::vector<double> targets, std::size_t feature, double value,
                               const std::vector<bool>& held) {
    if (feature >= targets.size()) return targets;
    double kept = 0, others = 0, free = 0;
    const auto isFree = [&](std::size_t i) { return i != feature && (held.empty() || !held[i]); };
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (isFree(i)) {
            others += targets[i];
            ++free;
        } else if (i != feature) {
            kept += targets[i];
        }
    }
    if (free == 0) return targets; // what is left is its own
    const double room = std::max(0.0, 1 - kept);
    value = std::clamp(value, 0.0, room);
    for (std::size_t i = 0; i < targets.size(); ++i)
        if (isFree(i)) targets[i] = others > 1e-9 ? targets[i] / others * (room - value) : (room - value) / free;
    targets[feature] = value;
    return targets;
}

FeatureGoals withTargetLocked(FeatureGoals goals, const TransferFunction& tf, std::size_t feature, bool locked) {
    const std::vector<double> shares = targetsOf(tf, goals); // stored as such, which a lock holds
    goals = withTargets(std::move(goals), tf, shares);
    goals[tf.features.at(feature).id].targetLocked = locked;
    return goals;
}

} // namespace pellucid
