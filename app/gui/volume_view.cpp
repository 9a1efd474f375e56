#include "volume_view.h"

#include <cmath>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QVBoxLayout>
#include <QWheelEvent>

#include "render/camera_motion.h"
#include "cpu_surface.h"
#include "gl_surface.h"

namespace pellucid::gui {
namespace {

constexpr double kDegreesPerView = 220; // of a drag across the height of the view
constexpr double kZoomPerView = 12;     // factor of a right-drag across the height of the view
constexpr double kZoomPerNotch = 1.15;  // factor of one notch of the wheel
constexpr double kDegreesPerKey = 5;

} // namespace

VolumeView::VolumeView(Document& document, ViewRenderer renderer, QWidget* parent)
    : QWidget(parent), m_document(document) {
    setObjectName("volumeView");
    setAccessibleName(tr("Volume"));
    setFocusPolicy(Qt::StrongFocus);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    const bool gl = renderer != ViewRenderer::Cpu && GlSurface::isAvailable();
    if (renderer == ViewRenderer::Gl && !gl) {
        throw Error("no OpenGL 4.3 or later", "this display", "leave out --renderer gl: the CPU draws as well");
    }
    if (gl) {
        setSurface(std::make_unique<GlSurface>());
    } else {
        setSurface(std::make_unique<CpuSurface>());
    }
    connect(&document, &Document::volumeChanged, this, &VolumeView::updateScene);
    connect(&document, &Document::tfChanged, this, &VolumeView::updateScene);
    connect(&document, &Document::cameraChanged, this, &VolumeView::updateScene);
}

VolumeView::~VolumeView() {
    m_surface->onFrame = nullptr;
    m_surface->onFailure = nullptr;
}

void VolumeView::setSurface(std::unique_ptr<ViewSurface> surface) {
    m_surface = std::move(surface);
    m_surface->widget()->setFocusPolicy(Qt::NoFocus);
    layout()->addWidget(m_surface->widget());
    m_surface->onFrame = [this] { Q_EMIT frameShown(); };
    m_surface->onFailure = [this](const Error& error) { surfaceFailed(error); };
    updateScene();
}

void VolumeView::surfaceFailed(const Error& error) {
    const bool gl = dynamic_cast<GlSurface*>(m_surface.get()) != nullptr;
    Q_EMIT rendererFailed(QString::fromStdString(error.problem()), QString::fromStdString(error.where()),
                          gl ? tr("the CPU draws the picture from now on") : QString::fromStdString(error.whatToDo()));
    // In a later turn: the one that failed is still on the stack.
    if (gl)
        QMetaObject::invokeMethod(
            this, [this] { setSurface(std::make_unique<CpuSurface>()); }, Qt::QueuedConnection);
}

void VolumeView::updateScene() {
    if (!m_document.hasVolume()) return;
    m_surface->setScene({m_document.volume(), m_document.tf(), m_document.camera()});
}

void VolumeView::fit() {
    if (m_document.hasVolume()) m_document.setCamera(fitted(m_document.camera(), m_document.volume()->geometry()));
}

void VolumeView::resetView() {
    if (m_document.hasVolume())
        m_document.setCamera(homeCamera(m_document.volume()->geometry(), m_document.camera().projection));
}

void VolumeView::setStandardView(StandardView view) {
    if (!m_document.hasVolume()) return;
    double azimuth = 0, elevation = 0;
    switch (view) {
    case StandardView::Front:
        break;
    case StandardView::Back:
        azimuth = 180;
        break;
    case StandardView::Left:
        azimuth = -90;
        break;
    case StandardView::Right:
        azimuth = 90;
        break;
    case StandardView::Top:
        elevation = 90;
        break;
    case StandardView::Bottom:
        elevation = -90;
        break;
    }
    m_document.setCamera(
        standardCamera(m_document.volume()->geometry(), azimuth, elevation, m_document.camera().projection));
}

void VolumeView::setProjection(Projection projection) {
    if (!m_document.hasVolume()) return;
    m_document.setCamera(withProjection(m_document.camera(), m_document.volume()->geometry(), projection));
}

void VolumeView::zoomBy(double factor) {
    if (m_document.hasVolume())
        m_document.setCamera(zoomed(m_document.camera(), m_document.volume()->geometry(), factor));
}

void VolumeView::mousePressEvent(QMouseEvent* event) {
    if (m_motion != Motion::None) return; // the first button decides until it is released
    const bool shift = event->modifiers().testFlag(Qt::ShiftModifier);
    switch (event->button()) {
    case Qt::LeftButton:
        m_motion = shift ? Motion::Pan : Motion::Rotate;
        break;
    case Qt::MiddleButton:
        m_motion = Motion::Pan;
        break;
    case Qt::RightButton:
        m_motion = Motion::Zoom;
        break;
    default:
        return event->ignore();
    }
    m_button = event->button();
    m_last = event->position();
}

void VolumeView::mouseMoveEvent(QMouseEvent* event) {
    if (m_motion == Motion::None || !m_document.hasVolume()) return;
    const QPointF way = event->position() - m_last;
    m_last = event->position();
    const Geometry& geometry = m_document.volume()->geometry();
    const Camera& camera = m_document.camera();
    const double perPixel = 1.0 / std::max(1, height());
    switch (m_motion) {
    case Motion::Rotate: // the volume follows the hand, so the eye goes the other way
        m_document.setCamera(
            rotated(camera, geometry, -way.x() * perPixel * kDegreesPerView, way.y() * perPixel * kDegreesPerView));
        break;
    case Motion::Pan:
        m_document.setCamera(panned(camera, geometry, way.x(), way.y(), height()));
        break;
    case Motion::Zoom:
        zoomBy(std::pow(kZoomPerView, -way.y() * perPixel));
        break;
    case Motion::None:
        break;
    }
}

void VolumeView::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() == m_button) m_motion = Motion::None;
}

void VolumeView::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) fit();
}

void VolumeView::wheelEvent(QWheelEvent* event) {
    if (event->angleDelta().y() == 0) return event->ignore();
    zoomBy(std::pow(kZoomPerNotch, event->angleDelta().y() / 120.0));
    event->accept();
}

void VolumeView::keyPressEvent(QKeyEvent* event) {
    double yaw = 0, pitch = 0;
    switch (event->key()) {
    case Qt::Key_Left:
        yaw = -kDegreesPerKey;
        break;
    case Qt::Key_Right:
        yaw = kDegreesPerKey;
        break;
    case Qt::Key_Up:
        pitch = kDegreesPerKey;
        break;
    case Qt::Key_Down:
        pitch = -kDegreesPerKey;
        break;
    case Qt::Key_Plus:
    case Qt::Key_Equal:
        return zoomBy(kZoomPerNotch);
    case Qt::Key_Minus:
        return zoomBy(1.0 / kZoomPerNotch);
    default:
        return QWidget::keyPressEvent(event);
    }
    if (m_document.hasVolume())
        m_document.setCamera(rotated(m_document.camera(), m_document.volume()->geometry(), yaw, pitch));
}

} // namespace pellucid::gui
