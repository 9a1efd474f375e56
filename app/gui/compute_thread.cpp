#include "compute_thread.h"

#include "engines/engines.h"
#include "render/memory_needs.h"
#include "volume/memory_use.h"

namespace pellucid::gui {

VisibilityEngine& ComputeCache::engine(const std::shared_ptr<const Volume>& volume) {
    if (m_engineVolume != volume || !m_engine) {
        m_engine.reset();
        m_engineVolume.reset();
        m_weightsVolume.reset(); // what was measured before needs no room any more
        m_weights = {};
        requireMemory({"measuring", kMeasureBytesPerVoxel}, volume->title, volume->dims());
        m_engine = makeEngine(EngineChoice::Auto, volume);
        m_engineVolume = volume;
    }
    return *m_engine;
}

const WeightFields& ComputeCache::weights(const std::shared_ptr<const Volume>& volume, const TransferFunction& tf,
                                          const JobControl& job) {
    TransferFunction key = colorsOf(tf);
    if (m_weightsVolume != volume || !(m_weightsTf == key)) {
        m_weightsVolume.reset();
        updateSaliencyFields(m_weights, *volume, tf, {}, job);
        m_weightsTf = std::move(key);
        m_weightsVolume = volume;
    }
    return m_weights;
}

ComputeThread::ComputeThread() : m_thread([this](const std::stop_token& stop) { run(stop); }) {}

ComputeThread::~ComputeThread() {
    {
        const std::lock_guard lock(m_mutex);
        m_tasks.clear();
    }
    m_thread.request_stop();
    m_thread.join();
}

void ComputeThread::submit(Task task) {
    {
        const std::lock_guard lock(m_mutex);
        m_tasks.push_back(std::move(task));
    }
    m_wake.notify_one();
}

void ComputeThread::run(const std::stop_token& stop) {
    ComputeCache cache;
    while (true) {
        Task task;
        {
            std::unique_lock lock(m_mutex);
            if (!m_wake.wait(lock, stop, [this] { return !m_tasks.empty(); })) return;
            if (stop.stop_requested()) return;
            task = std::move(m_tasks.front());
            m_tasks.pop_front();
        }
        task(cache);
    }
}

} // namespace pellucid::gui
