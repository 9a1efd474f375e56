#include "view/slice_pane.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolButton>
#include <QWheelEvent>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "base/stopwatch.h"
#include "controllers/field_controller.h"
#include "controllers/ruler_controller.h"
#include "render/mark_maker.h"
#include "services/services.h"
#include "store/edits.h"
#include "store/view_edits.h"
#include "view/view_surface.h"
#include "volume/orientation.h"
#include "widgets/image_convert.h"
#include "widgets/mark_painter.h"
#include "widgets/number_text.h"
#include "widgets/shown_vision.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kFill = 0.94;         // of the view, by the whole plane
constexpr double kTitle = 24;          // height of the strip that a double-click makes the view large on, pixels
constexpr double kMargin = 7;          // of texts, pixels
constexpr double kZoomPerNotch = 1.15; // as in the volume
constexpr double kMostZoom = 64;
constexpr double kWidthPixels = 100; // of a drag to the right that doubles the window of grey
constexpr double kLevelPixels = 200; // of a drag upward that moves it by its width
constexpr double kSlowSeconds = 0.04;
constexpr float kDimmed = 0.35f; // of what is clipped away
constexpr int kFarSteps = 10;    // with Shift

void haloText(QPainter& painter, const QPointF& baseline, const QString& text, const QColor& color) {
    QPainterPath path;
    path.addText(baseline, painter.font(), text);
    painter.strokePath(path, QPen(QColor(0, 0, 0, 190), 3, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    painter.setPen(color);
    painter.drawText(baseline, text);
}

void haloLine(QPainter& painter, const QLineF& line, const QColor& color) {
    painter.setPen(QPen(QColor(0, 0, 0, 130), 2.6));
    painter.drawLine(line);
    painter.setPen(QPen(color, 1.2));
    painter.drawLine(line);
}

} // namespace

QColor slicePlaneColor(int worldAxis) {
    // Red, green and blue as on the cube, of Okabe and Ito's hues.
    static const std::array kColors{QColor(0xf0, 0x75, 0x3f), QColor(0x2f, 0xc0, 0x93), QColor(0x5f, 0xb8, 0xee)};
    return kColors.at(static_cast<std::size_t>(worldAxis));
}

SlicePane::SlicePane(Services& services, const FieldController& fields, RulerController& rulers, int worldAxis,
                     Lane& lane, QWidget* parent)
    : QWidget(parent), Spoken(*this, QAccessible::Graphic), m_services(services), m_fields(fields), m_rulers(rulers),
      m_rulerHand(rulers), m_worldAxis(worldAxis), m_maximize(new QToolButton(this)),
      m_job([](const Request& request, const JobControl&) { return drawn(request); },
            [this](const Request& request, Drawn& result) { show(request, result); }, WhenBusy::FinishOld, &lane) {
    const QLatin1Char axisLetter("XYZ"[worldAxis]);
    setObjectName(QStringLiteral("slice%1").arg(axisLetter));
    setAccessibleName(tr("Slice across %1").arg(axisLetter));
    setWhatsThis(
        tr("A slice of the data. A drag moves the crosshair, the arrow keys go from slice to slice; a right drag "
           "sets the grey levels."));
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setContextMenuPolicy(Qt::PreventContextMenu);
    setCursor(Qt::CrossCursor);
    m_maximize->setObjectName(objectName() + "Maximize");
    m_maximize->setAutoRaise(true);
    m_maximize->setFocusPolicy(Qt::TabFocus); // a click leaves the keys to the slice
    m_maximize->setCursor(Qt::ArrowCursor);
    m_maximize->setFixedSize(20, 20);
    setMaximized(false);
    followShownVision(*this);
    connect(m_maximize, &QToolButton::clicked, this, &SlicePane::maximizeWanted);
    connect(&services.store(), &SessionStore::changed, this, &SlicePane::follow);
    connect(&rulers, &RulerController::changed, this, qOverload<>(&QWidget::update));
    connect(&fields, &FieldController::changed, this, [this] {
        request();
        if (isHidden()) return;
        hover(m_mouse);
        update();
    });
}

void SlicePane::setMaximized(bool on) {
    QPixmap pixmap(32, 32);
    pixmap.setDevicePixelRatio(2);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    painter.setPen(QPen(theme::kMark, 1.3));
    painter.setBrush(QColor(0, 0, 0, 120));
    painter.drawRect(on ? QRectF(5, 5, 6, 6) : QRectF(2.5, 2.5, 11, 11));
    painter.end();
    m_maximize->setIcon(pixmap);
    m_maximize->setToolTip(on ? tr("All views again (double-click on the title)")
                              : tr("This view alone (double-click on the title)"));
}

int SlicePane::axis() const {
    const Geometry& geometry = m_services.scene().volume->geometry();
    for (int a = 0; a < 3; ++a)
        if (sliceWorldAxis(geometry, a) == m_worldAxis) return a;
    return m_worldAxis;
}

SlicePlane SlicePane::planeOfSize(int pixelsWide, int pixelsHigh) const {
    const Geometry& geometry = m_services.scene().volume->geometry();
    SlicePlane plane;
    plane.axis = axis();
    plane.position = crosshairOf(m_services.scene())[plane.axis];
    plane.width = std::max(1, pixelsWide);
    plane.height = std::max(1, pixelsHigh);
    const SliceRect whole = fittedSlice(geometry, plane.axis, plane.width, plane.height);
    const Vec2 center = m_center.value_or(0.5 * sliceSize(geometry, plane.axis));
    const double w = whole.width / (kFill * m_zoom), h = whole.height / (kFill * m_zoom);
    plane.shown = {center.x - w / 2, center.y - h / 2, w, h};
    return plane;
}

SlicePlane SlicePane::plane() const { return planeOfSize(width(), height()); }

void SlicePane::follow(const Scene& before, const Scene& after) {
    if (before.series != after.series) {
        if (std::exchange(m_motion, Motion::None) == Motion::Ruler) m_rulerHand.end(false, m_services.store());
        m_zoom = 1;
        m_center.reset();
        m_image = {}; // nothing of the old one may be seen any more
        m_hovered.reset();
    }
    // A change that this drag did not make (undo, another file) ends it.
    if (m_motion == Motion::Window && m_moved && !m_services.store().isPreviewing()) m_motion = Motion::None;
    request();
    if (isHidden()) return;
    if (before.volume != after.volume || before.session.slices != after.session.slices ||
        before.session.coordinates != after.session.coordinates || !(before.tf == after.tf)) {
        hover(m_mouse);
        update();
    }
}

void SlicePane::request() {
    if (isHidden() || !m_services.store().hasVolume() || width() <= 0 || height() <= 0) return;
    const Scene& scene = m_services.scene();
    const QSize pixels = devicePixels(*this);
    const Field* const field = m_fields.field();
    Request next{.input = field != nullptr ? fieldSliceInput(scene, *field) : sliceInput(scene),
                 .plane = planeOfSize(pixels.width(), pixels.height())};
    if (next == m_wanted) return;
    m_wanted = next;
    m_complete = false;
    next.coarse = m_slow;
    m_job.start(std::move(next), tr("the slice"));
    Q_EMIT pictureShown();
}

SlicePane::Drawn SlicePane::drawn(const Request& request) {
    const Stopwatch watch;
    SlicePlane plane = request.plane;
    if (request.coarse) {
        plane.width = (plane.width + 1) / 2;
        plane.height = (plane.height + 1) / 2;
    }
    const SliceInput& input = request.input;
    SliceSettings settings = input.settings;
    settings.clipping = {};
    Image image = renderSlice(*input.volume, input.tf, plane, settings);
    if (!input.settings.clipping.isNone()) {
        // What is clipped away stays, dimmed: one sees what the volume leaves out.
        const Image left = renderSlice(*input.volume, input.tf, plane, input.settings);
        for (std::size_t i = 0; i < image.rgba.size(); i += 4)
            if (left.rgba[i + 3] == 0)
                for (std::size_t c = 0; c < 3; ++c) image.rgba[i + c] *= kDimmed;
    }
    return {qImageFromImage(image), watch.seconds()};
}

void SlicePane::show(const Request& request, const Drawn& result) {
    if (request.input.volume != m_wanted.input.volume) return; // of what is no longer shown
    m_image = result.image;
    m_slow = result.seconds * (request.coarse ? 4 : 1) > kSlowSeconds;
    Request full = request;
    full.coarse = false;
    const bool latest = full == m_wanted;
    if (latest && request.coarse) m_job.start(std::move(full), tr("the slice"));
    m_complete = latest && !request.coarse;
    update();
    Q_EMIT pictureShown();
}

void SlicePane::fit() {
    m_zoom = 1;
    m_center.reset();
    request();
    update();
}

void SlicePane::zoomAbout(const QPointF& point, double factor) {
    if (!m_services.store().hasVolume()) return;
    const double zoom = std::clamp(m_zoom * factor, 1.0 / 4, kMostZoom);
    const SlicePlane before = plane();
    const double fx = point.x() / before.width, fy = point.y() / before.height;
    const Vec2 held{before.shown.left + fx * before.shown.width, before.shown.top + fy * before.shown.height};
    const double w = before.shown.width * m_zoom / zoom, h = before.shown.height * m_zoom / zoom;
    m_zoom = zoom;
    m_center = Vec2{held.x + (0.5 - fx) * w, held.y + (0.5 - fy) * h};
    request();
    hover(m_mouse);
    update();
}

void SlicePane::pan(const QPointF& way) {
    const SlicePlane now = plane();
    const double perPixel = now.shown.width / now.width;
    m_center = Vec2{now.shown.left + now.shown.width / 2 - way.x() * perPixel,
                    now.shown.top + now.shown.height / 2 - way.y() * perPixel};
    request();
    update();
}

/// Toward +x, +y, +z of the world: left, posterior, superior.
void SlicePane::step(int slices) {
    if (!m_services.store().hasVolume()) return;
    const int a = axis();
    const bool along = m_services.scene().volume->geometry().directions[a][m_worldAxis] > 0;
    Vec3 voxel = crosshairOf(m_services.scene());
    voxel[a] += along ? slices : -slices;
    moveCrosshair(m_services.store(), voxel);
}

Vec3 SlicePane::voxelAt(const QPointF& point) const {
    return voxelAtPixel(m_services.scene().volume->geometry(), plane(), {point.x(), point.y()});
}

Vec3 SlicePane::worldAt(const QPointF& point) const {
    return m_services.scene().volume->geometry().worldFromVoxel(voxelAt(point));
}

void SlicePane::moveCrosshairTo(const QPointF& point) { moveCrosshair(m_services.store(), voxelAt(point)); }

void SlicePane::dragWindow(const QPointF& way) {
    if (m_services.isReadOnly()) return;
    const ValueRange all = m_services.scene().data->range(), from = *m_windowBefore;
    const double whole = all.hi - all.lo;
    if (!(whole > 0)) return;
    const double start = std::max(from.hi - from.lo, whole * 1e-6);
    const double width = std::clamp(start * std::exp2(way.x() / kWidthPixels), whole * 1e-6, 4 * whole);
    const double level = std::clamp(from.lo + (from.hi - from.lo) / 2 - start * way.y() / kLevelPixels, all.lo, all.hi);
    m_services.store().preview(tr("Window of grey"), changing(&Session::slices, [&](SliceViews& s) {
                                   s.window = ValueRange{level - width / 2, level + width / 2};
                               }));
}

void SlicePane::hover(const std::optional<QPointF>& point) {
    m_mouse = point;
    m_hovered.reset();
    if (point && m_services.store().hasVolume() && !isHidden()) {
        const Volume& volume = *m_services.scene().volume;
        const Vec3 voxel = voxelAt(*point);
        const Vec3 lo = volume.geometry().voxelBoxMin(), hi = volume.geometry().voxelBoxMax();
        if (glm::all(glm::greaterThanEqual(voxel, lo)) && glm::all(glm::lessThanEqual(voxel, hi)))
            m_hovered = Hovered{voxel, volume.geometry().worldFromVoxel(voxel), valueAt(volume, voxel, false), {}};
        if (const Field* field = m_fields.field(); field != nullptr && m_hovered)
            m_hovered->field = valueAt(*field->volume, voxel, false);
        if (const auto& overlay = m_services.scene().overlay; overlay && m_hovered)
            m_hovered->overlay = overlay->valueAt(m_hovered->world);
    }
    std::optional<double> intensity;
    if (m_hovered && m_hovered->value) intensity = m_services.scene().volume->intensityOfValue(*m_hovered->value);
    m_services.selection().setHoveredIntensity(intensity);
    update();
}

QString SlicePane::hoverText() const {
    if (!m_hovered || !m_services.store().hasVolume()) return {};
    const Scene& scene = m_services.scene();
    const Geometry& geometry = scene.volume->geometry();
    QString text = tr("invalid");
    if (m_hovered->value) {
        const ValueRange all = scene.data->range();
        text = numberText(*m_hovered->value, all.hi - all.lo);
        const int feature = featureAt(scene.tf.features, scene.volume->intensityOfValue(*m_hovered->value));
        if (feature >= 0)
            text += "  " + QString::fromStdString(scene.tf.features[static_cast<std::size_t>(feature)].name);
    }
    if (m_hovered->overlay) {
        const ValueRange all = scene.overlay->volume->dataRange();
        text += "\n" + tr("overlay %1").arg(numberText(*m_hovered->overlay, all.hi - all.lo));
    }
    if (m_hovered->field) text = m_fields.valueText(*m_hovered->field) + "\n" + text;
    return text + "\n" + placeText(geometry, scene.session.coordinates->axes, m_hovered->world);
}

bool SlicePane::onTitle(const QPointF& point) const { return point.y() < kTitle; }

void SlicePane::mousePressEvent(QMouseEvent* event) {
    if (m_motion != Motion::None || !m_services.store().hasVolume()) return; // the first button decides
    switch (event->button()) {
    case Qt::LeftButton:
        pressLeft(*event);
        break;
    case Qt::MiddleButton:
        m_motion = Motion::Pan;
        break;
    case Qt::RightButton:
        if (m_services.isReadOnly() || m_fields.field() != nullptr) return; // a field has no grey
        m_services.store().commit();
        m_motion = Motion::Window;
        m_windowBefore = greyWindowOf(m_services.scene());
        break;
    default:
        return event->ignore();
    }
    m_button = event->button();
    m_pressed = m_last = event->position();
    m_moved = false;
}

void SlicePane::pressLeft(const QMouseEvent& event) {
    const QPointF point = event.position();
    if (event.modifiers().testFlag(Qt::ShiftModifier)) {
        m_motion = Motion::Pan;
    } else if (onTitle(point)) {
        return;
    } else if (m_rulers.placing()) {
        m_rulers.addPoint(worldAt(point));
    } else if (m_rulerHand.press(rulerHandles(), point)) {
        m_services.store().commit();
        m_motion = Motion::Ruler;
    } else {
        m_motion = Motion::Crosshair;
        m_crosshairBefore = crosshairOf(m_services.scene());
        moveCrosshairTo(point);
    }
}

std::vector<RulerHandle> SlicePane::rulerHandles() const {
    return pellucid::rulerHandles(m_rulers.draggable(), m_services.scene().volume->geometry(), plane());
}

void SlicePane::mouseMoveEvent(QMouseEvent* event) {
    const QPointF point = event->position();
    if (m_motion == Motion::None && m_services.store().hasVolume()) {
        if (m_rulerHand.hover(rulerHandles(), point)) update();
        setCursor(onTitle(point) ? Qt::ArrowCursor : m_rulerHand.isOver() ? Qt::OpenHandCursor : Qt::CrossCursor);
        m_rulers.pointAt(worldAt(point));
    }
    if (m_motion == Motion::None || !m_services.store().hasVolume()) return hover(point);
    if (!m_moved && (point - m_pressed).manhattanLength() < 3) return;
    m_moved = true;
    if (m_motion == Motion::Crosshair) moveCrosshairTo(point);
    if (m_motion == Motion::Pan) pan(point - m_last);
    if (m_motion == Motion::Window) dragWindow(point - m_pressed);
    if (m_motion == Motion::Ruler) m_rulerHand.drag(worldAt(point));
    m_last = point;
    hover(point);
}

void SlicePane::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != m_button) return;
    const Motion motion = std::exchange(m_motion, Motion::None);
    m_button = Qt::NoButton;
    if (motion == Motion::Window && m_moved) m_services.store().commit();
    if (motion == Motion::Ruler) m_rulerHand.end(true, m_services.store());
    update(); // the numbers of the drag go
}

