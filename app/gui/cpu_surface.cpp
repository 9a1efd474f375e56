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

CpuSurface::CpuSurface(QWidget* parent) : QWidget(parent), m_renderer(std::make_shared<Renderer>()) {
    setObjectName("cpuSurface");
    m_idle.setSingleShot(true);
    m_idle.setInterval(kIdleBeforeRefining);
    connect(&m_idle, &QTimer::timeout, this, [this] { draw(true); });
    connect(&m_task, &BackgroundTask::failed, this,
            [this](const QString& what, const QString& where, const QString& whatToDo) {
                if (onFailure) onFailure(Error(what.toStdString(), where.toStdString(), whatToDo.toStdString()));
            });
}

CpuSurface::~CpuSurface() = default;

void CpuSurface::setScene(const ViewScene& scene) {
    if (scene == m_scene) return;
    m_scene = scene;
    restart();
}

void CpuSurface::resizeEvent(QResizeEvent*) { restart(); }

void CpuSurface::restart() {
    m_frame.complete = false;
    m_idle.stop();
    // A coarse picture under way is let finish, else a steady drag would never show any.
    if (m_task.isRunning() && m_drawingQuick) {
        m_again = true;
        return;
    }
    draw(false);
}

void CpuSurface::draw(bool full) {
    m_again = false;
    m_drawingQuick = !full;
    if (!m_scene.volume || width() <= 0 || height() <= 0) {
        m_task.cancel();
        m_picture = {};
        update();
        return;
    }
    const qreal ratio = devicePixelRatioF();
    const QSize pixels(static_cast<int>(std::lround(width() * ratio)), static_cast<int>(std::lround(height() * ratio)));
    const double scale = full ? 1.0 : m_quickScale;
    RenderSettings settings;
    settings.width = std::max(1, static_cast<int>(std::lround(pixels.width() * scale)));
    settings.height = std::max(1, static_cast<int>(std::lround(pixels.height() * scale)));
    settings.background = kViewBackground;
    settings.stepInD0 = full ? 0.5 : 1.5;
    m_task.start(
        tr("the picture"),
        [this, scene = m_scene, settings, full, scale, pixels,
         shared = m_renderer](const JobControl& job) -> BackgroundTask::Delivery {
            const std::lock_guard lock(shared->mutex);
            job.throwIfStopped();
            if (shared->volume != scene.volume) {
                shared->renderer = makeCpuRenderer(scene.volume);
                shared->volume = scene.volume;
            }
            const auto begin = std::chrono::steady_clock::now();
            const QImage picture = qImageFromImage(shared->renderer->render(scene.camera, scene.tf, settings, job));
            const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
            return [this, picture, full, scale, pixels, seconds, step = settings.stepInD0] {
                m_picture = picture;
                m_frame = {pixels.width(), pixels.height(), scale, step, full && !m_again};
                if (!full) {
                    m_quickScale = std::clamp(scale * std::sqrt(kQuickSeconds / std::max(1e-4, seconds)), 0.08, 1.0);
                    if (m_again) {
                        draw(false);
                    } else {
                        m_idle.start();
                    }
                }
                update();
                if (onFrame) onFrame();
            };
        });
}

void CpuSurface::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), colorFromRgb(kViewBackground));
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    if (!m_picture.isNull()) painter.drawImage(rect(), m_picture);
}

} // namespace pellucid::gui
