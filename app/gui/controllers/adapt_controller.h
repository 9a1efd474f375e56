// Transfer functions that follow the frames of a series: key frames, and what is made for the frames between by itself.
#pragma once

#include <QObject>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "session/sequence.h"

class QAction;

namespace pellucid::gui {

class PlayerController;
class Services;

/// While transfer functions adapt to the frames of a series, this makes those that are missing or out of date, one
/// after the other, on a thread of its own. Each is put in place as soon as it is made, and is no step of the history;
/// where coherence asks for it, all are smoothed together at the end. Nothing is made while an optimization runs, data
/// are fetched, or the user drags something.
class AdaptController : public QObject {
    Q_OBJECT
public:
    AdaptController(Services& services, PlayerController& player);

    void addActions();
    /// Key of the transfer function, of targets, previous key, next key, from here on.
    const QList<QAction*>& keyActions() const { return m_keyActions; }

    /// All of these are undo steps.
    void setMode(AdaptSettings::Mode mode);
    void setCoherence(double coherence); ///< steps in a row become one
    /// The transfer function of this frame is a key: what is made for the frames after it begins here.
    void setTfKey();
    void removeTfKey();
    void setTargetKey(); ///< the targets of this frame are its own from now on
    void removeTargetKey();
    bool hasTfKey() const; ///< at this frame
    bool hasTargetKey() const;
    void goToKey(int direction); ///< the nearest before (−1) or after (1) this frame, of either kind

    /// The transfer function of this frame for all that come after it: keys after it go.
    void fromHereOn();

    /// Of the present state, as of the latest look; {0, 0} in the mode static.
    AdaptProgress progress() const { return m_progress; }
    double smoothing() const { return m_smoothing; } ///< fraction of the smoothing that is under way
    bool isStale(int frame) const;                   ///< what was made for it is of other inputs than the present ones
    /// Transfer functions are being made, or will be.
    bool isBusy() const { return m_job.isRunning() || m_timer.isActive(); }
    bool isStopped() const { return m_stopped; }
    void stop(); ///< until goOn(), or until mode or coherence are others
    void goOn();

Q_SIGNALS:
    void changed(); ///< progress, busy or stopped

private:
    /// What the job brings back.
    struct Answer {
        AdaptProgress before; ///< the step
        SequenceMaker::Step step;
    };
    void follow(const Scene& before, const Scene& after);
    void look();
    void finish(const Scene& basis, const Answer& answer);
    bool isWanted() const;

    Services& m_services;
    PlayerController& m_player;
    QList<QAction*> m_keyActions;
    AdaptProgress m_progress;
    int m_firstStale = -1, m_staleKey = -1;
    double m_smoothing = 0;
    bool m_stopped = false;
    RestTimer m_timer{60, [this] { look(); }}; ///< what is missing is looked for after so many milliseconds of rest
    SequenceMaker m_maker;                     ///< used in m_job alone, which does one thing at a time
    Lane m_lane;
    Job<Scene, Answer> m_job; // last: it ends before the rest goes
};

} // namespace pellucid::gui
