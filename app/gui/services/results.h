// What has been computed of scenes: figures and derivatives, each with the state that it was computed from.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include <QElapsedTimer>
#include <QObject>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "session/workspace.h"
#include "store/session_store.h"

namespace pellucid::gui {

/// Keeps figures up to date with the store, and never makes the window wait: during a drag or a rotation, the latest
/// state is measured as soon as the measurement before is done. A result belongs to the input that it was computed
/// from. It is current while that is the present input, and comes back with it (undo).
class Results : public QObject {
    Q_OBJECT
public:
    /// `workspace` is used on `lane` alone; both outlive this.
    Results(SessionStore& store, Lane& lane, Workspace& workspace, QObject* parent = nullptr);

    /// The latest figures, of an older state until new ones come; null before the first, and where the latest are of
    /// other features than the present ones.
    const Measures* measures() const;
    bool measuresAreCurrent() const;
    bool vwsIsCurrent() const; ///< the figures are, or at least their VWS: after a move of an optimization
    /// The latest ∂W_i/∂x_j as [i][j], likewise.
    const std::vector<std::vector<double>>* influence() const;
    bool influenceIsCurrent() const;
    /// Who hides whom, measured with the influence and as current as that.
    const OcclusionMatrix* occlusion() const;
    /// F, of the latest figures and the present targets; empty without figures.
    std::optional<double> objective() const;

    enum class State { Nothing, Measuring, Current, Failed };
    State state() const;
    bool isBusy() const { return m_measuring.isRunning() || m_throttle.isActive(); }
    const QString& engineName() const { return m_engine; }            ///< what measured last; empty before
    const std::optional<Error>& failure() const { return m_failure; } ///< of the present state

    /// Whether derivatives are computed too, after the figures.
    void setInfluenceWanted(bool wanted);
    /// While paused nothing is measured (an optimization uses the lane); going on measures what is not current.
    void setPaused(bool paused);
    /// Figures that somebody else has computed: a move of an optimization, which tells VWS alone. `tf`, in place of
    /// that of `input`, is with what is hidden of it. Returns what it measured.
    MeasureInput addVws(MeasureInput input, const TransferFunction& tf, const std::vector<double>& vws);

Q_SIGNALS:
    void changed(); ///< figures, whether they are current, or what is under way
    void failed(const pellucid::Error& error);

private:
    struct Figures {
        MeasureInput input;
        std::optional<Measures> measures;
        std::optional<std::vector<std::vector<double>>> influence;
        OcclusionMatrix occlusion; // where there is an influence
        std::optional<Coverage> coverage;
        QString engine;
    };
    struct Request {
        MeasureInput input;
        bool measures = true, influence = false, coverage = false;
    };

    void follow(const Scene& before, const Scene& after);
    void request();
    void begin();
    void keep(Figures figures);
    void show(const Figures& figures);
    bool lacksCoverage() const; // of current figures: it waits until the hand rests
    std::deque<Figures>::const_iterator known(const MeasureInput& input) const;
    bool isShowable(const Figures& figures) const; // they are of the present features
    bool isPresent(const Figures& figures) const;

    SessionStore& m_store;
    std::deque<Figures> m_known;   // the latest first
    MeasureInput m_present;        // of the store's scene
    Figures m_measured, m_derived; // what is shown: the latest that came, or that came back
    bool m_vwsOnly = false;        // of m_measured: the rest of it is of an older state
    std::optional<Error> m_failure;
    QString m_engine;
    bool m_influenceWanted = false, m_paused = false;
    RestTimer m_throttle{0, [this] { begin(); }};
    QElapsedTimer m_sinceStart;
    qint64 m_lastTook = 0; // milliseconds
    Job<Request, Figures> m_measuring;
};

} // namespace pellucid::gui
