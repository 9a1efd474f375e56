#include "view/cpu_surface.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>
#include <vector>

#include <QCursor>
#include <QPainter>

#include "base/stopwatch.h"
#include "render/image_renderer.h"
#include "widgets/shown_vision.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kPictureSeconds = 0.045; ///< that a picture may take while the scene changes
constexpr int kGrowEvery = 40;            ///< milliseconds between looks at what has grown
/// Of the picture before the last. Rays one pixel apart, samples one voxel apart: what lies between two samples counts
/// in full, by running integrals.
constexpr double kFullStep = 1, kCoarsestStep = 3;
constexpr double kCoarsest = 0.5, kLastResort = 0.2; ///< rays per pixel along each axis

/// Of a Format_RGB32.
std::uint32_t* pixelsOf(QImage& image) { return reinterpret_cast<std::uint32_t*>(image.bits()); }

} // namespace

struct CpuSurface::Drawing {
    std::shared_ptr<const Volume> volume;
    std::unique_ptr<TileRenderer> renderer; ///< of it
};

/// A picture while it is drawn that grows: one thread adds parts, the window's takes them.
struct CpuSurface::Growing {
    std::mutex mutex;
    QImage pixels;
    std::vector<ImagePart> ready; ///< not yet taken
};

CpuSurface::CpuSurface(QWidget* parent)
    : QWidget(parent), m_drawing(std::make_unique<Drawing>()),
      m_job([drawing = m_drawing.get()](const Task& task, const JobControl& job) { return drawn(*drawing, task, job); },
            [this](const Task& task, Picture& picture) { show(task, picture); }, WhenBusy::StopOld, &m_lane) {
    setObjectName("cpuSurface");
    setAttribute(Qt::WA_OpaquePaintEvent);
    followShownVision(*this);
    m_grow.setInterval(kGrowEvery);
    connect(&m_grow, &QTimer::timeout, this, &CpuSurface::takeGrown);
    connect(&m_job, &JobBase::failed, this, [this](const Error& error) {
        m_grow.stop();
        if (onFailure) onFailure(error);
        if (m_again) draw(Stage::Quick); // the scene has changed since
    });
}

CpuSurface::~CpuSurface() = default;

CpuSurface::Picture CpuSurface::drawn(Drawing& drawing, const Task& task, const JobControl& job) {
    if (drawing.volume != task.input.volume) {
        drawing.renderer = makeCpuRenderer(task.input.volume);
        drawing.volume = task.input.volume;
    }
    if (!task.growing) return quick(*drawing.renderer, task, job);
    const PictureInput& in = task.input;
    const RenderSettings settings = task.plan.applied(in.settings, task.pixels);
    Image image(settings.width, settings.height);
    drawing.renderer->refine(
        in.camera, in.tf, settings, image, task.focus.x(), task.focus.y(),
        [&](const ImagePart& part) {
            const std::lock_guard growing(task.growing->mutex);
            toScreen(image, part, pixelsOf(task.growing->pixels));
            task.growing->ready.push_back(part);
        },
        job);
    return {{}, task.plan};
}

CpuSurface::Picture CpuSurface::quick(TileRenderer& renderer, const Task& task, const JobControl& job) {
    const PictureInput& in = task.input;
    const Stopwatch watch;
    Picture picture;
    picture.inSlices = renderer.previewsInStorageOrder(in.camera, task.plan.applied(in.settings, task.pixels));
    picture.plan = planFor(task.affordable, picture.inSlices);
    const double scale = picture.plan.resolutionScale;
    const RenderSettings settings = picture.plan.applied(in.settings, task.pixels);
    const auto size = TileRenderer::previewSize(settings, scale);
    picture.image = QImage(size.width, size.height, QImage::Format_RGB32);
    if (picture.image.isNull()) throw std::bad_alloc();
    renderer.previewOnScreen(in.camera, in.tf, settings, scale, pixelsOf(picture.image), job);
    picture.seconds = watch.seconds();
    return picture;
}

/// Along rays half the resolution before longer steps, and less than that where nothing else helps; in storage order
/// there is one sample per slice, whatever the step.
PicturePlan CpuSurface::planFor(const Affordable& affordable, bool inSlices) {
    if (inSlices) return {std::clamp(std::sqrt(affordable.inSlices), kLastResort, 1.0), kFullStep};
    const double samples = affordable.alongRays;
    double scale = std::clamp(std::sqrt(samples), kCoarsest, 1.0);
    const double step = std::clamp(kFullStep * scale * scale / samples, kFullStep, kCoarsestStep);
    if (step == kCoarsestStep) scale = std::clamp(std::sqrt(samples * kCoarsestStep / kFullStep), kLastResort, scale);
    return {scale, step};
}

