#include "view/gl_surface.h"

#include <algorithm>
#include <cmath>

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QOpenGLFunctions>

#include "render/gl/gl_engines.h"
#include "render/gl/vision_filter.h"
#include "render/gl/volume_raycaster.h"
#include "widgets/shown_vision.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kQuickBudget = 35e6;      // nanoseconds of a picture while the mouse moves
constexpr double kRefineBudget = 25e6;     // nanoseconds between two looks at the window's events
constexpr double kSoftwareSamples = 150e6; // what a software rasterizer is given at most for one picture
constexpr double kSoftwareStrip = 0.4e6, kHardwareStrip = 40e6; // samples of one strip
constexpr double kHalvedSamples = 8; // of a ray whose steps are halved where that matters, about, for one of another
constexpr qint64 kShowEvery = 250;   // milliseconds between two looks at a picture being refined

QSurfaceFormat wantedFormat() {
    QSurfaceFormat format;
    format.setRenderableType(QSurfaceFormat::OpenGL);
    format.setProfile(QSurfaceFormat::CoreProfile);
    format.setVersion(4, 3);
    return format;
}

QString glText(QOpenGLFunctions* gl, GLenum name) {
    const GLubyte* text = gl->glGetString(name);
    return text == nullptr ? QString() : QString::fromLatin1(reinterpret_cast<const char*>(text));
}

} // namespace

GlSurface::Available GlSurface::available(QString* renderer) {
    QOpenGLContext context;
    context.setFormat(wantedFormat());
    if (!context.create()) return Available::No;
    const auto version = context.format().version();
    if (version < qMakePair(4, 3)) return Available::No;
    QOffscreenSurface surface;
    surface.setFormat(context.format());
    surface.create();
    if (!context.makeCurrent(&surface)) return Available::No;
    const QString name = glText(context.functions(), GL_RENDERER);
    const bool software = isSoftwareRenderer(name.toStdString());
    if (renderer != nullptr) *renderer = name;
    context.doneCurrent();
    return software ? Available::InSoftware : Available::OnGpu;
}

GlSurface::GlSurface(QWidget* parent) : QOpenGLWidget(parent) {
    setObjectName("glSurface");
    setFormat(wantedFormat());
    m_sinceShown.start();
    connect(&shownVision(), &ShownVision::changed, this, qOverload<>(&QWidget::update));
}

GlSurface::~GlSurface() { releaseGl(); }

void GlSurface::releaseGl() {
    if (context() == nullptr) return;
    makeCurrent(); // freeing needs the context
    m_raycaster.reset();
    m_filter.reset();
    m_picture.reset();
    m_uploaded.reset();
    doneCurrent();
}

void GlSurface::setScene(const PictureInput& scene) {
    if (scene == m_scene) return;
    m_scene = scene;
    beginAnew();
    update();
}

void GlSurface::beginAnew() {
    m_dirty = true;
    m_info.complete = false;
    m_idle.stop();
    m_next.stop();
}

void GlSurface::initializeGL() {
    connect(context(), &QOpenGLContext::aboutToBeDestroyed, this, &GlSurface::releaseGl);
    QOpenGLFunctions* gl = context()->functions();
    const QString renderer = glText(gl, GL_RENDERER);
    m_software = isSoftwareRenderer(renderer.toStdString());
    m_nanosecondsPerSample = m_software ? 40.0 : 0.5;
    const auto version = context()->format().version();
    m_rendererName = tr("OpenGL %1.%2, %3")
                         .arg(version.first)
                         .arg(version.second)
                         .arg(m_software ? tr("software") : renderer.section('/', 0, 0));
    try {
        m_raycaster = std::make_unique<gl::VolumeRaycaster>();
    } catch (const Error& error) {
        fail(error);
    }
    m_dirty = true;
}

void GlSurface::resizeGL(int, int) {
    m_picture.reset();
    beginAnew();
}

double GlSurface::samples(const PicturePlan& plan) const {
    const QSize size = devicePixels(*this);
    const BoxInImage box = boxInImage(m_scene.camera, m_scene.volume->geometry(), size.width(), size.height());
    // A box fills about half of the prism that its outline and its depth span.
    return 0.5 * box.width * box.height * plan.resolutionScale * plan.resolutionScale * box.depthInD0 / plan.stepInD0 *
           (plan.finestInD0 ? kHalvedSamples : 1);
}

PicturePlan GlSurface::fullPlan() const {
    PicturePlan plan{1.0, 0.5, {}};
    if (!m_software) return plan;
    // By the number of samples, not by a clock, so that the same scene always ends in the same picture.
    while (plan.stepInD0 < 4.0 && samples(plan) > kSoftwareSamples) plan.stepInD0 *= 2;
    return plan;
}

PicturePlan GlSurface::finishedPlan() const {
    const RenderSettings& s = m_scene.settings;
    return {1.0, s.stepInD0, s.halvings() > 0 ? s.finestInD0 : std::nullopt};
}

PicturePlan GlSurface::quickPlan() const {
    const PicturePlan full = fullPlan();
    if (samples(full) * m_nanosecondsPerSample <= kQuickBudget) return full;
    PicturePlan plan{1.0, std::max(1.5, full.stepInD0), {}};
    const auto scaleFor = [&](double step) {
        return std::sqrt(kQuickBudget / std::max(1.0, samples({1.0, step, {}}) * m_nanosecondsPerSample));
    };
    if (scaleFor(plan.stepInD0) < 0.25) plan.stepInD0 = 3.0;
    plan.resolutionScale = std::clamp(scaleFor(plan.stepInD0), 0.1, 1.0);
    return plan;
}

