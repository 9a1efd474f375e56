#include "session/track_keys.h"

#include <set>

namespace pellucid {

bool adaptsOtherwise(const Session& a, const Session& b) {
    return !a.variables.isSame(b.variables) || !a.adapt.isSame(b.adapt) || !a.targetKeys.isSame(b.targetKeys) ||
           !a.goals.isSame(b.goals) || !a.refine.isSame(b.refine) || !a.optimize.isSame(b.optimize) ||
           !a.measure.isSame(b.measure) || !a.clipping.isSame(b.clipping) || !a.hsb.isSame(b.hsb) ||
           a.camera != b.camera || a.frame != b.frame;
}

void setTfKey(Session& session) {
    const TransferFunction tf = *session.tf();
    session.variables.edit([&](std::vector<Variable>& all) {
        all.front().track.keys[session.frame] = Part<TransferFunction>(tf);
        all.front().track.adapted.erase(session.frame);
    });
}

void removeTfKey(Session& session) {
    session.variables.edit([&](std::vector<Variable>& all) { all.front().track.keys.erase(session.frame); });
}

void beginTracksHere(Session& session) {
    setTfKey(session);
    session.variables.edit([&](std::vector<Variable>& all) {
        TfTrack& track = all.front().track;
        track.keys.erase(track.keys.upper_bound(session.frame), track.keys.end());
        track.adapted.erase(track.adapted.lower_bound(session.frame), track.adapted.end());
    });
}

void setTargetKey(Session& session) {
    std::map<FeatureId, double> targets;
    for (const auto& [id, goal] : *session.goals) targets[id] = goal.target;
    session.targetKeys.edit([&](TargetKeys& keys) { keys[session.frame] = std::move(targets); });
}

std::optional<int> keyBeside(const Session& session, int frame, int direction) {
    std::set<int> frames;
    for (const auto& [key, tf] : session.variable().track.keys) frames.insert(key);
    for (const auto& [key, targets] : *session.targetKeys) frames.insert(key);
    const auto after = frames.upper_bound(frame), here = frames.lower_bound(frame);
    if (direction > 0 && after != frames.end()) return *after;
    if (direction < 0 && here != frames.begin()) return *std::prev(here);
    return {};
}

} // namespace pellucid