void SlicePane::mouseDoubleClickEvent(QMouseEvent* event) {
    if (!m_services.store().hasVolume()) return;
    if (event->button() == Qt::LeftButton && m_rulers.placing()) return mousePressEvent(event); // two quick clicks
    if (event->button() == Qt::RightButton && !m_services.isReadOnly() && m_fields.field() == nullptr)
        return resetGreyWindow(m_services.store());
    if (event->button() != Qt::LeftButton) return;
    if (onTitle(event->position())) return Q_EMIT maximizeWanted();
    if (m_crosshairBefore) m_services.store().setCrosshair(*m_crosshairBefore); // the first click was half of this
    fit();
}

void SlicePane::wheelEvent(QWheelEvent* event) {
    const int delta = event->angleDelta().y() != 0 ? event->angleDelta().y() : event->angleDelta().x();
    if (delta == 0) return event->ignore();
    event->accept();
    if (event->modifiers().testFlag(Qt::ControlModifier))
        return zoomAbout(event->position(), std::pow(kZoomPerNotch, delta / 120.0));
    m_wheel += delta; // a touch pad sends many small ones
    const int notches = m_wheel / 120;
    m_wheel -= 120 * notches;
    if (notches != 0) step(event->modifiers().testFlag(Qt::ShiftModifier) ? kFarSteps * notches : notches);
}