void GlSurface::prepareScene() {
    if (m_uploaded != m_scene.volume) {
        m_raycaster->setVolume(m_scene.volume);
        m_uploaded = m_scene.volume;
    }
    m_raycaster->setTransferFunction(m_scene.tf);
}

void GlSurface::paintGL() {
    if (!m_picture) {
        m_picture = std::make_unique<QOpenGLFramebufferObject>(devicePixels(*this));
        m_dirty = true;
    }
    if (m_dirty) drawQuick();
    showPicture();
}

void GlSurface::showPicture() {
    const QRect all(QPoint(0, 0), devicePixels(*this));
    if (!shownVision().isNormal()) {
        try {
            if (!m_filter) m_filter = std::make_unique<gl::VisionFilter>();
            return m_filter->draw(m_picture->texture(), all.width(), all.height(), shownVision().matrix(),
                                  defaultFramebufferObject());
        } catch (const Error& error) {
            fail(error);
        }
    }
    context()->functions()->glBindFramebuffer(GL_FRAMEBUFFER, defaultFramebufferObject());
    QOpenGLFramebufferObject::blitFramebuffer(nullptr, all, m_picture.get(), all);
}

void GlSurface::drawQuick() {
    m_dirty = false;
    m_idle.stop();
    m_next.stop();
    m_nextRow = 0;
    QOpenGLFunctions* gl = context()->functions();
    m_picture->bind();
    gl->glViewport(0, 0, m_picture->width(), m_picture->height());
    const Rgb background = m_scene.settings.background.value_or(Rgb{});
    gl->glClearColor(static_cast<float>(background.r), static_cast<float>(background.g),
                     static_cast<float>(background.b), 1);
    gl->glClear(GL_COLOR_BUFFER_BIT);
    if (!m_scene.volume || !m_raycaster || m_failed) return;
    try {
        prepareScene();
        const PicturePlan plan = quickPlan();
        m_finishing = plan == fullPlan();
        gl->glFinish();
        QElapsedTimer timer;
        timer.start();
        if (m_finishing) {
            while (!drawStrip(plan)) {
            }
        } else {
            gl::DrawTarget target;
            target.framebuffer = m_picture->handle();
            target.resolutionScale = plan.resolutionScale;
            m_raycaster->draw(m_scene.camera, plan.applied(m_scene.settings, devicePixels(*this)), target);
        }
        gl->glFinish(); // the time of the work, not of its submission
        const double perSample = static_cast<double>(timer.nsecsElapsed()) / std::max(1e4, samples(plan));
        m_nanosecondsPerSample = std::clamp(0.6 * m_nanosecondsPerSample + 0.4 * perSample, 0.01, 2000.0);
        finishPicture(plan);
        if (!m_info.complete) m_idle.start();
    } catch (const Error& error) {
        fail(error);
    }
}

bool GlSurface::drawStrip(const PicturePlan& plan) {
    const RenderSettings s = plan.applied(m_scene.settings, devicePixels(*this));
    const BoxInImage box = boxInImage(m_scene.camera, m_scene.volume->geometry(), s.width, s.height);
    // Above and below the box there is nothing but what a coarse picture has smeared: one strip each. Inside, strips of
    // a number of samples, not of a time, since the last bits of a pixel depend on the strip that it lies in.
    int end = m_nextRow < box.y ? box.y : s.height;
    if (m_nextRow >= box.y && m_nextRow < box.y + box.height) {
        const double perRow = samples(plan) / box.height;
        const double rows = (m_software ? kSoftwareStrip : kHardwareStrip) / std::max(1.0, perRow);
        end = std::min(box.y + box.height, m_nextRow + std::clamp(static_cast<int>(rows), 1, s.height));
    }
    gl::DrawTarget target;
    target.framebuffer = m_picture->handle();
    target.y = s.height - end; // where the strip's lower left corner lies, from below
    target.tileY = m_nextRow;
    target.tileWidth = s.width;
    target.tileHeight = end - m_nextRow;
    m_raycaster->draw(m_scene.camera, s, target);
    m_nextRow = end;
    return m_nextRow >= s.height;
}

void GlSurface::refine() {
    if (m_dirty || m_failed || !m_picture || !m_raycaster || !m_scene.volume) return;
    const PicturePlan plan = m_finishing ? finishedPlan() : fullPlan();
    makeCurrent();
    try {
        prepareScene();
        QElapsedTimer timer;
        timer.start();
        bool complete = false;
        while (!complete && timer.nsecsElapsed() < kRefineBudget) {
            complete = drawStrip(plan);
            context()->functions()->glFinish();
        }
        doneCurrent();
        if (complete) {
            finishPicture(plan);
            update();
            m_finishing = true;
            m_nextRow = 0;
        } else if (m_sinceShown.elapsed() > kShowEvery) {
            m_sinceShown.restart();
            update();
        }
        if (!m_info.complete) m_next.start();
    } catch (const Error& error) {
        doneCurrent();
        fail(error);
    }
}

void GlSurface::finishPicture(const PicturePlan& plan) {
    m_info = {devicePixels(*this).width(), devicePixels(*this).height(),
              plan.resolutionScale,        plan.applied(m_scene.settings, devicePixels(*this)).smallestStep(),
              plan == finishedPlan(),      m_scene.volume.get()};
    later(this, [this] { // not from inside paintGL: whoever listens may ask for the picture
        if (onPicture) onPicture();
    });
}

void GlSurface::fail(const Error& error) {
    m_failed = true;
    later(this, [this, error] {
        if (onFailure) onFailure(error);
    });
}

} // namespace pellucid::gui
