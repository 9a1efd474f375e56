// What is done later: in the next turn of the event loop, or when nothing has happened for a while.
#pragma once

#include <functional>

#include <QTimer>

namespace pellucid::gui {

/// Calls `then` once, this many milliseconds after the latest start().
class RestTimer : public QTimer {
public:
    RestTimer(int milliseconds, const std::function<void()>& then) {
        setSingleShot(true);
        setInterval(milliseconds);
        callOnTimeout(then);
    }
};

/// Calls `what` from the event loop, unless `context` has gone by then.
inline void later(QObject* context, const std::function<void()>& what) {
    QMetaObject::invokeMethod(context, what, Qt::QueuedConnection);
}

} // namespace pellucid::gui
