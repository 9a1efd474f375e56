// Frames of a series: which one is shown, what plays, and what is read before it is wanted.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>

#include "jobs/job.h"
#include "session/scene.h"

class QAction;

namespace pellucid::gui {

class OpenController;
class Services;

struct PlayerActions {
    QAction *first, *previous, *play, *next, *last, *loops, *backward;
};

/// Plays, steps and scrubs. Frames are read on a thread of their own, ahead in the direction of play within the budget
/// of the series; the window never waits for one. While it plays a clock says which frame is due: those that came too
/// late are left out, and counted. A frame that cannot be read is told of once, and left out.
class PlayerController : public QObject {
    Q_OBJECT
public:
    static constexpr double kSlowest = 1, kFastest = 60; ///< frames a second

    PlayerController(Services& services, OpenController& opening);

    void addActions();
    const PlayerActions& actions() const { return m_actions; }

    bool hasSeries() const;
    int frameCount() const; ///< 0 where nothing is open
    int frame() const;      ///< that is shown
    /// That is being read in order to be shown; empty: none.
    std::optional<int> awaited() const { return m_wanted; }
    QString label(int frame) const; ///< "t = 12.3 s"
    /// Why it cannot be shown; empty: it can, as far as is known.
    QString problemOf(int frame) const;
    bool isHeld(int frame) const; ///< it would be shown at once

    void play();
    void pause();
    bool isPlaying() const { return m_playing; }
    /// To a frame, which is shown as soon as it is there; of several in a row the latest. What plays goes on from
    /// there.
    void goTo(int frame);
    void step(int by); ///< as many frames forward, or back; over those that cannot be read

    bool loops() const { return m_loops; }
    void setLoops(bool loops);
    void setBackward(bool backward);
    double speed() const { return m_speed; } ///< frames a second
    void setSpeed(double framesPerSecond);

    int dropped() const { return m_dropped; } ///< frames that were left out for being late, since play()
    double rate() const;                      ///< frames a second that have been shown lately; 0 before
    QString rateText() const;                 ///< "12 of 24 frames a second, 3 dropped"; empty before play()

    /// Frames that are not known yet are read, one by one, while nothing else is wanted; so that the strip can show
    /// them.
    bool isSurveying() const;
    int knownCount() const;
    void stopSurvey();
    void goOnSurveying();

    /// A frame is being waited for, or it plays.
    bool isBusy() const { return m_playing || m_wanted.has_value(); }
    /// An optimization shows its moves, or other data is being fetched: the frame stays.
    bool isHeldUp() const;
    /// The picture of this volume is on the screen.
    void pictureShown(const Volume* volume);

Q_SIGNALS:
    void changed();  ///< playing, awaited, speed, direction, what was dropped
    void surveyed(); ///< more frames are known
    void heldChanged();

private:
    struct Ask {
        Scene basis;
        int frame = 0;
        bool whole = true;        ///< else only its values are looked at
        std::vector<int> touched; ///< frames that shall be kept rather than others
    };
    struct Got {
        std::optional<Scene> scene;
        std::optional<Error> error;
    };
    static Got read(const Ask& ask, const JobControl& job);

    void follow(const Scene& before, const Scene& after);
    void deliver(const Ask& ask, Got& got);
    void next();
    bool show(int frame);
    void tick();
    void startTimer();
    void restartClock();
    int goodFrame(int from, int direction) const;
    std::vector<int> ahead() const;
    void reportProblems();

    Services& m_services;
    OpenController& m_opening;
    PlayerActions m_actions;
    QTimer m_timer;
    QElapsedTimer m_clock, m_sinceShown;
    int m_clockFrom = 0; ///< frame that was due when the clock began
    bool m_playing = false, m_loops = true, m_backward = false, m_hasPlayed = false;
    double m_speed = 12;
    int m_dropped = 0;
    std::deque<qint64> m_shownAt; ///< milliseconds of m_sinceStart
    QElapsedTimer m_sinceStart;
    std::optional<int> m_wanted;
    int m_wantedBy = 0; ///< direction in which another is looked for where it cannot be read; 0: none is
    bool m_pictureSeen = true, m_surveyStopped = false;
    std::map<int, Scene> m_ready; ///< for the next frames
    struct Problem {
        QString what, where;
    };
    std::map<int, Problem> m_broken;
    std::set<int> m_reported;
    QString m_summary;       ///< the notice of broken frames beyond the first ones
    Job<Ask, Got> m_reading; // last: it ends before the rest goes
};

} // namespace pellucid::gui
