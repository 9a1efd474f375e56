// The one thread that measures and optimizes, with the engine and the saliency fields that both need.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include "render/visibility.h"
#include "saliency/saliency_field.h"

namespace pellucid::gui {

/// What the thread keeps between tasks. Used on that thread only.
class ComputeCache {
public:
    VisibilityEngine& engine(const std::shared_ptr<const Volume>& volume);
    /// The fields depend on colours and features alone, so that they outlive changes of opacity.
    const WeightFields& weights(const std::shared_ptr<const Volume>& volume, const TransferFunction& tf,
                                const JobControl& job);

private:
    std::shared_ptr<const Volume> m_engineVolume, m_weightsVolume;
    std::unique_ptr<VisibilityEngine> m_engine;
    TransferFunction m_weightsTf; // its colorsOf()
    WeightFields m_weights;
};

/// Runs tasks one after the other. A task must not throw; its results go home through queued signals.
class ComputeThread {
public:
    using Task = std::function<void(ComputeCache&)>;

    ComputeThread();
    /// Forgets waiting tasks and waits for the running one, whose own stop token should have been used before.
    ~ComputeThread();
    ComputeThread(const ComputeThread&) = delete;
    ComputeThread& operator=(const ComputeThread&) = delete;

    void submit(Task task);

private:
    void run(const std::stop_token& stop);

    std::mutex m_mutex;
    std::condition_variable_any m_wake;
    std::deque<Task> m_tasks;
    std::jthread m_thread; // last: joined before the rest goes
};

} // namespace pellucid::gui
