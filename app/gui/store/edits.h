// The edits that several panels make.
#pragma once

#include <functional>
#include <type_traits>

#include "store/session_store.h"

namespace pellucid::gui {

/// A change of one part of the session: `changing(&Session::display, [](DisplaySettings& d) { … })`.
template <class T>
SessionStore::Change changing(Part<T> Session::*part, std::type_identity_t<std::function<void(T&)>> change) {
    return [=](Session& session) { (session.*part).edit(change); };
}
/// One step that changes one part of the session.
template <class T>
void editPart(SessionStore& store, Part<T> Session::*part, const QString& text, const QString& mergeKey,
              std::type_identity_t<std::function<void(T&)>> change) {
    store.edit(text, mergeKey, changing(part, std::move(change)));
}
/// Changes the variable that is drawn; the session has one.
template <class Change>
void editVariable(Session& session, const Change& change) {
    session.variables.edit([&](std::vector<Variable>& all) { change(all.front()); });
}

/// `tf` is written for the window, as Scene::tf is; one without a range is taken to be.
inline void editTf(SessionStore& store, const TransferFunction& tf, const QString& text, const QString& mergeKey = {}) {
    store.edit(text, mergeKey, [&](Session& session) { session.setTf(tf); });
}
inline void previewTf(SessionStore& store, const TransferFunction& tf, const QString& text) {
    store.preview(text, [&](Session& session) { session.setTf(tf); });
}

/// The wanted shares of the features of Scene::tf, in their order.
inline void editTargets(SessionStore& store, const std::vector<double>& targets, const QString& text,
                        const QString& mergeKey = {}) {
    store.edit(text, mergeKey, [&, tf = store.scene().wantedTf()](Session& session) {
        session.goals.set(withTargets(*session.goals, tf, targets));
    });
}
/// One share; the others divide the rest, but for locked ones.
inline std::vector<double> targetsWith(const Scene& scene, int feature, double value) {
    return withTarget(scene.targets(), static_cast<std::size_t>(feature), value,
                      heldTargets(scene.wantedTf(), *scene.session.goals));
}
inline void previewTarget(SessionStore& store, int feature, double value, const QString& text) {
    const Scene& from = store.committed();
    const std::vector<double> targets = targetsWith(from, feature, value);
    store.preview(text, [&, tf = from.wantedTf()](Session& session) {
        session.goals.set(withTargets(*session.goals, tf, targets));
    });
}
inline void editTarget(SessionStore& store, int feature, double value, const QString& text,
                       const QString& mergeKey = {}) {
    store.commit();
    editTargets(store, targetsWith(store.scene(), feature, value), text, mergeKey);
}
/// Whether a feature's target stays where others are set.
inline void setTargetLocked(SessionStore& store, int feature, bool locked) {
    store.commit();
    store.edit(locked ? QObject::tr("Lock target") : QObject::tr("Unlock target"), {},
               [&, tf = store.scene().wantedTf()](Session& session) {
                   session.goals.set(withTargetLocked(*session.goals, tf, static_cast<std::size_t>(feature), locked));
               });
}
/// Why an empty feature has no target.
inline QString emptyFeatureText(const Scene& scene, int feature) {
    return QObject::tr("%1 is empty: no voxel has its values. There is nothing to aim at; move its borders.")
        .arg(QString::fromStdString(scene.tf.features.at(static_cast<std::size_t>(feature)).name));
}
/// What the session wants of a feature.
inline FeatureGoal goalOf(const Session& session, FeatureId feature) {
    const auto goal = session.goals->find(feature);
    return goal == session.goals->end() ? FeatureGoal() : goal->second;
}
/// What an optimization may do to a feature's opacity.
inline void editOpacityLimits(SessionStore& store, int feature, const OpacityLimits& limits, const QString& text) {
    store.commit();
    const FeatureId id = store.scene().tf.features.at(static_cast<std::size_t>(feature)).id;
    editPart(store, &Session::goals, text, {}, [&](FeatureGoals& goals) {
        FeatureGoal& goal = goals[id];
        goal.locked = limits.locked;
        goal.lowest = limits.lowest;
        goal.highest = limits.highest;
    });
}
/// As the session has them: a hidden feature is not locked by that here.
inline OpacityLimits opacityLimits(const SessionStore& store, int feature) {
    const FeatureGoal goal =
        goalOf(store.session(), store.scene().tf.features.at(static_cast<std::size_t>(feature)).id);
    return {goal.lowest, goal.highest, goal.locked};
}

} // namespace pellucid::gui
