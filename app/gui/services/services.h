// What every part of a window may use: the state, what was computed of it, and what can be done.
#pragma once

#include <QObject>

#include "jobs/lane.h"
#include "services/actions.h"
#include "services/notices.h"
#include "services/results.h"
#include "services/selection.h"
#include "session/workspace.h"
#include "store/session_store.h"

class QWidget;

namespace pellucid::gui {

class FieldController;
class LiveController;
class OpenController;
class OptimizeController;
class PlayerController;
class RecoveryController;
class RefineController;
class SaveController;
class StartController;

/// The services of one window. Panels and controllers get it, and know nothing of each other.
class Services : public QObject {
    Q_OBJECT
    // The order is that of making; what uses something comes after it, and goes before it.
    SessionStore m_store;
    Notices m_notices;
    Actions m_actions;
    Workspace m_workspace; // used on m_compute alone
    Lane m_compute;
    Results m_results;
    Selection m_selection;

public:
    /// `window` is the parent of dialogs.
    explicit Services(QWidget* window);
    ~Services() override;

    QWidget* window() const { return m_window; }
    SessionStore& store() { return m_store; }
    const Scene& scene() const { return m_store.scene(); }
    Results& results() { return m_results; }
    Selection& selection() { return m_selection; }
    Notices& notices() { return m_notices; }
    Actions& actions() { return m_actions; }
    Workspace& workspace() { return m_workspace; }
    Lane& compute() { return m_compute; }
    OpenController& opening() { return *m_opening; }
    SaveController& saving() { return *m_saving; }
    OptimizeController& optimizing() { return *m_optimizing; }
    StartController& start() { return *m_start; }
    RecoveryController& recovery() { return *m_recovery; }
    RefineController& refining() { return *m_refining; }
    FieldController& fields() { return *m_fields; } ///< what is drawn in the place of the data
    LiveController& live() { return *m_live; }
    PlayerController& player() { return *m_player; } ///< frames of a series

    /// Nothing may be edited: an optimization shows its moves.
    bool isReadOnly() const;
    /// The figures are of the present state, and nothing is under way.
    bool isIdle() const;

    void showError(const QString& title, const Error& error);
    /// A step of the history; where it fails the state stays, and `failure` is told.
    void goBack(const std::function<void()>& step, const QString& failure);

Q_SIGNALS:
    void readOnlyChanged();
    void idleChanged(); ///< isIdle() may have changed
    /// For a moment in the status line.
    void message(const QString& text);

private:
    void addEditActions();

    QWidget* m_window;
    std::unique_ptr<OptimizeController> m_optimizing;
    std::unique_ptr<RefineController> m_refining;
    std::unique_ptr<FieldController> m_fields;
    std::unique_ptr<LiveController> m_live;
    std::unique_ptr<SaveController> m_saving;
    std::unique_ptr<OpenController> m_opening;
    std::unique_ptr<StartController> m_start;
    std::unique_ptr<RecoveryController> m_recovery;
    std::unique_ptr<PlayerController> m_player;
};

} // namespace pellucid::gui