void SlicePane::keyPressEvent(QKeyEvent* event) {
    const int far = event->modifiers().testFlag(Qt::ShiftModifier) ? kFarSteps : 1;
    switch (event->key()) {
    case Qt::Key_PageUp:
    case Qt::Key_Up:
    case Qt::Key_Right:
        return step(far);
    case Qt::Key_PageDown:
    case Qt::Key_Down:
    case Qt::Key_Left:
        return step(-far);
    case Qt::Key_Plus:
    case Qt::Key_Equal:
        return zoomAbout(QRectF(rect()).center(), kZoomPerNotch);
    case Qt::Key_Minus:
        return zoomAbout(QRectF(rect()).center(), 1 / kZoomPerNotch);
    case Qt::Key_Escape:
        if (m_motion != Motion::None) return cancelDrag();
        break;
    default:
        break;
    }
    if (m_motion == Motion::None && m_rulerHand.key(event->key())) return;
    QWidget::keyPressEvent(event);
}

void SlicePane::cancelDrag() {
    const Motion motion = std::exchange(m_motion, Motion::None);
    if (motion == Motion::Crosshair && m_crosshairBefore) m_services.store().setCrosshair(*m_crosshairBefore);
    if (motion == Motion::Window && m_moved) m_services.store().cancel();
    if (motion == Motion::Ruler) m_rulerHand.end(false, m_services.store());
    update();
}

