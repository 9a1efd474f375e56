// Optimization: start, watch, stop, and what is said of them.
#pragma once

#include <QElapsedTimer>
#include <QObject>

#include "jobs/job.h"
#include "session/workspace.h"

namespace pellucid::gui {

class Workbench;

/// While an optimization runs, its moves are previewed; it ends as one undo step, or without a trace. What it found is
/// true of the camera and targets that it began with, and is said for as long as they are the present ones.
class OptimizeController : public QObject {
    Q_OBJECT
public:
    explicit OptimizeController(Workbench& bench);
    ~OptimizeController() override;

    void addActions();

    void start();
    void cancel();
    bool isRunning() const { return m_job.isRunning(); }

    /// Of the run under way: its latest move (0 is the start; −1 before), and the distance F there.
    int move() const { return m_move; }
    double objective() const { return m_objective; }
    double firstObjective() const { return m_firstObjective; }
    /// Its record so far; null where none runs.
    const Run* underWay() const { return isRunning() ? &m_run : nullptr; }

    /// What came of the latest run, or what somebody else has said; empty as soon as it is not true of the present
    /// state any more.
    const QString& message() const { return m_message; }
    void say(const QString& text);

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
        int number = 0;
        RunStart start() const { return {tf, input.view.camera, input.view.clipping, input.settings, options, limits}; }
    };

    About present() const;
    void showMove(const Task& task, int move, const OptimizeState& state);
    void finish(const Task& task, const OptimizeResult& result);

    Workbench& m_bench;
    QString m_message;
    About m_about;
    int m_number = 0; ///< of the latest run: answers of others are dropped
    int m_move = -1;
    double m_objective = 0, m_firstObjective = 0;
    Run m_run;
    QElapsedTimer m_since; // the run's start
    Job<Task, OptimizeResult> m_job;
};

} // namespace pellucid::gui
