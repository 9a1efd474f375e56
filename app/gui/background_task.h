// One piece of work off the window's thread: opening a volume, writing a picture.
#pragma once

#include <functional>
#include <map>
#include <thread>

#include <QObject>
#include <QString>

#include "base/job.h"

namespace pellucid::gui {

/// Runs one piece of work at a time; a new one takes the place of the one under way. Signals arrive in the thread of
/// this object.
class BackgroundTask : public QObject {
    Q_OBJECT
public:
    /// Runs in the thread of the BackgroundTask, after the work succeeded.
    using Delivery = std::function<void()>;
    /// Runs on a thread of its own. May throw Error, Cancelled, std::bad_alloc.
    using Work = std::function<Delivery(const JobControl&)>;

    explicit BackgroundTask(QObject* parent = nullptr);
    ~BackgroundTask() override; ///< stops and waits

    /// `where` names the object of the work in the message when memory runs out.
    void start(const QString& where, Work work);
    bool isRunning() const { return m_running; }
    /// `cancelled` follows at once; the thread ends when the work notices.
    void cancel();

Q_SIGNALS:
    void progress(double fraction);
    void finished();
    void cancelled();
    void failed(const QString& what, const QString& where, const QString& whatToDo);

private:
    std::map<quint64, std::jthread> m_threads; // the present one, and cancelled ones that have not noticed yet
    quint64 m_run = 0;
    bool m_running = false;
};

} // namespace pellucid::gui