void SlicePane::leaveEvent(QEvent* event) {
    QWidget::leaveEvent(event);
    if (m_motion != Motion::None) return;
    hover({});
    m_rulerHand.leave();
    m_rulers.pointAt({});
}

void SlicePane::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    m_maximize->move(width() - m_maximize->width() - 2, 3);
    request();
}

void SlicePane::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    request();
}

void SlicePane::hideEvent(QHideEvent* event) {
    QWidget::hideEvent(event);
    if (std::exchange(m_motion, Motion::None) == Motion::Ruler) m_rulerHand.end(false, m_services.store());
    if (m_mouse) hover({});
}

QString SlicePane::titleText() const {
    const Geometry& geometry = m_services.scene().volume->geometry();
    const int a = axis();
    const Vec3 voxel = crosshairOf(m_services.scene());
    const PatientAxes axes = m_services.scene().session.coordinates->axes;
    const double at = inAxes(axes, geometry, geometry.worldFromVoxel(voxel))[m_worldAxis];
    QString name = QString::fromLatin1(sliceName(geometry, a));
    if (geometry.worldAxes == WorldAxes::Patient) name[0] = name[0].toUpper(); // a word, not an axis
    QString text = tr("%1  %2 of %3   %4 %5")
                       .arg(name)
                       .arg(static_cast<int>(std::lround(voxel[a])) + 1)
                       .arg(geometry.dims[a])
                       .arg(numberText(at, 2 * geometry.radius()), QString::fromUtf8(lengthUnit(geometry)));
    for (const QString& line : {m_fields.name(), m_fields.stateText()})
        if (!line.isEmpty()) text += "\n" + line;
    return text;
}

