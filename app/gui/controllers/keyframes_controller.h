// Keyframes of a film: which there are, what the playhead shows of them, and their files.
#pragma once

#include <optional>

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>

#include "session/keyframes.h"
#include "session/scene.h"

class QAction;

namespace pellucid::gui {

class FilmController;
class PlayerController;
class Services;

struct KeyframeActions {
    QAction *add, *replace, *remove, *previous, *next, *play, *open, *save, *film;
};

/// The keys are part of the session. One is selected, where there are any. The playhead stands at a time; moving it
/// shows in the view what the film has there: while it moves as a preview, at rest as one step of the history, the
/// camera in its own. Many moves in a row are one step.
class KeyframesController : public QObject {
    Q_OBJECT
public:
    static constexpr double kUsualWay = 2; ///< s from the last key to one that is added after it

    KeyframesController(Services& services, PlayerController& player, FilmController& films);

    void addActions();
    const KeyframeActions& actions() const { return m_actions; }

    const Keyframes& keys() const; ///< those that are shown, a drag under way included
    int selected() const;          ///< place of the selected key; −1: there are none
    double playhead() const { return m_playhead; }
    double length() const; ///< time of the last key, s

    /// Keeps what is shown as a key: at the playhead where no key is, else kUsualWay after the last one.
    void add();
    void replace();                     ///< the selected key gets what is shown
    void remove();                      ///< the selected one
    void setTime(double seconds);       ///< of the selected key; where another key is, after that
    void rename(const QString& name);   ///< the selected one
    void setEasing(Easing easing);      ///< from the selected key to the next one
    void select(int key);               ///< and goes to its time
    void selectBeside(int by);          ///< as many keys on, or back
    void dragKey(int key, double time); ///< a key of those before the drag; until endDrag()
    void endDrag(bool keeps);           ///< as one step, or as it was before

    void moveTo(double time); ///< the playhead; the view follows until rest() or giveUp()
    void rest();              ///< what is shown stays, as a step
    void giveUp();            ///< everything as it was before the playhead moved, where it has not come to rest
    void goTo(double time);   ///< moveTo() and rest()
    void play();              ///< in real time, from the playhead, at the end from the first key; at the end it rests
    void pause();
    bool isPlaying() const { return m_timer.isActive(); }

    void open(const QString& path); ///< as one step; errors are shown
    void save(const QString& path); ///< likewise

Q_SIGNALS:
    void changed(); ///< keys, which one is selected, the playhead, playing

private:
    struct Before { ///< the playhead moved
        Camera camera;
        int frame = 0;
        double playhead = 0;
        int gesture = 0; ///< of the camera
    };
    void show();
    void follow(const Scene& before, const Scene& after);
    void edit(const QString& text, const QString& mergeKey, const std::function<void(Keyframes&)>& change);
    double timeOfNext() const;
    bool isAtKey(int key) const;

    Services& m_services;
    PlayerController& m_player;
    FilmController& m_films;
    KeyframeActions m_actions{};
    double m_playhead = 0;
    int m_selected = 0;
    std::optional<Before> m_before; ///< while what is shown is a preview
    std::optional<int> m_dragged;   ///< a key, as they were before the drag
    std::optional<int> m_awaited;   ///< frame that the playhead waits for
    QTimer m_timer;
    QElapsedTimer m_clock;
    double m_playedFrom = 0; ///< s, where the clock began
};

} // namespace pellucid::gui
