#include "jobs/job.h"

#include <new>

#include <QCoreApplication>
#include <QEvent>

namespace pellucid::gui {

Error errorOf(const std::exception_ptr& thrown, const QString& where) {
    const auto error = [&](const QString& what, const QString& whatToDo) {
        return Error(what.toStdString(), where.toStdString(), whatToDo.toStdString());
    };
    try {
        std::rethrow_exception(thrown);
    } catch (const Error& known) {
        return known;
    } catch (const std::bad_alloc&) {
        return error(QObject::tr("not enough memory"),
                     QObject::tr("close other programs, or choose something smaller"));
    } catch (const std::exception& other) { // of a library; it must not end the program
        return error(QObject::tr("unexpected failure (%1)").arg(other.what()), QObject::tr("please report it"));
    } catch (...) {
        return error(QObject::tr("unexpected failure"), QObject::tr("please report it"));
    }
}

Lane::Lane() : m_thread([this](const std::stop_token& stop) { run(stop); }) {}

Lane::~Lane() {
    {
        const std::lock_guard lock(m_mutex);
        m_tasks.clear();
    }
    m_thread.request_stop();
    m_thread.join();
}

void Lane::submit(std::function<void()> task) {
    {
        const std::lock_guard lock(m_mutex);
        m_tasks.push_back(std::move(task));
    }
    m_wake.notify_one();
}

void Lane::run(const std::stop_token& stop) {
    while (true) {
        std::function<void()> task;
        {
            std::unique_lock lock(m_mutex);
            if (!m_wake.wait(lock, stop, [this] { return !m_tasks.empty(); })) return;
            if (stop.stop_requested()) return;
            task = std::move(m_tasks.front());
            m_tasks.pop_front();
        }
        task();
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

void JobBase::post(std::function<void()> call) {
    const std::lock_guard lock(m_postMutex);
    m_posted.push_back(std::move(call));
    QCoreApplication::postEvent(this, new QEvent(QEvent::User));
}

bool JobBase::event(QEvent* event) {
    std::function<void()> call;
    {
        // Before the event is looked at. Qt orders it after post(), too, but where no thread sanitizer sees it.
        const std::lock_guard lock(m_postMutex);
        if (event->type() == QEvent::User && !m_posted.empty()) {
            call = std::move(m_posted.front());
            m_posted.pop_front();
        }
    }
    if (!call) return QObject::event(event);
    call(); // this object may have gone afterwards
    return true;
}

void JobBase::run(const QString& where, Work work) {
    Pending next{where, std::move(work)};
    if (!m_running) return begin(std::move(next));
    if (m_whenBusy == WhenBusy::StopOld) {
        m_stop.request_stop();
        return begin(std::move(next));
    }
    if (m_whenBusy == WhenBusy::FinishOld) m_waiting.clear();
    m_waiting.push_back(std::move(next));
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
        const JobControl job{stop, [this, number](double fraction) {
                                 post([this, number, fraction] {
                                     if (number == m_run) Q_EMIT progress(fraction);
                                 });
                             }};
        const auto answer = [this, number](std::function<void()> what) {
            post([this, number, what = std::move(what)] { ended(number, what); });
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
    if (m_lane != nullptr)
        m_lane->submit(task);
    else
        m_threads[number] = std::jthread(task);
    if (!wasRunning) Q_EMIT busyChanged();
}

} // namespace pellucid::gui
