#include "optimizer_job.h"

#include <new>

namespace pellucid::gui {

OptimizerJob::OptimizerJob(ComputeThread& thread, QObject* parent) : QObject(parent), m_thread(thread) {}

OptimizerJob::~OptimizerJob() { m_stop.request_stop(); }

void OptimizerJob::cancel() { m_stop.request_stop(); }

void OptimizerJob::start(const std::shared_ptr<const Volume>& volume, const TransferFunction& tf, const Camera& camera,
                         const std::vector<double>& targets, const OptimizeOptions& options) {
    if (m_running) return;
    m_running = true;
    m_stop = std::stop_source();
    const JobControl job{m_stop.get_token(), {}};
    const auto fail = [this](const QString& what, const QString& where, const QString& whatToDo) {
        QMetaObject::invokeMethod(this, [=, this] {
            m_running = false;
            Q_EMIT failed(what, where, whatToDo);
        });
    };
    const auto stopped = [this] {
        QMetaObject::invokeMethod(this, [this] {
            m_running = false;
            Q_EMIT cancelled();
        });
    };
    m_thread.submit([=, this](ComputeCache& cache) {
        try {
            job.throwIfStopped();
            VisibilityEngine& engine = cache.engine(volume);
            const WeightFields& weights = cache.weights(volume, tf, job);
            const VwsFunction function(engine, camera, tf, weights);
            int move = 0;
            const auto watch = [this, &move, &job](const OptimizeState& state) {
                if (job.stop.stop_requested()) return;
                QMetaObject::invokeMethod(this, [this, state, number = move++] {
                    if (m_running && !m_stop.stop_requested()) Q_EMIT moved(number, state);
                });
            };
            OptimizeResult result = optimize(function, targets, options, job, watch);
            if (result.reason == StopReason::Cancelled) return stopped();
            QMetaObject::invokeMethod(this, [this, result = std::move(result)] {
                m_running = false;
                // Asked to stop at the very end: whoever asked does not expect a result any more.
                if (m_stop.stop_requested()) {
                    Q_EMIT cancelled();
                } else {
                    Q_EMIT finished(result);
                }
            });
        } catch (const Cancelled&) {
            stopped();
        } catch (const Error& error) {
            fail(QString::fromStdString(error.problem()), QString::fromStdString(error.where()),
                 QString::fromStdString(error.whatToDo()));
        } catch (const std::bad_alloc&) {
            fail(tr("not enough memory for the optimization"), {},
                 tr("close other programs, or open a smaller volume"));
        } catch (const std::exception& error) { // ours to mend, but no reason to end the program
            fail(tr("unexpected failure: %1").arg(QString::fromLocal8Bit(error.what())), {}, tr("please report this"));
        }
    });
}

} // namespace pellucid::gui
