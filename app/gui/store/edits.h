// The edits that several panels make.
#pragma once

#include "store/session_store.h"

namespace pellucid::gui {

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
    store.edit(text, mergeKey, [&, tf = store.scene().tf](Session& session) {
        session.goals.set(withTargets(*session.goals, tf, targets));
    });
}
/// One share; the others divide the rest.
inline void previewTarget(SessionStore& store, int feature, double value, const QString& text) {
    const Scene& from = store.committed();
    const std::vector<double> targets = withTarget(from.targets(), static_cast<std::size_t>(feature), value);
    store.preview(text,
                  [&, tf = from.tf](Session& session) { session.goals.set(withTargets(*session.goals, tf, targets)); });
}
inline void editTarget(SessionStore& store, int feature, double value, const QString& text,
                       const QString& mergeKey = {}) {
    store.commit();
    editTargets(store, withTarget(store.scene().targets(), static_cast<std::size_t>(feature), value), text, mergeKey);
}

} // namespace pellucid::gui
