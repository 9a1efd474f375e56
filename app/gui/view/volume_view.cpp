#include "view/volume_view.h"

#include <map>

#include <QCoreApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QSettings>
#include <QVBoxLayout>
#include <QWheelEvent>

#include "base/parallel.h"
#include "controllers/field_controller.h"
#include "jobs/rest_timer.h"
#include "view/annotation_layer.h"
#include "view/cpu_surface.h"
#include "view/gl_surface.h"

namespace pellucid::gui {
namespace {

// Times are kept for the process, and for later ones.
std::map<QString, RendererTimes>& timesOfProcess() {
    static std::map<QString, RendererTimes> s_times;
    return s_times;
}

// A slash would make a group of settings.
QString keyOf(QString machine) { return "renderers/" + machine.replace('/', '_').replace('\\', '_'); }

std::optional<RendererTimes> keptTimes(const QString& machine) {
    const auto known = timesOfProcess().find(machine);
    if (known != timesOfProcess().end()) return known->second;
    const QVariantList kept = QSettings().value(keyOf(machine)).toList();
    if (kept.size() != 2 || !(kept[0].toDouble() > 0)) return {};
    RendererTimes times{kept[0].toDouble(), {}};
    if (kept[1].toDouble() > 0) times.gl = kept[1].toDouble();
    return times;
}

void keepTimes(const QString& machine, const RendererTimes& times) {
    timesOfProcess()[machine] = times;
    QSettings().setValue(keyOf(machine), QVariantList{times.cpu, times.gl.value_or(0)});
}

QString reasonOf(const RendererTimes& times, bool gl) {
    if (!times.gl) return QObject::tr("OpenGL cannot draw here.");
    const auto ms = [](double seconds) { return QString::number(1000 * seconds, 'g', 3); };
    return (gl ? QObject::tr("OpenGL draws a small picture in %1 ms, the CPU in %2 ms.")
               : QObject::tr("The CPU draws a small picture in %2 ms, OpenGL in %1 ms."))
        .arg(ms(*times.gl), ms(times.cpu));
}

} // namespace

VolumeView::VolumeView(SessionStore& store, ViewRenderer renderer, QWidget* parent, FieldController* fields)
    : QWidget(parent), Spoken(*this, QAccessible::Graphic), m_store(store), m_fields(fields),
      m_overlay(new ViewOverlay(store, this)),
      m_hand(
          *this, [&store] { return store.hasVolume() ? &store.scene() : nullptr; },
          [&store](const Camera& camera, int gesture) { store.setCamera(camera, gesture); }),
      m_probe([](const int&, const JobControl& job) { return timeRenderers(job); },
              [this](const int&, RendererTimes& times) {
                  keepTimes(m_machine, times);
                  showTimes(times);
              }) {
    setObjectName("volumeView");
    setAccessibleName(tr("Volume"));
    setWhatsThis(
        tr("The picture of the volume. A drag or the arrow keys turn it, + and − zoom; a click asks what is seen "
           "there. F1 lists all keys."));
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    m_overlay->add(std::make_unique<AnnotationLayer>(fields));
    chooseRenderer(renderer);
    connect(&store, &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume) lookFrom({});
        updateScene();
        // What turns with the volume is painted when the next picture comes: twice for each would be half in vain.
        if (drawsByGl() || before.camera == after.camera) m_overlay->update();
        speakLater();
    });
    if (fields != nullptr)
        connect(fields, &FieldController::changed, this, [this] {
            updateScene();
            m_overlay->update();
        });
}

void VolumeView::chooseRenderer(ViewRenderer wanted) {
    QString renderer;
    const auto available = wanted == ViewRenderer::Cpu ? GlSurface::Available::No : GlSurface::available(&renderer);
    if (wanted == ViewRenderer::Gl && available == GlSurface::Available::No)
        throw Error("no OpenGL 4.3 or later", "this display", "draw on the CPU");
    bool gl = available == GlSurface::Available::OnGpu;
    if (wanted != ViewRenderer::Auto) {
        gl = wanted == ViewRenderer::Gl;
        m_reason = tr("Because it was asked for.");
    } else if (available == GlSurface::Available::No) {
        m_reason = tr("There is no OpenGL 4.3 here.");
    } else {
        m_expectGl = gl;
        m_machine =
            QStringLiteral("%1, %2, %3").arg(renderer).arg(threadCount()).arg(QCoreApplication::applicationVersion());
        if (const auto times = keptTimes(m_machine)) {
            gl = times->preferGl(m_expectGl);
            m_reason = reasonOf(*times, gl);
        } else {
            m_reason = gl ? tr("There is a GPU.") : tr("OpenGL is drawn by the CPU here.");
            m_probeWaits = true;
        }
    }
    if (gl) return setSurface(std::make_unique<GlSurface>());
    setSurface(std::make_unique<CpuSurface>());
}

QString VolumeView::rendererReason() const { return m_glSetAside ? tr("OpenGL draws no overlay.") : m_reason; }

