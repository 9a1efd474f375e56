// A thread for work that must not overlap.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace pellucid::gui {

/// Runs tasks one after the other. A task must not throw.
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

} // namespace pellucid::gui
