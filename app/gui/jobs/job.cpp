#include "jobs/job.h"

#include <condition_variable>
#include <mutex>
#include <new>

namespace pellucid::gui {

Error errorOf(const std::exception_ptr& thrown, const QString& where) {
    try {
        std::rethrow_exception(thrown);
    } catch (const Error& error) {
        return error;
    } catch (const std::bad_alloc&) {
        return {QObject::tr("not enough memory").toStdString(), where.toStdString(),
                QObject::tr("close other programs, or choose something smaller").toStdString()};
    } catch (const std::exception& error) { // of a library; it must not end the program
        return {QObject::tr("unexpected failure (%1)").arg(QString::fromUtf8(error.what())).toStdString(),
                where.toStdString(), QObject::tr("please report it").toStdString()};
    } catch (...) {
        return {QObject::tr("unexpected failure").toStdString(), where.toStdString(),
                QObject::tr("please report it").toStdString()};
    }
}

/// Tells the threads whether the job is still there, and the job when none of its work is going on any more.
struct RunningWork {
    std::mutex mutex;
    std::condition_variable idle;
    int active = 0;
    bool gone = false;

    bool enter() {
        const std::lock_guard lock(mutex);
        if (gone) return false;
        ++active;
        return true;
    }
    void leave() {
        const std::lock_guard lock(mutex);
        --active;
        idle.notify_all();
    }
};

JobBase::JobBase(WhenBusy whenBusy, Lane* lane, QObject* parent)
    : QObject(parent), m_whenBusy(whenBusy), m_lane(lane), m_shared(std::make_shared<RunningWork>()) {}

JobBase::~JobBase() { finish(); }

void JobBase::finish() {
    m_stop.request_stop();
    m_waiting.clear();
    for (auto& [number, thread] : m_threads) thread.request_stop();
    {
        std::unique_lock lock(m_shared->mutex);
        m_shared->gone = true;
        m_shared->idle.wait(lock, [this] { return m_shared->active == 0; });
    }
    m_threads.clear(); // joins
    ++m_run;           // answers that have been posted already are nobody's
}

void JobBase::cancel() {
    m_waiting.clear();
    if (!m_running) return;
    m_stop.request_stop();
    ++m_run;
    m_running = false;
    Q_EMIT cancelled();
    Q_EMIT busyChanged();
}

void JobBase::run(const QString& where, Work work) {
    Pending next{where, std::move(work)};
    if (!m_running) return begin(std::move(next));
    switch (m_whenBusy) {
    case WhenBusy::StopOld:
        m_stop.request_stop();
        return begin(std::move(next));
    case WhenBusy::FinishOld:
        m_waiting.clear();
        break;
    case WhenBusy::Queue:
        break;
    }
    m_waiting.push_back(std::move(next));
}

void JobBase::post(quint64 number, std::function<void()> deliver) {
    QMetaObject::invokeMethod(this, [this, number, deliver = std::move(deliver)] {
        if (number == m_run) deliver();
    });
}

void JobBase::ended(quint64 number, const std::function<void()>& answer) {
    m_threads.erase(number);
    if (number != m_run) return;
    const bool goesOn = !m_waiting.empty();
    m_running = false;
    answer();
    // The answer may have started something itself, or ended everything.
    if (goesOn && !m_running && !m_waiting.empty()) {
        Pending next = std::move(m_waiting.front());
        m_waiting.pop_front();
        begin(std::move(next));
    } else if (!m_running) {
        Q_EMIT busyChanged();
    }
}

void JobBase::begin(Pending next) {
    const bool wasRunning = std::exchange(m_running, true);
    m_stop = std::stop_source();
    const quint64 number = ++m_run;
    const auto task = [this, number, stop = m_stop.get_token(), shared = m_shared, next = std::move(next)] {
        if (!shared->enter()) return;
        JobControl job;
        job.stop = stop;
        job.progress = [this, number](double fraction) {
            post(number, [this, fraction] { Q_EMIT progress(fraction); });
        };
        const auto answer = [this, number](std::function<void()> what) {
            QMetaObject::invokeMethod(this, [this, number, what = std::move(what)] { ended(number, what); });
        };
        try {
            job.throwIfStopped();
            answer(next.work(job));
        } catch (const Cancelled&) {
            answer([this] { Q_EMIT cancelled(); });
        } catch (...) {
            answer([this, error = errorOf(std::current_exception(), next.where)] { Q_EMIT failed(error); });
        }
        shared->leave();
    };
    if (m_lane != nullptr) {
        m_lane->submit(task);
    } else {
        m_threads[number] = std::jthread(task);
    }
    if (!wasRunning) Q_EMIT busyChanged();
}

} // namespace pellucid::gui