QString SlicePane::spokenValue() const {
    if (!m_services.store().hasVolume()) return tr("No volume is open");
    return titleText().replace("   ", ", ").replace('\n', "; ").simplified(); // gaps are heard as commas
}

std::optional<SpokenNumber> SlicePane::spokenNumber() {
    if (!m_services.store().hasVolume()) return {};
    const int a = axis();
    const double now = std::round(crosshairOf(m_services.scene())[a]) + 1;
    return SpokenNumber{now, 1, static_cast<double>(m_services.scene().volume->dims()[a]), 1, [this, a](double slice) {
                            Vec3 voxel = crosshairOf(m_services.scene());
                            voxel[a] = slice - 1;
                            moveCrosshair(m_services.store(), voxel);
                        }};
}

void SlicePane::paintTitle(QPainter& painter) const {
    const QFontMetricsF metrics(painter.font());
    QColor color = slicePlaneColor(m_worldAxis);
    painter.fillRect(QRectF(0, 0, width(), 2), color);
    double y = 5 + metrics.ascent(), room = width() - 2 * kMargin - m_maximize->width();
    for (const QString& line : titleText().split('\n')) {
        haloText(painter, {kMargin, y}, metrics.elidedText(line, Qt::ElideRight, room), color);
        y += metrics.lineSpacing();
        color = theme::kMark;
    }
}

