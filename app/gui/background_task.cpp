#include "background_task.h"

#include <new>

namespace pellucid::gui {

BackgroundTask::BackgroundTask(QObject* parent) : QObject(parent) {}

BackgroundTask::~BackgroundTask() {
    for (auto& [run, thread] : m_threads) thread.request_stop();
    m_threads.clear(); // joins
}

void BackgroundTask::cancel() {
    if (!m_running) return;
    if (const auto thread = m_threads.find(m_run); thread != m_threads.end()) thread->second.request_stop();
    ++m_run;
    m_running = false;
    Q_EMIT cancelled();
}

void BackgroundTask::start(const QString& where, Work work) {
    if (const auto thread = m_threads.find(m_run); thread != m_threads.end()) thread->second.request_stop();
    m_running = true;
    const quint64 run = ++m_run;
    m_threads[run] = std::jthread([this, where, run, work = std::move(work)](const std::stop_token& stop) {
        JobControl job;
        job.stop = stop;
        job.progress = [this, run](double fraction) {
            QMetaObject::invokeMethod(this, [this, run, fraction] {
                if (run == m_run) Q_EMIT progress(fraction);
            });
        };
        // Every way out ends with this, which also lets go of the thread.
        const auto answer = [this, run](const std::function<void()>& signal) {
            QMetaObject::invokeMethod(this, [this, run, signal] {
                m_threads.erase(run);
                if (run != m_run) return;
                m_running = false;
                signal();
            });
        };
        const auto fail = [&](const QString& what, const QString& place, const QString& whatToDo) {
            answer([=, this] { Q_EMIT failed(what, place, whatToDo); });
        };
        try {
            const Delivery deliver = work(job);
            answer([this, deliver] {
                deliver();
                Q_EMIT finished();
            });
        } catch (const Cancelled&) {
            answer([this] { Q_EMIT cancelled(); });
        } catch (const Error& error) {
            fail(QString::fromStdString(error.problem()), QString::fromStdString(error.where()),
                 QString::fromStdString(error.whatToDo()));
        } catch (const std::bad_alloc&) {
            fail(tr("not enough memory"), where, tr("close other programs, or choose something smaller"));
        }
    });
}

} // namespace pellucid::gui
