// What stands beside the present state: which state that is, figures and pictures of both, and their files.
#pragma once

#include <array>
#include <optional>

#include <QObject>
#include <QSize>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "render/standard_view.h"
#include "session/comparison.h"
#include "widgets/kept_renderer.h"

class QAction;

namespace pellucid::gui {

class ActionMenu;
class PlayerController;
class RefineController;
class Services;

struct CompareActions {
    QAction *pin, *run, *refinement, *tf, *session, *swap, *use, *clear, *savePictures, *saveDifference, *saveFigures;
};

/// A is the present state, B one that the session keeps (ComparisonView): no edit of A changes it, but for what both
/// share. B's scene follows at once where it needs no data, else as soon as its frame has been read. Figures and the
/// difference follow when both have rested; until then they are of an older state.
class ComparisonController : public QObject {
    Q_OBJECT
public:
    enum class State {
        Off,
        Field,     ///< a field is drawn, which is no picture of the data
        Computing, ///< also while it waits for both to rest, or for B's frame
        Current,
        Failed ///< failure() tells why
    };

    ComparisonController(Services& services, PlayerController& player, RefineController& refining);

    void addActions();
    const CompareActions& actions() const { return m_actions; }
    /// Of the view, pixels of the screen.
    void setPictureSize(const QSize& pixels);

    // ---- which state B is; a comparison that is off is switched on

    void pin(); ///< A as it is now
    /// The present state under another transfer function: a file, preset:NAME, tents:N[:PEAK], ramp:N.
    void compareWithTf(const QString& spec, const QString& name);
    void compareWithSession(const QString& path);
    void compareWithStep(int step); ///< as it was before a step of the history
    void compareWithRun();          ///< before the latest optimization, see latestRun()
    void compareWithRefinement();   ///< before the latest refinement
    void compareWithFrame(int frame);
    void compareWithView(StandardView view);
    const Run* latestRun() const; ///< an optimization that is known from its start on; null: none
    bool hasRefinement() const;

    void setMode(CompareMode mode);
    void change(const std::function<void(ComparisonView&)>& change); ///< no step of the history
    void turnB(const Camera& camera, int gesture);                   ///< both where they share the view
    void swap();
    void useB(); ///< its transfer function, one step
    void clear();

    const ComparisonView& view() const;
    bool hasB() const { return view().b.has_value(); }
    /// The pictures of both are shown.
    bool isShown() const { return m_sceneB && m_state != State::Off && m_state != State::Field; }
    const Scene* sceneB() const { return m_sceneB ? &*m_sceneB : nullptr; } ///< null: not yet

    State state() const { return m_state; }
    const std::optional<Error>& failure() const { return m_failure; }
    double progress() const { return m_progress; } ///< [0,1]
    /// The latest, of an older state unless state() is Current; null: none of the present A and B.
    const Comparison* comparison() const { return m_comparison ? &*m_comparison : nullptr; }
    quint64 version() const { return m_version; } ///< another one where comparison() has become another one
    /// That comparison() is of.
    const Camera& cameraOfA() const { return m_compared.a.picture.camera; }
    bool isBusy() const { return m_state == State::Computing || m_saving.isRunning(); }

    /// What saveTo() writes, of a comparison that is current.
    enum class File { SideBySide, Difference, Figures };
    void save(File file, const QString& path); ///< in the background
    void chooseFile(File file);

Q_SIGNALS:
    void changed();      ///< state, figures or progress
    void sceneChanged(); ///< sceneB(), isShown() or view() may have
    void busyChanged();
    void saved(const QString& path);

private:
    struct Inputs {
        SideInput a, b;
        bool operator==(const Inputs&) const = default;
    };
    using Side = std::shared_ptr<const ComparedSide>;
    struct Request {
        Inputs inputs;
        std::optional<Measures> measuresOfA; ///< that somebody has measured already
        std::array<Side, 2> known;           ///< null: to be made
    };
    struct Fetch {
        Session session;
        Scene basis;
    };
    struct Task {
        File file;
        Comparison comparison;
        QString path;
    };
    class Worker;

    void follow();
    bool followB();
    void showB(Scene scene);
    void followFigures();
    void begin();
    void keep(const Request& request, std::array<Side, 2>& sides);
    void fail(const Error& error);
    void setState(State state);
    void reset();
    /// Makes it B.
    void compareWith(ComparedState b, const std::function<void(ComparisonView&)>& how = {});
    ComparedState present(const QString& name) const;
    void addChoices(ActionMenu& menu);
    void addModes(ActionMenu& menu);
    void addFiles(ActionMenu& menu);

    Services& m_services;
    PlayerController& m_player;
    RefineController& m_refining;
    CompareActions m_actions = {};
    State m_state = State::Off;
    QSize m_size;
    Session m_wantedB;             ///< comparedSession() of the present one
    std::optional<Scene> m_sceneB; ///< of an older m_wantedB while its frame is being read
    Inputs m_wanted, m_compared;   ///< m_compared: of m_comparison
    std::array<Side, 2> m_sides;   ///< of m_compared
    std::optional<Comparison> m_comparison;
    std::optional<Error> m_failure;
    double m_progress = 0;
    quint64 m_version = 0;
    RestTimer m_rest{250, [this] { begin(); }};
    std::shared_ptr<Worker> m_worker;
    Job<Fetch, Scene> m_fetching; // last: they end before the rest goes
    Job<Request, std::array<Side, 2>> m_comparing;
    Job<Task, QString> m_saving;
};

/// What a state is called that is taken at this moment: "Pinned at 14:03:22".
QString nameByClock(const QString& text);

} // namespace pellucid::gui