/// Colours and values of the field, as in the picture; where the slice is large enough.
void SlicePane::paintLegend(QPainter& painter) const {
    const int room = static_cast<int>(height() / 2 - 1.5 * kTitle); // between the button and the letter below it
    if (m_fields.field() == nullptr || width() < 240 || room < 90) return;
    AnnotationInput input = m_fields.annotation(m_fields.picture(width(), room), *m_services.scene().session.reference);
    input.show = AnnotationChoice::none();
    input.show.legend = true;
    painter.save();
    painter.translate(0, kTitle); // below the button
    for (const Mark& mark : annotationMarks(input)) drawMark(painter, mark);
    painter.restore();
}

void SlicePane::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), QColor(0x0c, 0x0c, 0x0c)); // in any theme: grey is judged against black
    if (!m_services.store().hasVolume()) return;
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    if (!m_image.isNull()) painter.drawImage(QRectF(rect()), m_image);
    painter.setRenderHint(QPainter::Antialiasing);
    const SlicePlane shown = plane();
    paintCrosshair(painter, shown);
    paintRulers(painter, shown);

    QFont small = font();
    small.setPointSizeF(small.pointSizeF() * 0.9);
    painter.setFont(small);
    const QFontMetricsF metrics(small);
    paintLetters(painter);
    paintScale(painter, shown);
    paintLegend(painter);
    paintTitle(painter);
    QString text = hoverText();
    if (m_motion == Motion::Window && m_moved) {
        const ValueRange window = greyWindowOf(m_services.scene());
        const double span = window.hi - window.lo;
        text = tr("window %1  level %2\n%3 to %4")
                   .arg(numberText(span, span), numberText(window.lo + span / 2, span), numberText(window.lo, span),
                        numberText(window.hi, span));
    }
    const QStringList lines = text.split('\n', Qt::SkipEmptyParts);
    double y = height() - kMargin - metrics.descent() - metrics.lineSpacing() * static_cast<double>(lines.size() - 1);
    for (const QString& line : lines) {
        haloText(painter, {kMargin, y}, line, theme::kMark);
        y += metrics.lineSpacing();
    }
    if (hasFocus()) {
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(theme::kMarkAccent, 1));
        painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
    }
}