bool VolumeView::drawsByGl() const { return dynamic_cast<GlSurface*>(m_surface.get()) != nullptr; }

/// Once the first picture is complete: opening comes before.
void VolumeView::startProbe() {
    m_probeWaits = false;
    if (const auto times = keptTimes(m_machine)) return showTimes(*times); // another window was first
    m_probe.start(0, tr("the renderers"));
}

void VolumeView::showTimes(const RendererTimes& times) {
    m_reason = reasonOf(times, drawsByGl());
    if (!times.preferGl(m_expectGl)) m_glSetAside = false;
    // The other way, a view that has never shown OpenGL would have to make its window anew: it waits for the next one.
    if (drawsByGl() && !times.preferGl(m_expectGl)) {
        m_reason = reasonOf(times, false);
        setSurface(std::make_unique<CpuSurface>());
    }
    Q_EMIT pictureShown();
}

VolumeView::~VolumeView() {
    m_surface->onPicture = nullptr;
    m_surface->onFailure = nullptr;
}

void VolumeView::setSurface(std::unique_ptr<ViewSurface> surface) {
    m_surface = std::move(surface);
    m_surface->widget()->setFocusPolicy(Qt::NoFocus);
    m_surface->widget()->setMouseTracking(true);
    layout()->addWidget(m_surface->widget());
    m_overlay->raise();
    m_surface->onPicture = [this] {
        if (!drawsByGl()) m_overlay->update();
        Q_EMIT pictureShown();
        if (m_probeWaits && isComplete()) startProbe();
    };
    m_surface->onFailure = [this](const Error& error) { surfaceFailed(error); };
    updateScene();
}

void VolumeView::surfaceFailed(const Error& error) {
    m_overlay->update(); // no picture will do it
    if (!drawsByGl()) return Q_EMIT rendererFailed(error);
    Q_EMIT rendererFailed({error.problem(), error.where(), tr("the CPU draws the picture from now on").toStdString()});
    later(this, [this] { // the one that failed is still on the stack
        m_reason = tr("OpenGL could not draw this.");
        setSurface(std::make_unique<CpuSurface>());
    });
}

void VolumeView::updateScene() {
    if (!m_store.hasVolume()) return;
    PictureInput picture = m_fields ? m_fields->picture(1, 1) : pictureInput(m_store.scene(), 1, 1);
    if (m_glimpse) picture.camera = *m_glimpse;
    const bool overlaid = picture.settings.overlay != nullptr;
    if (overlaid ? drawsByGl() : m_glSetAside) {
        m_glSetAside = overlaid;
        if (overlaid) return setSurface(std::make_unique<CpuSurface>());
        return setSurface(std::make_unique<GlSurface>());
    }
    m_surface->setScene(picture);
}

QString VolumeView::spokenValue() const {
    if (!m_store.hasVolume()) return tr("No volume is open");
    const Volume& volume = *m_store.scene().volume;
    return tr("%1, %2").arg(QString::fromStdString(volume.title),
                            viewText(m_glimpse.value_or(m_store.scene().camera), volume.geometry()));
}

void VolumeView::lookFrom(const std::optional<Camera>& camera) {
    if (camera == m_glimpse) return;
    m_glimpse = camera;
    m_overlay->lookFrom(camera);
    updateScene();
}

void VolumeView::mousePressEvent(QMouseEvent* event) {
    if (m_hand.isHolding() || m_overlay->isDragging()) return; // the first button decides until it is released
    if (event->button() == Qt::LeftButton && m_overlay->press(event->position(), event->modifiers())) return;
    if (!m_hand.press(*event)) event->ignore();
}

void VolumeView::mouseMoveEvent(QMouseEvent* event) {
    if (m_overlay->isDragging()) return m_overlay->drag(event->position(), event->modifiers());
    if (!m_hand.isHolding()) setCursor(m_overlay->cursorAt(event->position()));
    m_hand.move(*event);
}

void VolumeView::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) m_overlay->release();
    if (!m_hand.release(*event)) return;
    if (m_overlay->wantsClicks()) return m_overlay->click(event->position());
    Q_EMIT clicked(event->position());
}

void VolumeView::mouseDoubleClickEvent(QMouseEvent* event) {
    if (m_overlay->wantsClicks()) return mousePressEvent(event); // two quick clicks are two
    if (event->button() == Qt::LeftButton) m_hand.fit();
}

void VolumeView::wheelEvent(QWheelEvent* event) { m_hand.wheel(*event); }

void VolumeView::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    m_overlay->setGeometry(rect());
}

void VolumeView::keyPressEvent(QKeyEvent* event) {
    if (m_overlay->key(event->key())) return;
    if (m_hand.key(event->key())) return;
    if (event->key() == Qt::Key_Escape && m_overlay->isDragging()) return m_overlay->cancel();
    QWidget::keyPressEvent(event);
}

} // namespace pellucid::gui
