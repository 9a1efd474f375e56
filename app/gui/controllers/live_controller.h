// Live targets: opacities follow whatever else changes, so that the targets are held.
#pragma once

#include <map>
#include <optional>
#include <set>

#include <QObject>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "session/live_targets.h"

class QAction;

namespace pellucid::gui {

class OptimizeController;
class Services;

/// While Session::holdTargets is set, every change that VWS or the targets depend on is followed by updates of a move
/// or two each, always of the latest state; when everything rests, a last one goes as far as it can. The opacities that
/// they set become part of the step before (SessionStore::amend()). An opacity that the user sets stays, and the others
/// follow.
class LiveController : public QObject {
    Q_OBJECT
public:
    LiveController(Services& services, OptimizeController& optimizing);

    void addActions();
    QAction* action() const { return m_action; } ///< on and off

    bool isOn() const;
    /// The targets are not held yet, or nobody knows.
    bool isBusy() const { return m_job.isRunning() || m_rest.isActive(); }

Q_SIGNALS:
    void busyChanged();
    void updated(double objective); ///< F after an update

private:
    struct Task {
        HeldTargets held;
        TransferFunction tf; ///< with what is hidden of it
        bool settles = false;
    };

    Task present() const;
    void follow(const Scene& before, const Scene& after);
    void begin(bool settles);
    void stop();
    void finish(const Task& task, const LiveUpdate& update);
    void pinWhatWasSet(const Scene& before, const Scene& after);

    Services& m_services;
    OptimizeController& m_optimizing;
    QAction* m_action = nullptr;
    std::set<FeatureId> m_pinned;         ///< whose opacity was set by hand in the latest change
    std::map<FeatureId, double> m_wanted; ///< opacities of the latest update
    bool m_applying = false;              ///< what happens to the scene is an update
    bool m_settling = false;              ///< the update under way is that at rest
    bool m_dirty = false;                 ///< something has changed since the update under way began
    std::optional<HeldTargets> m_settled;
    /// Milliseconds without a change before the last moves are made.
    RestTimer m_rest{150, [this] { m_job.isRunning() ? m_rest.start() : begin(true); }};
    Job<Task, LiveUpdate> m_job;
};

} // namespace pellucid::gui
