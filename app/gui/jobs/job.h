// Work off the window's thread: the one way to start, watch, stop and hear of it.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include <QObject>
#include <QString>

#include "base/job.h"

namespace pellucid::gui {

/// The ladder of errors: whatever work may throw, in the three parts that users see. `where` names the object of the
/// work where memory ran out.
Error errorOf(const std::exception_ptr& thrown, const QString& where);

/// A thread for work that must not overlap: runs tasks one after the other. A task must not throw.
class Lane {
public:
    Lane();
    /// Forgets waiting tasks and waits for the running one, whose own stop token should have been used before.
    ~Lane();
    Lane(const Lane&) = delete;
    Lane& operator=(const Lane&) = delete;

    void submit(std::function<void()> task);

private:
    void run(const std::stop_token& stop);

    std::mutex m_mutex;
    std::condition_variable_any m_wake;
    std::deque<std::function<void()>> m_tasks;
    std::jthread m_thread; // last: joined before the rest goes
};

/// What a new start means for work that is under way.
enum class WhenBusy {
    StopOld,   ///< nobody wants its answer any more
    FinishOld, ///< its answer still comes, then the latest start's: for what follows the hand
    Queue      ///< every start is done, one after the other
};

/// What jobs have in common, whatever they make. Signals arrive in the thread of this object.
class JobBase : public QObject {
    Q_OBJECT
public:
    ~JobBase() override; ///< stops and waits

    bool isRunning() const { return m_running; }
    /// Nothing that was started answers any more; `cancelled` follows at once. The work itself ends when it notices.
    void cancel();
    /// For the work while it goes on, in its thread: has `call` called in the thread of this object, after what was
    /// posted earlier and before the answer; never when this object has gone.
    void post(std::function<void()> call);

Q_SIGNALS:
    void busyChanged(); ///< isRunning() may have changed; after the answer has been delivered
    void progress(double fraction);
    void cancelled();
    void failed(const pellucid::Error& error);

protected:
    using Delivery = std::function<void()>;
    using Work = std::function<Delivery(const JobControl&)>;

    /// `lane`: the thread that it shares with others, which outlives this; null: threads of its own, so that work that
    /// does not notice that it should stop holds up nobody.
    JobBase(WhenBusy whenBusy, Lane* lane, QObject* parent);
    void run(const QString& where, Work work);
    /// Stops what runs and waits; for destructors, before what the work uses goes.
    void finish();
    bool event(QEvent* event) override;

private:
    struct Pending {
        QString where;
        Work work;
    };
    void begin(Pending next);
    void ended(quint64 number, const std::function<void()>& answer);

    const WhenBusy m_whenBusy;
    Lane* const m_lane;
    std::shared_ptr<struct RunningWork> m_shared; // with tasks in lanes, which may outlive this
    std::map<quint64, std::jthread> m_threads;    // the present one, and stopped ones that have not noticed yet
    std::stop_source m_stop;
    std::deque<Pending> m_waiting;
    quint64 m_run = 0; // numbers the runs, so that a late answer of a stopped one is dropped
    bool m_running = false;
    std::mutex m_postMutex;
    std::deque<std::function<void()>> m_posted; // an event of ours is on its way for each
};

/// Work from In to Out. `work` runs elsewhere and may throw Error, Cancelled, std::bad_alloc; `done` gets what it made,
/// in this object's thread.
template <class In, class Out>
class Job : public JobBase {
public:
    using Function = std::function<Out(const In&, const JobControl&)>;
    using Done = std::function<void(const In&, Out&)>;

    Job(Function work, Done done, WhenBusy whenBusy = WhenBusy::StopOld, Lane* lane = nullptr,
        QObject* parent = nullptr)
        : JobBase(whenBusy, lane, parent), m_work(std::move(work)), m_done(std::move(done)) {}
    ~Job() override { finish(); }

    void start(In in, const QString& where = {}) {
        run(where,
            [this, work = m_work, in = std::make_shared<const In>(std::move(in))](const JobControl& job) -> Delivery {
                auto out = std::make_shared<Out>(work(*in, job));
                return [this, in, out] { m_done(*in, *out); };
            });
    }

private:
    Function m_work;
    Done m_done;
};

} // namespace pellucid::gui
