// parallelFor without TBB, for programs that must not need its library (docs/gpu-check.md). Helpers wait in a pool; a
// loop is worked off by its caller, and by whichever helpers are free.
#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pellucid {

namespace {

/// Waking a thread takes as long as a short loop, and a sweep has hundreds of them: before it sleeps, whoever waits
/// looks for this long whether there is news.
constexpr std::chrono::microseconds kAwake{100};

template <class Condition>
bool soon(const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + kAwake;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::yield();
    }
    return true;
}

struct Loop {
    std::size_t count;
    const std::function<void(std::size_t)>& body;
    int room;                         ///< helpers that may still come; guarded by the pool's mutex
    std::exception_ptr error;         ///< the first; guarded by the pool's mutex
    std::atomic<std::size_t> next{0}; ///< what has not begun
    std::atomic<int> helping{0};      ///< changes under the pool's mutex

    bool open() const { return room > 0 && next < count; }
};

class Pool {
public:
    Pool() = default;
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;
    ~Pool() {
        {
            const std::lock_guard lock(m_mutex);
            m_quit = true;
        }
        m_changed.notify_all();
        for (std::thread& helper : m_helpers) helper.join();
    }

    void run(std::size_t count, const std::function<void(std::size_t)>& body, int helpers) {
        Loop loop{count, body, helpers, {}};
        {
            const std::lock_guard lock(m_mutex);
            while (m_helpers.size() < static_cast<std::size_t>(helpers)) m_helpers.emplace_back([this] { help(); });
            m_loops.push_back(&loop);
            ++m_begun;
        }
        m_changed.notify_all();
        work(loop);
        std::unique_lock lock(m_mutex);
        m_loops.erase(std::find(m_loops.begin(), m_loops.end(), &loop)); // nobody joins any more
        if (loop.helping > 0) {
            lock.unlock();
            const bool done = soon([&] { return loop.helping == 0; });
            lock.lock();
            if (!done) m_changed.wait(lock, [&] { return loop.helping == 0; });
        }
        if (loop.error) std::rethrow_exception(loop.error);
    }

private:
    void work(Loop& loop) {
        try {
            for (std::size_t i = loop.next++; i < loop.count; i = loop.next++) loop.body(i);
        } catch (...) {
            loop.next = loop.count; // the others need not go on
            const std::lock_guard lock(m_mutex);
            if (!loop.error) loop.error = std::current_exception();
        }
    }

    Loop* openLoop() const {
        const auto found = std::find_if(m_loops.begin(), m_loops.end(), [](const Loop* l) { return l->open(); });
        return found == m_loops.end() ? nullptr : *found;
    }

    void help() {
        std::unique_lock lock(m_mutex);
        while (!m_quit) {
            if (Loop* const loop = openLoop()) {
                --loop->room;
                ++loop->helping;
                lock.unlock();
                work(*loop);
                lock.lock();
                --loop->helping; // from here on the loop may be gone
                m_changed.notify_all();
                continue;
            }
            const unsigned begun = m_begun;
            lock.unlock();
            const bool news = soon([&] { return m_begun != begun; });
            lock.lock();
            if (!news) m_changed.wait(lock, [&] { return m_quit || openLoop() != nullptr; });
        }
    }

    std::mutex m_mutex; ///< guards what follows, but m_begun may be read without
    std::condition_variable m_changed;
    std::vector<Loop*> m_loops; ///< under way, the oldest first
    std::atomic<unsigned> m_begun{0};
    std::vector<std::thread> m_helpers;
    bool m_quit = false;
};

std::atomic<int> g_threads{0}; ///< 0: one per core

} // namespace

void setThreadCount(int threads) { g_threads = std::max(threads, 0); }

int threadCount() {
    const int threads = g_threads;
    return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body) {
    const auto workers = static_cast<int>(std::min(count, static_cast<std::size_t>(threadCount())));
    if (workers <= 1) {
        for (std::size_t i = 0; i < count; ++i) body(i);
        return;
    }
    static Pool pool;
    pool.run(count, body, workers - 1);
}

} // namespace pellucid
