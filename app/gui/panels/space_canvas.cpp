#include "panels/space_canvas.h"

#include <cmath>

#include <QApplication>
#include <QMouseEvent>
#include <QPainter>

#include "widgets/image_convert.h"
#include "widgets/mark_painter.h"
#include "widgets/number_text.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kDegreesPerPixel = 0.5;
constexpr double kReach = 7; // logical pixels from a state of a path

} // namespace

SpaceCanvas::SpaceCanvas(QWidget* parent)
    : QWidget(parent), Spoken(*this, QAccessible::Chart), m_renderer(std::make_shared<KeptRenderer>()),
      m_job(
          [renderer = m_renderer](const Task& task, const JobControl& job) {
              if (task.volume == nullptr) return qImageFromImage(heatMap(*task.space, task.view));
              PictureInput input;
              input.volume = task.volume;
              input.tf = spaceTf(*task.space, task.view);
              input.camera = task.view.camera;
              input.settings = spaceRenderSettings(*task.space, task.view);
              return qImageFromImage(renderer->render(input, {job.stop, {}}));
          },
          [this](const Task& task, QImage& picture) {
              m_picture = std::move(picture);
              m_drawnSpace = task.space;
              m_drawn = task.view;
              update();
          },
          WhenBusy::FinishOld) {
    setObjectName("spaceCanvas");
    setAccessibleName(tr("Parameter space"));
    setMouseTracking(true);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
    setToolTip(tr("Opacities of the features, 0 to 1, along the axes.\n"
                  "Three features: drag to turn, wheel to zoom; the mouse reads the place of the least F (the largest "
                  "W)\nalong its ray. A click on a state of a path sets its opacities.\n"
                  "Two features: a click anywhere sets the opacities there"));
}

void SpaceCanvas::setSpace(std::shared_ptr<const ParameterSpace> space, SpaceView view) {
    view.camera = m_view.camera; // those are the canvas's own
    view.width = m_view.width;
    view.height = m_view.height;
    view.density = m_view.density;
    if (space == m_space && view == m_view) return;
    const bool otherField = space != m_space || view.shown != m_view.shown;
    m_space = std::move(space);
    m_view = std::move(view);
    if (m_space == nullptr || m_space->isFlat()) {
        m_volume.reset();
        m_renderer->release();
    } else if (otherField) {
        m_volume = spaceVolume(*m_space, m_view.shown);
    }
    if (m_space == nullptr) {
        m_job.cancel();
        m_drawnSpace.reset();
        update();
    }
    draw();
}

void SpaceCanvas::setOutdated(const QString& remark) {
    if (m_outdated == remark) return;
    m_outdated = remark;
    if (!remark.isEmpty()) Q_EMIT read({});
    update();
}

SpaceView SpaceCanvas::shownView() const {
    SpaceView view = m_drawn;
    view.width = width();
    view.height = height();
    view.density = 1;
    return view;
}

void SpaceCanvas::draw() {
    if (m_space == nullptr || width() < 16 || height() < 16) return;
    const double density = devicePixelRatioF();
    m_view.width = static_cast<int>(std::lround(width() * density));
    m_view.height = static_cast<int>(std::lround(height() * density));
    m_view.density = density;
    const double narrow = std::min(1.0, static_cast<double>(width()) / height()); // the zoom is of the height
    if (!m_space->isFlat()) m_view.camera = spaceCamera(*m_space, m_azimuth, m_elevation, m_zoom * narrow);
    m_job.start({m_space, m_view, m_volume}, tr("the parameter space"));
}

void SpaceCanvas::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), colorFromRgb(m_view.background));
    if (m_drawnSpace != nullptr) {
        painter.save();
        painter.setOpacity(m_outdated.isEmpty() ? 1 : 0.3);
        painter.setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
        painter.scale(width() * 1.0 / m_drawn.width, height() * 1.0 / m_drawn.height);
        painter.drawImage(0, 0, m_picture);
        for (const Mark& mark : spaceMarks(*m_drawnSpace, m_drawn)) drawMark(painter, mark);
        painter.restore();
    }
    if (m_outdated.isEmpty()) return;
    const QRect box = rect().adjusted(12, 12, -12, -12);
    const QRect text = painter.fontMetrics().boundingRect(box, Qt::AlignCenter | Qt::TextWordWrap, m_outdated);
    painter.fillRect(text.adjusted(-8, -6, 8, 6), translucent(Qt::black, 0.7));
    painter.setPen(theme::kMark);
    painter.drawText(box, Qt::AlignCenter | Qt::TextWordWrap, m_outdated);
}

