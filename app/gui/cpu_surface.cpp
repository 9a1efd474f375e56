#include "cpu_surface.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

#include <QPainter>

#include "image_convert.h"
#include "render/image_renderer.h"
#include "theme.h"

namespace pellucid::gui {
namespace {

constexpr double kQuickSeconds = 0.06; // of a picture while the mouse moves

}

struct CpuSurface::Renderer {
    std::mutex mutex;
    std::shared_ptr<const Volume> volume;
    std::unique_ptr<ImageRenderer> renderer;
};

CpuSurface::CpuSurface(QWidget* parent)
    : QWidget(parent), m_renderer(std::make_shared<Renderer>()),
      m_job(
          [shared = m_renderer](const Task& task, const JobControl& job) {
              const std::lock_guard lock(shared->mutex);
              job.throwIfStopped();
              if (shared->volume != task.input.volume) {
                  shared->renderer = makeCpuRenderer(task.input.volume);
                  shared->volume = task.input.volume;
              }
              const auto begin = std::chrono::steady_clock::now();
              const Image image = shared->renderer->render(task.input.camera, task.input.tf, task.input.settings, job);
              return Picture{qImageFromImage(image),
                             std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
          },
          [this](const Task& task, Picture& picture) { show(task, picture); }) {
    setObjectName("cpuSurface");
    m_idle.setSingleShot(true);
    m_idle.setInterval(kIdleBeforeRefining);
    connect(&m_idle, &QTimer::timeout, this, [this] { draw(true); });
    connect(&m_job, &JobBase::failed, this, [this](const Error& error) {
        if (onFailure) onFailure(error);
    });
}

CpuSurface::~CpuSurface() = default;

void CpuSurface::setScene(const PictureInput& scene) {
    if (scene == m_scene) return;
    const bool otherVolume = scene.volume != m_scene.volume;
    m_scene = scene;
    if (otherVolume) { // nothing of the old one may be seen any more
        m_job.cancel();
        m_picture = {};
        update();
    }
    restart();
}

void CpuSurface::resizeEvent(QResizeEvent*) { restart(); }

void CpuSurface::restart() {
    m_frame.complete = false;
    m_idle.stop();
    // A coarse picture under way is let finish, else a steady drag would never show any.
    if (m_job.isRunning() && m_drawingQuick) {
        m_again = true;
        return;
    }
    draw(false);
}

void CpuSurface::draw(bool full) {
    m_again = false;
    m_drawingQuick = !full;
    if (!m_scene.volume || width() <= 0 || height() <= 0) {
        m_job.cancel();
        m_picture = {};
        update();
        return;
    }
    const qreal ratio = devicePixelRatioF();
    const QSize pixels(static_cast<int>(std::lround(width() * ratio)), static_cast<int>(std::lround(height() * ratio)));
    const double scale = full ? 1.0 : m_quickScale;
    Task task{m_scene, pixels, scale, full};
    RenderSettings& settings = task.input.settings;
    settings.width = std::max(1, static_cast<int>(std::lround(pixels.width() * scale)));
    settings.height = std::max(1, static_cast<int>(std::lround(pixels.height() * scale)));
    settings.stepInD0 = full ? 0.5 : 1.5;
    m_job.start(std::move(task), tr("the picture"));
}

void CpuSurface::show(const Task& task, const Picture& picture) {
    m_picture = picture.image;
    m_frame = {task.pixels.width(), task.pixels.height(), task.scale, task.input.settings.stepInD0,
               task.full && !m_again};
    if (!task.full) {
        m_quickScale = std::clamp(task.scale * std::sqrt(kQuickSeconds / std::max(1e-4, picture.seconds)), 0.08, 1.0);
        if (m_again) {
            draw(false);
        } else {
            m_idle.start();
        }
    }
    update();
    if (onFrame) onFrame();
}

void CpuSurface::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), colorFromRgb(m_scene.settings.background.value_or(Rgb{})));
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    if (!m_picture.isNull()) painter.drawImage(rect(), m_picture);
}

} // namespace pellucid::gui
