// What every part of a window may use: the state, what was computed of it, and what can be done.
#pragma once

#include "jobs/job.h"
#include "services/actions.h"
#include "services/notices.h"
#include "services/panels.h"
#include "services/results.h"
#include "services/selection.h"
#include "session/workspace.h"
#include "store/session_store.h"

namespace pellucid::gui {

/// Panels and controllers get it; it knows none of them.
class Services : public QObject {
    Q_OBJECT
    // The order is that of making; what uses something comes after it, and goes before it.
    SessionStore m_store;
    Notices m_notices;
    Actions m_actions;
    Panels m_panels;
    Workspace m_workspace; // used on m_compute alone
    Lane m_compute;
    Results m_results;
    Selection m_selection;

public:
    /// `window` is the parent of dialogs.
    explicit Services(QWidget* window);

    QWidget* window() const { return m_window; }
    SessionStore& store() { return m_store; }
    const Scene& scene() const { return m_store.scene(); }
    Results& results() { return m_results; }
    Selection& selection() { return m_selection; }
    Notices& notices() { return m_notices; }
    Actions& actions() { return m_actions; }
    Panels& panels() { return m_panels; }
    Workspace& workspace() { return m_workspace; }
    Lane& compute() { return m_compute; }
    /// Index of the selected feature in the scene's transfer function; −1: none.
    int selectedFeature() const;
    const Feature* selected() const; ///< that feature; null: none

    /// Nothing may be edited: an optimization shows its moves.
    bool isReadOnly() const { return m_isHeld && m_isHeld(); }
    bool isEditable() const { return m_store.hasVolume() && !isReadOnly(); }
    /// The figures are of the present state, and nothing is under way.
    bool isIdle() const;
    /// For those who work: whether they do. Who changes what these say emits readOnlyChanged, idleChanged.
    void setReadOnlyWhile(std::function<bool()> isHeld) { m_isHeld = std::move(isHeld); }
    void addWork(std::function<bool()> isBusy) { m_work.push_back(std::move(isBusy)); }

    void showError(const QString& title, const Error& error);
    /// Does something that may throw Error, which is shown then. Whether all went well.
    bool attempt(const QString& title, const std::function<void()>& work);
    void showFailuresOf(JobBase& job, const QString& title); ///< from now on, whenever it fails
    /// In the status line: what was saved, in which folder, and what more there is to say of it.
    void saySaved(const QString& path, const QString& more = {});
    /// A step of the history, which the status line names; where it fails the state stays, and people are told.
    void undo();
    void redo();

Q_SIGNALS:
    void readOnlyChanged();
    void idleChanged(); ///< isIdle() may have changed
    /// For a moment in the status line.
    void message(const QString& text);

private:
    QWidget* m_window;
    std::function<bool()> m_isHeld;
    std::vector<std::function<bool()>> m_work;
};

/// For actions: does `act(services, index)` to the feature that is selected then, if one is.
template <class Act>
std::function<void()> toSelected(Services& services, const Act& act) {
    return [&services, act] {
        if (const int feature = services.selectedFeature(); feature >= 0) act(services, feature);
    };
}

} // namespace pellucid::gui