void SlicePane::paintCrosshair(QPainter& painter, const SlicePlane& plane) const {
    const Geometry& geometry = m_services.scene().volume->geometry();
    const Vec2 at = pixelOfVoxel(geometry, plane, crosshairOf(m_services.scene()));
    const SliceView view = sliceView(geometry, plane.axis);
    constexpr double kGap = 9; // so that what the lines point at is seen
    const QColor upright = slicePlaneColor(sliceWorldAxis(geometry, view.right)),
                 level = slicePlaneColor(sliceWorldAxis(geometry, view.down));
    haloLine(painter, {at.x, 0.0, at.x, at.y - kGap}, upright);
    haloLine(painter, {at.x, at.y + kGap, at.x, static_cast<double>(height())}, upright);
    haloLine(painter, {0.0, at.y, at.x - kGap, at.y}, level);
    haloLine(painter, {at.x + kGap, at.y, static_cast<double>(width()), at.y}, level);
}

void SlicePane::paintRulers(QPainter& painter, const SlicePlane& plane) const {
    const Geometry& geometry = m_services.scene().volume->geometry();
    const double cap = MarkMaker(plane.width, plane.height, 1, {}).capHeight;
    m_rulerHand.paint(painter, rulerMarks(m_rulers.shown(), geometry, plane, {1, cap}), rulerHandles());
}

QStringList SlicePane::edgeLetters() const {
    const Geometry& geometry = m_services.scene().volume->geometry();
    const SliceView view = sliceView(geometry, axis());
    const Vec3 right = geometry.directions[view.right] * (view.flipRight ? -1.0 : 1.0),
               up = geometry.directions[view.down] * (view.flipDown ? 1.0 : -1.0);
    QStringList letters;
    for (const Vec3& direction : {right, -right, up, -up}) {
        if (geometry.worldAxes == WorldAxes::Patient) {
            letters << QString::fromStdString(directionLetters(direction));
            continue;
        }
        int most = 0;
        for (int a = 1; a < 3; ++a)
            if (std::abs(direction[a]) > std::abs(direction[most])) most = a;
        letters << (direction[most] < 0 ? QString(QChar(0x2212)) : QString()) + QLatin1Char("xyz"[most]);
    }
    return letters;
}

void SlicePane::paintLetters(QPainter& painter) const {
    const QFontMetricsF metrics(painter.font());
    const double cap = metrics.capHeight(), midX = width() / 2.0, midY = height() / 2.0;
    const double top = kTitle + titleText().count('\n') * metrics.lineSpacing(); // below what is said of a field
    const QPointF middles[] = {
        {static_cast<double>(width()), midY}, {0, midY}, {midX, top + cap}, {midX, height() - kMargin - cap / 2}};
    const QStringList letters = edgeLetters();
    for (int i = 0; i < 4; ++i) {
        const double w = metrics.horizontalAdvance(letters[i]);
        const double left = std::clamp(middles[i].x() - w / 2, kMargin, std::max(kMargin, width() - kMargin - w));
        haloText(painter, {left, middles[i].y() + cap / 2}, letters[i], theme::kMark);
    }
}

void SlicePane::paintScale(QPainter& painter, const SlicePlane& plane) const {
    if (width() < 180) return;
    const double perPixel = plane.shown.width / plane.width;
    const double length = roundNumberBelow(0.2 * width() * perPixel), pixels = length / perPixel;
    const double right = width() - kMargin - 2, y = height() - kMargin - 2;
    for (const QLineF& line :
         {QLineF(right - pixels, y, right, y), QLineF(right - pixels, y - 3, right - pixels, y + 3),
          QLineF(right, y - 3, right, y + 3)})
        haloLine(painter, line, theme::kMark);
    const QFontMetricsF metrics(painter.font());
    const QString text = QStringLiteral("%1 %2").arg(
        numberText(length, length), QString::fromUtf8(lengthUnit(m_services.scene().volume->geometry())));
    haloText(painter, {right - metrics.horizontalAdvance(text), y - 6}, text, theme::kMark);
}

} // namespace pellucid::gui
