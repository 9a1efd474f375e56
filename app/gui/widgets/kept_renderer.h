// A CPU renderer for jobs that draw one picture after the other of the same volume.
#pragma once

#include <memory>
#include <mutex>

#include "render/image_renderer.h"
#include "session/scene.h"

namespace pellucid::gui {

/// Shared with the threads of a job, which may outlive who has started it. Does not keep the volume alive once
/// somebody has released it.
class KeptRenderer {
public:
    /// What `draw` makes with the renderer of the volume.
    template <class Draw>
    auto use(const std::shared_ptr<const Volume>& volume, const JobControl& job, const Draw& draw) {
        const std::lock_guard lock(m_mutex);
        job.throwIfStopped();
        if (m_volume != volume) {
            m_renderer = makeCpuRenderer(volume);
            m_volume = volume;
        }
        return draw(*m_renderer);
    }
    Image render(const PictureInput& input, const JobControl& job) {
        return use(input.volume, job, [&](ImageRenderer& renderer) {
            return renderer.render(input.camera, input.tf, input.settings, job);
        });
    }
    /// Unless it is drawing at this moment.
    void release() {
        if (const std::unique_lock lock(m_mutex, std::try_to_lock); lock.owns_lock()) {
            m_renderer.reset();
            m_volume.reset();
        }
    }

private:
    std::mutex m_mutex;
    std::shared_ptr<const Volume> m_volume;
    std::unique_ptr<ImageRenderer> m_renderer;
};

} // namespace pellucid::gui
