#include "jobs/lane.h"

namespace pellucid::gui {

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

} // namespace pellucid::gui
