// Optimization: start, watch, stop, and what is said of them.
#pragma once

#include <QElapsedTimer>
#include <QObject>

#include "jobs/job.h"
#include "services/notices.h"
#include "session/workspace.h"

namespace pellucid::gui {

class Services;

/// The outcome of an optimization in a sentence or two, which is true only of the view that it was made for.
/// `restarts`: how often it began anew because the view had turned.
QString sayOf(const OptimizeResult& result, int restarts = 0);

/// While an optimization runs, its moves are previewed; it ends as one undo step, or without a trace. When the view
/// turns meanwhile, it begins anew from the opacities that it has reached. What it found is true of the camera and the
/// targets that it ended with, and is shown for as long as these are the present ones.
class OptimizeController : public QObject {
    Q_OBJECT
public:
    explicit OptimizeController(Services& services);
    ~OptimizeController() override;

    void addActions();

    void start();
    void cancel() { m_job.cancel(); }
    bool isRunning() const { return m_job.isRunning(); }
    /// What it has found is being put in place: nothing shall follow of that by itself.
    bool isAnswering() const { return m_answering; }

    /// Of the run under way: its latest move (0 is the start; −1 before), and the distance F there.
    int move() const { return m_move; }
    double objective() const { return m_objective; }
    double firstObjective() const { return m_firstObjective; }
    /// Its record so far; null where none runs.
    const Run* underWay() const { return isRunning() ? &m_run : nullptr; }
    int restarts() const { return m_restarts; } ///< because the view has turned

    /// Whether the reason is being looked for why the latest run is not on target.
    bool isExplaining() const { return m_question || m_explaining.isRunning(); }
    bool isBusy() const { return isRunning() || isExplaining(); }

    /// What came of the latest run, or what somebody else has said; empty as soon as it is not true of the present
    /// state any more.
    const QString& message() const { return m_message; }
    void say(const QString& text, std::vector<Notice::Choice> choices = {});
    /// What can be done about it, a button each; they are true of the same state.
    const std::vector<Notice::Choice>& choices() const { return m_choices; }
    void take(std::size_t choice);

Q_SIGNALS:
    void runningChanged();
    void moved(); ///< move() and objective() have changed
    void messageChanged();

private:
    /// What a message is about.
    struct About {
        MeasureInput input;
        std::vector<double> targets;
        bool operator==(const About&) const = default;
    };
    struct Task {
        MeasureInput input;
        TransferFunction tf; ///< with what is hidden of it
        std::vector<double> targets;
        std::vector<OpacityLimits> limits;
        OptimizeOptions options;
        std::vector<std::vector<double>> known = {}; ///< answers of earlier runs for the same targets
        int number = 0;
        RunStart start() const { return {tf, input.view.camera, input.view.clipping, input.settings, options, limits}; }
    };

    About present() const;
    /// For a run that kept the picture visible instead of the shares asked for: these, as a step of their own.
    std::vector<Notice::Choice> exactShares(const OptimizeResult& result);
    void begin(Task task);
    void restart(const View& view);
    void showMove(const Task& task, int move, const OptimizeState& state);
    void finish(const Task& task, const OptimizeResult& result);
    /// What a run that is not on target is to be explained by.
    struct Question {
        Task task; ///< with the input that was found
        OptimizeResult found;
    };
    void askWhy();

    Services& m_services;
    QString m_message;
    std::vector<Notice::Choice> m_choices;
    About m_about;
    Task m_task;                   ///< the latest
    std::vector<double> m_opacity; ///< of its latest move; empty before
    int m_number = 0;              ///< of the latest run: answers of others are dropped
    int m_move = -1, m_restarts = 0;
    double m_objective = 0, m_firstObjective = 0;
    bool m_answering = false;
    Run m_run;
    QElapsedTimer m_since;              // the run's start
    std::optional<Question> m_question; // waits for the figures of the answer, which come first
    Job<Task, OptimizeResult> m_job;
    Job<Question, Verdict> m_explaining;
};

} // namespace pellucid::gui
