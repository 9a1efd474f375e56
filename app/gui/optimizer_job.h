// An optimization in the background.
#pragma once

#include <stop_token>

#include <QObject>
#include <QString>

#include "compute_thread.h"
#include "optimize/optimizer.h"

namespace pellucid::gui {

/// Runs one optimization at a time on the compute thread. Signals arrive in the thread of this object.
class OptimizerJob : public QObject {
    Q_OBJECT
public:
    explicit OptimizerJob(ComputeThread& thread, QObject* parent = nullptr);
    ~OptimizerJob() override;

    void start(const std::shared_ptr<const Volume>& volume, const TransferFunction& tf, const Camera& camera,
               const std::vector<double>& targets, const OptimizeOptions& options);
    bool isRunning() const { return m_running; }
    /// Asks it to stop; `cancelled` follows.
    void cancel();

Q_SIGNALS:
    /// The start (move 0) and each move after it.
    void moved(int move, const pellucid::OptimizeState& state);
    void finished(const pellucid::OptimizeResult& result);
    void cancelled();
    void failed(const QString& what, const QString& where, const QString& whatToDo);

private:
    ComputeThread& m_thread;
    std::stop_source m_stop;
    bool m_running = false;
};

} // namespace pellucid::gui