void CpuSurface::setScene(const PictureInput& scene) {
    if (scene == m_scene) return;
    // From one frame of a series to the next the old picture stays until the new one is there.
    const bool otherData = !scene.volume || !m_scene.volume || scene.volume->title != m_scene.volume->title ||
                           scene.volume->dims() != m_scene.volume->dims();
    const bool otherVolume = scene.volume != m_scene.volume;
    m_scene = scene;
    if (otherVolume && otherData) { // nothing of the old one may be seen any more
        m_job.cancel();
        m_growing.reset();
        m_picture = {};
        update();
    }
    restart();
}

void CpuSurface::resizeEvent(QResizeEvent*) { restart(); }

void CpuSurface::restart() {
    m_info.complete = false;
    m_idle.stop();
    m_grow.stop();
    // A quick picture under way is let finish, else a steady drag would never show any.
    if (m_job.isRunning() && !m_growing) {
        m_again = true;
        return;
    }
    draw(Stage::Quick);
}

void CpuSurface::draw(Stage stage) {
    m_again = false;
    m_growing.reset();
    if (!m_scene.volume || width() <= 0 || height() <= 0) {
        m_job.cancel();
        m_picture = {};
        update();
        return;
    }
    const QSize pixels = devicePixels(*this);
    const QPointF mouse = mapFromGlobal(QPointF(QCursor::pos()));
    const QPointF focus = QRectF(rect()).contains(mouse) ? mouse : QRectF(rect()).center();
    const RenderSettings& wanted = m_scene.settings;
    const PicturePlan plan =
        stage == Stage::Finished ? PicturePlan{1, wanted.stepInD0, wanted.finestInD0} : PicturePlan{1, kFullStep};
    Task task{m_scene, pixels, stage, plan, m_affordable, (focus * devicePixelRatioF()).toPoint(), {}};
    if (!wanted.background) task.input.settings.background = Rgb{};
    if (stage != Stage::Quick) {
        // It grows over the one before.
        QImage under(pixels, QImage::Format_RGB32);
        QPainter painter(&under);
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        painter.drawImage(QRectF(QPointF(), m_target), m_picture);
        painter.end();
        m_picture = std::move(under);
        m_target = QSizeF(pixels);
        m_growing = std::make_shared<Growing>();
        m_growing->pixels = QImage(pixels, QImage::Format_RGB32);
        task.growing = m_growing;
        m_grow.start();
    }
    m_job.start(std::move(task), tr("the picture"));
}

void CpuSurface::takeGrown() {
    if (!m_growing) return;
    const std::lock_guard lock(m_growing->mutex);
    if (m_growing->ready.empty()) return;
    const qreal ratio = devicePixelRatioF();
    for (const ImagePart& part : m_growing->ready) {
        for (int y = part.y0; y < part.y1; ++y) {
            const auto* from = reinterpret_cast<const QRgb*>(m_growing->pixels.constScanLine(y));
            std::copy(from + part.x0, from + part.x1, reinterpret_cast<QRgb*>(m_picture.scanLine(y)) + part.x0);
        }
        update(QRectF(part.x0 / ratio, part.y0 / ratio, (part.x1 - part.x0) / ratio, (part.y1 - part.y0) / ratio)
                   .toAlignedRect());
    }
    m_growing->ready.clear();
}

void CpuSurface::show(const Task& task, const Picture& picture) {
    const PicturePlan& plan = picture.plan;
    m_info = {task.pixels.width(),
              task.pixels.height(),
              plan.resolutionScale,
              plan.applied(task.input.settings, task.pixels).smallestStep(),
              task.stage == Stage::Finished && !m_again,
              task.input.volume.get()};
    const bool full = task.stage == Stage::Full || (plan.resolutionScale == 1 && plan.stepInD0 == kFullStep);
    m_next = full ? Stage::Finished : Stage::Full;
    if (task.growing) {
        takeGrown();
        m_grow.stop();
        m_growing.reset();
        if (task.stage == Stage::Full) draw(Stage::Finished);
    } else {
        m_picture = picture.image;
        m_target = QSizeF(picture.image.size()) / plan.resolutionScale;
        const double drawn = plan.resolutionScale * plan.resolutionScale * kFullStep / plan.stepInD0;
        (picture.inSlices ? m_affordable.inSlices : m_affordable.alongRays) =
            std::clamp(drawn * kPictureSeconds / std::max(1e-4, picture.seconds), 0.01, 1.0);
        if (m_again)
            draw(Stage::Quick);
        else
            m_idle.start();
    }
    update();
    if (onPicture) onPicture();
}

void CpuSurface::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const QRectF shown(QPointF(), m_target / devicePixelRatioF());
    if (m_picture.isNull() || shown.width() < width() || shown.height() < height())
        painter.fillRect(rect(), colorFromRgb(m_scene.settings.background.value_or(Rgb{})));
    if (m_picture.isNull()) return;
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    painter.drawImage(shown, m_picture);
}

} // namespace pellucid::gui