QString SpaceCanvas::spokenValue() const {
    if (!m_outdated.isEmpty()) return m_outdated;
    if (m_space == nullptr) return tr("Nothing has been computed yet");
    QStringList names;
    for (const std::size_t f : m_space->axes.features) names << QString::fromStdString(m_view.names[f]);
    const QString along = tr("along the axes the opacities of %1").arg(names.join(", "));
    return m_view.shown == kObjective
               ? tr("%1, %2").arg(terms().distance(), along)
               : tr("%1 on %2, %3")
                     .arg(terms().attention(),
                          QString::fromStdString(m_view.names[static_cast<std::size_t>(m_view.shown)]), along);
}

void SpaceCanvas::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    draw();
}

void SpaceCanvas::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return QWidget::mousePressEvent(event);
    m_pressedAt = m_lastAt = event->position();
    m_turning = false;
}

void SpaceCanvas::mouseMoveEvent(QMouseEvent* event) {
    const QPointF way = event->position() - m_lastAt;
    if ((event->buttons() & Qt::LeftButton) != 0 && m_space != nullptr && !m_space->isFlat()) {
        if ((event->position() - m_pressedAt).manhattanLength() >= QApplication::startDragDistance()) m_turning = true;
        if (!m_turning) return;
        m_azimuth = std::remainder(m_azimuth - way.x() * kDegreesPerPixel, 360.0);
        m_elevation = std::clamp(m_elevation + way.y() * kDegreesPerPixel, -90.0, 90.0);
        m_lastAt = event->position();
        draw();
        return;
    }
    readAt(event->position());
}

void SpaceCanvas::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || m_turning || !m_pickable || !canRead()) return;
    const SpaceView view = shownView();
    const Vec2 at{event->position().x(), event->position().y()};
    if (const auto state = pathStateAt(*m_space, view, at, kReach))
        Q_EMIT picked(view.paths[state->path].states[state->state].opacity);
    else if (const auto position = m_space->isFlat() ? positionAt(*m_space, view, at) : std::nullopt)
        Q_EMIT picked(m_space->opacitiesAt(*position));
}

void SpaceCanvas::wheelEvent(QWheelEvent* event) {
    if (m_space == nullptr || m_space->isFlat()) return event->ignore();
    m_zoom = std::clamp(m_zoom * std::pow(1.2, event->angleDelta().y() / 120.0), 0.5, 8.0);
    draw();
    event->accept();
}

void SpaceCanvas::leaveEvent(QEvent* event) {
    QWidget::leaveEvent(event);
    Q_EMIT read({});
}

void SpaceCanvas::readAt(const QPointF& at) {
    if (!canRead()) return;
    const SpaceView view = shownView();
    const Vec2 pixel{at.x(), at.y()};
    const auto textOf = [&](const std::vector<double>& x, const std::vector<double>& w, double objective) {
        QStringList parts;
        for (const std::size_t f : m_space->axes.features)
            parts << tr("%1: opacity %2, attention %3")
                         .arg(QString::fromStdString(view.names[f]), QString::number(x[f], 'g', 3),
                              QString::number(w[f], 'f', 3));
        return parts.join("; ") + "; " + terms().offTarget(objective);
    };
    if (const auto found = pathStateAt(*m_space, view, pixel, kReach)) {
        const SpacePath& path = view.paths[found->path];
        const OptimizeState& state = path.states[found->state];
        Q_EMIT read(tr("%1, state %2 — ").arg(QString::fromStdString(path.name)).arg(found->state) +
                    textOf(state.opacity, state.vws, state.objective));
        return;
    }
    const auto position = positionAt(*m_space, view, pixel);
    if (!position) return Q_EMIT read({});
    std::vector<double> w;
    for (std::size_t f = 0; f < m_space->vws.size(); ++f) w.push_back(m_space->valueAt(static_cast<int>(f), *position));
    Q_EMIT read(textOf(m_space->opacitiesAt(*position), w, m_space->valueAt(kObjective, *position)));
}

} // namespace pellucid::gui
