#include "tf/tf_canvas.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <QColorDialog>
#include <QContextMenuEvent>
#include <QKeyEvent>
#include <QLocale>
#include <QMenu>
#include <QWheelEvent>

#include "store/edits.h"
#include "tf/edit.h"
#include "tf/shapes.h"
#include "widgets/controls.h"
#include "widgets/input_habits.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kGrab = 9;     // how near the mouse must come to a point, pixels
constexpr double kSameSpot = 4; // points nearer to each other than this are chosen in turn by clicks
constexpr double kGrabEnd = 5;  // the same of the end of a feature's bar
constexpr double kTremble = 3;  // a click that moves less is no drag
constexpr double kFineSpeed = 0.1;
constexpr double kWheelStep = 0.8; // of the visible part, per notch of the wheel
constexpr double kNotch = 120;     // of QWheelEvent::angleDelta()

} // namespace

TfCanvas::TfCanvas(SessionStore& store, Results& results, Selection& selection, QWidget* parent)
    : QWidget(parent), Spoken(*this, QAccessible::Chart), m_store(store), m_results(results), m_selection(selection) {
    setObjectName("tfCanvas");
    setAccessibleName(tr("Transfer function"));
    setWhatsThis(tr("The curve of opacity over the values, in its colours, with the histogram behind it. Drag points, "
                    "double-click for a new one; arrow keys move the selected one."));
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setProperty(kKeepsSpace, true);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
    m_counts.setVolume(store.scene().volume);
    const auto updated = qOverload<>(&TfCanvas::update);
    connect(&store, &SessionStore::changed, this, &TfCanvas::follow);
    connect(&results, &Results::changed, this, updated);
    connect(&selection, &Selection::featureChanged, this, updated);
    connect(&selection, &Selection::hoveredChanged, this, updated);
    connect(&m_counts, &VolumeCounts::changed, this, [this] {
        m_jointImage = {};
        update();
    });
    connect(&m_axis, &IntensityAxis::changed, this, updated);
}

void TfCanvas::setHistogramScale(HistogramScale scale) {
    m_scale = scale;
    update();
}

void TfCanvas::setJointHistogramShown(bool on) {
    if (on == m_showJoint) return;
    m_showJoint = on;
    Q_EMIT m_axis.changed(); // the plot gives room to the axis of gradients, or takes it back
}

void TfCanvas::setFineOpacityAxis(bool on) {
    m_opacityAxis.setFine(on);
    update();
}

void TfCanvas::setReadOnly(bool on) {
    m_readOnly = on;
    m_drag.reset();
    update();
}

void TfCanvas::setUnit(const QString& unit) {
    m_unit = unit;
    update();
}

void TfCanvas::follow(const Scene& before, const Scene& after) {
    m_counts.setVolume(after.volume);
    if (before.series != after.series) {
        m_drag.reset();
        m_hovered = -1;
        m_hoveredBar.reset();
        selectPoints({});
        m_selection.setHoveredIntensity({});
        m_axis.reset();
        setUnit(QString::fromStdString(after.unit.value_or("")));
        return;
    }
    // Through another window the same values stay in sight.
    if (before.volume != after.volume && before.volume && after.volume && !m_axis.isWhole()) {
        m_axis.setVisible(after.volume->intensityOfValue(before.volume->valueOfIntensity(m_axis.lo())),
                          after.volume->intensityOfValue(before.volume->valueOfIntensity(m_axis.hi())));
    }
    // A change that this drag did not make (undo, another file) ends it.
    if (m_drag && m_drag->edits() && m_drag->moved && !m_store.isPreviewing()) m_drag.reset();
    const auto &old = before.tf.points, &now = after.tf.points;
    if (old == now) return update();
    m_hovered = -1;
    selectPoints(m_points.followed(old, now));
    update();
}

void TfCanvas::selectPoints(const PointSelection& points) {
    std::vector<int> there;
    for (const int index : points.indices())
        if (index >= 0 && static_cast<std::size_t>(index) < tf().points.size()) there.push_back(index);
    const PointSelection chosen(std::move(there), points.current());
    if (chosen == m_points) return;
    m_points = chosen;
    update();
    Q_EMIT selectionChanged(m_points.current());
}

void TfCanvas::selectPoint(int index) { selectPoints(index < 0 ? PointSelection() : PointSelection({index}, index)); }

void TfCanvas::selectAll(int current) {
    std::vector<int> all(tf().points.size());
    std::iota(all.begin(), all.end(), 0);
    selectPoints(PointSelection(std::move(all), current));
}

void TfCanvas::zoomTo(const Feature& feature) {
    const double beside = (feature.b - feature.a) / 4;
    m_axis.setVisible(feature.a - beside, feature.b + beside);
}

void TfCanvas::addPoint(double x, double opacity) {
    if (m_readOnly || !m_store.hasVolume()) return;
    m_store.commit();
    const AddedPoint added = withPointAdded(tf(), x, opacity);
    editTf(m_store, added.tf, tr("Add point"));
    selectPoint(added.index);
}

void TfCanvas::removeSelected() {
    if (m_readOnly || m_points.isEmpty()) return;
    m_drag.reset(); // the points go, also out of a hand that holds them
    m_store.commit();
    const TransferFunction without = withPointsRemoved(tf(), m_points);
    const QString text = m_points.size() == 1 ? tr("Remove point") : tr("Remove points");
    selectPoints({});
    editTf(m_store, without, text);
}

bool TfCanvas::areFixed() const {
    const auto& indices = m_points.indices();
    return std::all_of(indices.begin(), indices.end(), [this](int index) { return point(index).fixed; });
}

void TfCanvas::toggleFixed() {
    if (m_readOnly || m_points.isEmpty()) return;
    m_store.commit();
    const bool one = m_points.size() == 1, fix = !areFixed();
    const QString text =
        fix ? (one ? tr("Fix point") : tr("Fix points")) : (one ? tr("Free point") : tr("Free points"));
    editTf(m_store, withPointsFixed(tf(), m_points, fix), text);
}

void TfCanvas::chooseColor() {
    if (m_readOnly || m_points.isEmpty()) return;
    const PointSelection points = m_points;
    const QColor before = colorFromRgb(point(points.current()).color);
    const QColor color = QColorDialog::getColor(
        before, this, points.size() == 1 ? tr("Colour of the point") : tr("Colour of the points"));
    if (color.isValid()) editTf(m_store, withPointsColor(tf(), points, rgbFromColor(color)), tr("Colour"));
}

// Where things lie.

QRectF TfCanvas::plot() const {
    const double right = m_showJoint ? layout::kGradientAxis : layout::kRight;
    return {layout::kLeft, layout::kTop, std::max(1.0, width() - layout::kLeft - right),
            std::max(1.0, height() - layout::kTop - layout::kBottom)};
}

QRectF TfCanvas::strip() const {
    const QRectF r = plot();
    return {r.left(), r.bottom() + 2, r.width(), layout::kStrip};
}

void TfCanvas::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    Q_EMIT arranged();
}

QRectF TfCanvas::overviewTrack() const {
    const QRectF r = plot();
    return {r.left(), height() - layout::kOverview - 1, r.width(), layout::kOverview};
}

QPointF TfCanvas::positionOf(double x, double opacity) const {
    const QRectF r = plot();
    return {m_axis.toPixel(x, r), r.bottom() - m_opacityAxis.height(opacity) * r.height()};
}

QPointF TfCanvas::positionOf(int index) const { return positionOf(point(index).x, point(index).opacity); }

QPainterPath TfCanvas::curveOf(const TransferFunction& function) const {
    constexpr int kPieces = 24;
    const std::vector<ControlPoint> points = function.pointsWithEnds();
    QPainterPath path;
    bool begun = false;
    const auto lineTo = [&](double x, double opacity) {
        const QPointF at = positionOf(x, opacity);
        begun ? path.lineTo(at) : path.moveTo(at);
        begun = true;
    };
    for (std::size_t i = 1; i < points.size(); ++i) {
        const ControlPoint &p = points[i - 1], &q = points[i];
        if (q.x < m_axis.lo() || p.x > m_axis.hi()) continue;
        if (q.x == p.x) { // a step
            lineTo(p.x, p.opacity);
            lineTo(q.x, q.opacity);
            continue;
        }
        const double from = std::max(p.x, m_axis.lo()), to = std::min(q.x, m_axis.hi());
        const auto opacity = [&](double x) { return p.opacity + (x - p.x) / (q.x - p.x) * (q.opacity - p.opacity); };
        const double bottom = m_opacityAxis.height(opacity(from)), top = m_opacityAxis.height(opacity(to));
        lineTo(from, opacity(from));
        if (m_opacityAxis.isFine() && bottom != top) { // even steps of height: it is steepest where α is least
            for (int k = 1; k < kPieces; ++k) {
                const double a = m_opacityAxis.opacity(bottom + (top - bottom) * k / kPieces);
                lineTo(p.x + (a - p.opacity) / (q.opacity - p.opacity) * (q.x - p.x), a);
            }
        }
        lineTo(to, opacity(to));
    }
    return path;
}

double TfCanvas::intensityAt(double pixelX) const { return m_axis.toIntensity(pixelX, plot()); }
double TfCanvas::opacityAt(double pixelY) const {
    return m_opacityAxis.opacity((plot().bottom() - pixelY) / plot().height());
}

TfCanvas::Zone TfCanvas::zoneAt(const QPointF& position) const {
    const QRectF r = plot();
    if (position.x() < r.left() - kGrab || position.x() > r.right() + kGrab) return Zone::None;
    if (position.y() > r.bottom())
        return !m_axis.isWhole() && position.y() >= overviewTrack().top() - 2 ? Zone::Overview : Zone::Axis;
    if (position.y() >= r.top()) return Zone::Plot;
    return position.y() >= r.top() - layout::kBar - 4 ? Zone::Bars : Zone::None;
}

std::vector<int> TfCanvas::pointsAt(const QPointF& position) const {
    std::vector<std::pair<double, int>> near;
    const auto& points = tf().points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!m_axis.contains(points[i].x)) continue;
        const double d = QLineF(positionOf(points[i].x, points[i].opacity), position).length();
        if (d <= kGrab) near.emplace_back(d, static_cast<int>(i));
    }
    std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<int> indices;
    for (const auto& [d, index] : near) indices.push_back(index);
    return indices;
}

int TfCanvas::pointAt(const QPointF& position) const {
    const std::vector<int> near = pointsAt(position);
    if (near.empty()) return -1;
    // The current one wins where several lie on each other.
    const bool current = std::find(near.begin(), near.end(), m_points.current()) != near.end();
    return current ? m_points.current() : near.front();
}

QRectF TfCanvas::barOf(const Feature& feature) const {
    const QRectF r = plot();
    const double left = std::max(r.left(), m_axis.toPixel(feature.a, r));
    const double right = std::min(r.right(), m_axis.toPixel(feature.b, r));
    return right > left ? QRectF(left, r.top() - layout::kBar - 3, right - left, layout::kBar) : QRectF();
}

std::optional<TfCanvas::BarHit> TfCanvas::barAt(const QPointF& position) const {
    if (zoneAt(position) != Zone::Bars) return {};
    const auto& features = tf().features;
    // Ends first, the nearest one: of two that touch, that of the bar which the mouse is over.
    std::optional<BarHit> hit;
    double nearest = kGrabEnd;
    for (std::size_t i = 0; i < features.size(); ++i) {
        const QRectF bar = barOf(features[i]);
        const bool over = position.x() >= bar.left() && position.x() <= bar.right();
        if (bar.isEmpty()) continue;
        if (over && !hit) hit = BarHit{static_cast<int>(i), Part::Middle};
        const double grab = std::min(nearest, over ? bar.width() / 4 : kGrabEnd); // narrow bars keep a middle
        const QRectF r = plot();
        const auto end = [&](double x, Part part) {
            const double d = std::abs(position.x() - m_axis.toPixel(x, r)) + (over ? 0.0 : 0.5);
            if (d > grab || d > nearest) return;
            nearest = d;
            hit = BarHit{static_cast<int>(i), part};
        };
        end(features[i].a, Part::Lower);
        end(features[i].b, Part::Upper);
    }
    return hit;
}

QString TfCanvas::valueText(double x) const {
    if (!m_store.hasVolume()) return {};
    const Volume& volume = *m_store.scene().volume;
    const double seen = (volume.range().hi - volume.range().lo) * m_axis.width();
    const QString value = numberText(volume.valueOfIntensity(x), seen);
    return m_unit.isEmpty() ? value : tr("%1 %2").arg(value, m_unit);
}

// The mouse.

void TfCanvas::hover(const QPointF& position) {
    const bool over = m_store.hasVolume() && zoneAt(position) != Zone::None;
    m_selection.setHoveredIntensity(over ? std::optional(intensityAt(position.x())) : std::nullopt);
    const int index = m_readOnly ? -1 : pointAt(position);
    const std::optional<BarHit> bar = m_readOnly || index >= 0 ? std::nullopt : barAt(position);
    if (index == m_hovered && bar == m_hoveredBar) return;
    m_hovered = index;
    m_hoveredBar = bar;
    setCursor(index >= 0                  ? Qt::PointingHandCursor
              : !bar                      ? Qt::ArrowCursor
              : bar->part == Part::Middle ? Qt::OpenHandCursor
                                          : Qt::SizeHorCursor);
    update();
}

void TfCanvas::mousePressEvent(QMouseEvent* event) {
    const QPointF at = event->position();
    if (m_drag || !m_store.hasVolume()) return event->ignore();
    Drag drag{.kind = Drag::Kind::Pan, .pressed = at, .last = at, .at = at, .lo = m_axis.lo()};
    if (event->button() == Qt::MiddleButton) {
        m_drag = std::move(drag);
        return;
    }
    if (event->button() != Qt::LeftButton) return event->ignore();
    const bool adds = event->modifiers().testFlag(Qt::ControlModifier);
    if (const std::vector<int> near = pointsAt(at); !near.empty()) {
        int index = near.front();
        for (const int other : near)
            if (m_points.contains(other)) index = other;
        if (std::find(near.begin(), near.end(), m_points.current()) != near.end()) index = m_points.current();
        // What a click selects: with Ctrl one more or one fewer, else this one alone; where several lie on each other
        // and this is the current one already, the next of them.
        if (adds) {
            drag.before = m_points.toggled(index);
        } else {
            std::vector<int> same;
            for (const int other : near)
                if (QLineF(positionOf(other), positionOf(index)).length() < kSameSpot) same.push_back(other);
            std::sort(same.begin(), same.end());
            auto next = std::find(same.begin(), same.end(), index);
            if (m_points.size() == 1 && m_points.contains(index)) ++next;
            drag.before = PointSelection({next == same.end() ? same.front() : *next});
            if (!m_points.contains(index)) selectPoint(index);
        }
        if (m_readOnly) return selectPoints(drag.before);
        drag.kind = Drag::Kind::Points;
        drag.start = tf();
        drag.index = index;
    } else if (const std::optional<BarHit> bar = barAt(at)) {
        m_selection.setFeature(feature(bar->feature).id);
        if (m_readOnly) return;
        drag.kind = Drag::Kind::Feature;
        drag.start = tf();
        drag.index = bar->feature;
        drag.part = bar->part;
        if (bar->part == Part::Middle) setCursor(Qt::ClosedHandCursor);
    } else if (const Zone zone = zoneAt(at); zone == Zone::Plot) {
        drag.kind = Drag::Kind::Band;
        if (adds || event->modifiers().testFlag(Qt::ShiftModifier)) drag.before = m_points;
        selectPoints(drag.before);
    } else if (zone == Zone::Overview) {
        drag.kind = Drag::Kind::Overview;
    } else if (zone != Zone::Axis) {
        return selectPoints({});
    }
    m_drag = std::move(drag);
}

void TfCanvas::mouseMoveEvent(QMouseEvent* event) {
    const QPointF at = event->position();
    if (!m_drag) return hover(at);
    Drag& drag = *m_drag;
    const bool fine = event->modifiers().testFlag(Qt::ControlModifier) && drag.edits();
    drag.at += (at - drag.last) * (fine ? kFineSpeed : 1.0);
    drag.last = at;
    if (!drag.moved && (at - drag.pressed).manhattanLength() < kTremble) return; // a click that trembles is no drag
    const bool begins = !std::exchange(drag.moved, true);
    const double perPixel = m_axis.width() / plot().width(), right = at.x() - drag.pressed.x();
    switch (drag.kind) {
    case Drag::Kind::Points:
        if (begins && !m_points.contains(drag.index)) selectPoint(drag.index);
        return dragPoints(drag.at, event->modifiers().testFlag(Qt::ShiftModifier));
    case Drag::Kind::Feature:
        return dragFeature(drag.at);
    case Drag::Kind::Band:
        return selectBand(QRectF(drag.pressed, at).normalized());
    case Drag::Kind::Pan:
        return m_axis.moveTo(drag.lo - right * perPixel);
    case Drag::Kind::Overview:
        return m_axis.moveTo(drag.lo + right / plot().width());
    }
}

std::function<double(double)> TfCanvas::raisedBy(double height) const {
    return [this, height](double opacity) {
        return height == 0 ? opacity : m_opacityAxis.opacity(m_opacityAxis.height(opacity) + height);
    };
}

void TfCanvas::dragPoints(const QPointF& to, bool alongAxis) {
    const Drag& drag = *m_drag;
    const ControlPoint& start = drag.start.points[static_cast<std::size_t>(drag.index)];
    const QPointF way = to - drag.pressed, target = positionOf(start.x, start.opacity) + way;
    double x = intensityAt(target.x());
    double opacity = opacityAt(target.y());
    if (alongAxis && std::abs(way.x()) > std::abs(way.y())) { // the one that was moved along more
        opacity = start.opacity;
    } else if (alongAxis) {
        x = start.x;
    }
    const bool one = m_points.size() == 1;
    const double rise = m_opacityAxis.height(opacity) - m_opacityAxis.height(start.opacity);
    const TransferFunction moved = one ? withPointMoved(drag.start, drag.index, x, opacity)
                                       : withPointsMoved(drag.start, m_points, x - start.x, raisedBy(rise));
    previewTf(m_store, moved, one ? tr("Move point") : tr("Move points"));
    if (!m_drag) return;
    m_selection.setHoveredIntensity(moved.points[static_cast<std::size_t>(drag.index)].x); // what the readout tells of
}

void TfCanvas::dragFeature(const QPointF& to) {
    const Drag& drag = *m_drag;
    const Feature& feature = drag.start.features[static_cast<std::size_t>(drag.index)];
    const double dx = (to.x() - drag.pressed.x()) / plot().width() * m_axis.width();
    if (drag.part == Part::Middle)
        return previewTf(m_store, withFeatureMoved(drag.start, drag.index, dx), tr("Move feature"));
    const double a = feature.a + (drag.part == Part::Lower ? dx : 0),
                 b = feature.b + (drag.part == Part::Upper ? dx : 0);
    previewTf(m_store, withFeatureWidened(drag.start, drag.index, a, b), tr("Widen feature"));
}

void TfCanvas::selectBand(const QRectF& band) {
    std::vector<int> inside;
    const auto& points = tf().points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const QPointF at = positionOf(static_cast<int>(i));
        if (band.contains(at) && plot().adjusted(-1, -1, 1, 1).contains(at)) inside.push_back(static_cast<int>(i));
    }
    selectPoints(m_drag->before.united(PointSelection(std::move(inside))));
    update(); // the band
}

void TfCanvas::mouseReleaseEvent(QMouseEvent* event) {
    if ((event->button() != Qt::LeftButton && event->button() != Qt::MiddleButton) || !m_drag) return;
    const Drag drag = std::move(*m_drag);
    m_drag.reset();
    if (drag.edits() && drag.moved) m_store.commit();
    if (drag.kind == Drag::Kind::Points && !drag.moved) selectPoints(drag.before);
    hover(event->position());
    update();
}

void TfCanvas::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    m_drag.reset();
    const QPointF at = event->position();
    const Zone zone = zoneAt(at);
    if (zone == Zone::Axis || zone == Zone::Overview) {
        if (pointAt(at) < 0) return m_axis.reset();
    }
    if (m_readOnly) return;
    if (const int index = pointAt(at); index >= 0) {
        if (!m_points.contains(index)) selectPoint(index);
        chooseColor();
    } else if (zone == Zone::Bars) {
        if (const std::optional<BarHit> bar = barAt(at)) zoomTo(feature(bar->feature));
    } else if (plot().adjusted(-4, -4, 4, 4).contains(at)) {
        addPoint(intensityAt(at.x()), opacityAt(at.y()));
    }
}

void TfCanvas::wheelEvent(QWheelEvent* event) {
    if (!m_store.hasVolume() || (m_drag && m_drag->edits())) return event->ignore();
    const QPoint turned = event->angleDelta();
    const bool shift = event->modifiers().testFlag(Qt::ShiftModifier);
    // Sideways, or with Shift (which some systems turn into sideways themselves): along the axis.
    const double along = turned.x() != 0 && turned.y() == 0 ? turned.x() : shift ? turned.y() : 0;
    if (along != 0) {
        m_axis.pan(-along / kNotch * m_axis.width() / 10);
    } else if (turned.y() != 0) {
        m_axis.zoomAbout(intensityAt(event->position().x()), std::pow(kWheelStep, turned.y() / kNotch));
    }
    event->accept();
    if (!m_drag) hover(event->position());
}

void TfCanvas::contextMenuEvent(QContextMenuEvent* event) {
    if (!m_store.hasVolume() || m_drag) return;
    const int current = m_points.current();
    const QPointF position =
        event->reason() == QContextMenuEvent::Keyboard && current >= 0 ? positionOf(current) : QPointF(event->pos());
    QMenu menu(this);
    menu.setObjectName("tfContextMenu");
    fillMenu(menu, position);
    m_menuOpen = true; // the mouse leaves, and what it pointed at stays what the menu is about
    menu.exec(mapToGlobal(position.toPoint()));
    m_menuOpen = false;
    if (!underMouse()) m_selection.setHoveredIntensity({});
}

void TfCanvas::fillMenu(QMenu& menu, const QPointF& position) {
    const double x = intensityAt(position.x());
    const int index = pointAt(position), here = featureAt(tf().features, x);
    if (!m_readOnly && index >= 0) {
        if (!m_points.contains(index)) selectPoint(index);
        const bool one = m_points.size() == 1;
        menu.addAction(tr("Colour…"), this, &TfCanvas::chooseColor);
        QAction* fixed = menu.addAction(tr("Fixed (refinement leaves it alone)"), this, &TfCanvas::toggleFixed);
        fixed->setCheckable(true);
        fixed->setChecked(areFixed());
        menu.addSeparator();
        menu.addAction(one ? tr("Remove point") : tr("Remove %1 points").arg(m_points.size()), this,
                       &TfCanvas::removeSelected);
    } else if (!m_readOnly && zoneAt(position) == Zone::Plot) {
        const double opacity = opacityAt(position.y());
        menu.addAction(tr("Add point here"), this, [this, x, opacity] { addPoint(x, opacity); });
        menu.addAction(tr("Select all points"), QKeySequence(QKeySequence::SelectAll), this, [this] { selectAll(-1); });
    }
    m_selection.setHoveredIntensity(x);
    if (index < 0) Q_EMIT menuOpening(menu, x, here < 0 ? 0 : feature(here).id);
    menu.addSeparator();
    if (here >= 0) {
        const Feature& f = feature(here);
        menu.addAction(tr("Zoom to %1").arg(QString::fromStdString(f.name)), this, [this, f] { zoomTo(f); });
    }
    QAction* whole = menu.addAction(tr("Show all values"), &m_axis, &IntensityAxis::reset);
    whole->setEnabled(!m_axis.isWhole());
}

// The keys.

void TfCanvas::nudge(double dx, double dHeight) {
    if (m_readOnly || m_points.isEmpty()) return;
    QString key = QStringLiteral("nudge");
    for (const int index : m_points.indices()) key += QStringLiteral("-%1").arg(index);
    editTf(m_store, withPointsMoved(tf(), m_points, dx, raisedBy(dHeight)),
           m_points.size() == 1 ? tr("Move point") : tr("Move points"), key);
}

void TfCanvas::keyPressEvent(QKeyEvent* event) {
    const double step = event->modifiers().testFlag(Qt::ShiftModifier) ? 1.0 / 1024 : 1.0 / 128;
    const double along = step * m_axis.width();
    const int count = static_cast<int>(tf().points.size()), current = m_points.current();
    if (event->matches(QKeySequence::SelectAll)) return selectAll(current);
    switch (event->key()) {
    case Qt::Key_Delete:
    case Qt::Key_Backspace:
        return removeSelected();
    case Qt::Key_Return:
    case Qt::Key_Enter:
        return chooseColor();
    case Qt::Key_Space:
        return toggleFixed();
    case Qt::Key_Left:
        return nudge(-along, 0);
    case Qt::Key_Right:
        return nudge(along, 0);
    case Qt::Key_Up:
        return nudge(0, step);
    case Qt::Key_Down:
        return nudge(0, -step);
    case Qt::Key_PageDown:
        return selectPoint(count == 0 ? -1 : (current + 1) % count);
    case Qt::Key_PageUp:
        return selectPoint(count == 0 ? -1 : (std::max(current, 0) + count - 1) % count);
    case Qt::Key_Plus:
    case Qt::Key_Equal:
    case Qt::Key_Minus:
        return m_axis.zoomAbout(current >= 0 ? std::clamp(point(current).x, m_axis.lo(), m_axis.hi()) : m_axis.middle(),
                                event->key() == Qt::Key_Minus ? 1 / kWheelStep : kWheelStep);
    case Qt::Key_Home:
        return m_axis.reset();
    case Qt::Key_Escape: {
        const bool edits = m_drag && m_drag->edits();
        m_drag.reset();
        edits ? m_store.cancel() : selectPoints({});
        return update();
    }
    default:
        QWidget::keyPressEvent(event);
    }
}

void TfCanvas::leaveEvent(QEvent*) {
    m_hovered = -1;
    m_hoveredBar.reset();
    if (!m_menuOpen) m_selection.setHoveredIntensity({});
    update();
}

void TfCanvas::changeEvent(QEvent* event) {
    if (event->type() == QEvent::PaletteChange) m_jointImage = {}; // it has colours of the theme
    QWidget::changeEvent(event);
}

// Words.

SeenBins TfCanvas::seenHistogram() const {
    const Scene& scene = m_store.scene();
    if (!scene.histogram || !scene.volume) return {};
    const Histogram* fine = m_axis.isWhole() ? nullptr : m_counts.fine(true);
    return fine == nullptr ? wholeBins(scene.histogram->counts)
                           : seenBins(fine->counts, m_axis.lo(), m_axis.hi(), VolumeCounts::valueStep(*scene.volume));
}

QString TfCanvas::readout() const {
    const std::optional<double> x = m_selection.hoveredIntensity();
    const Scene& scene = m_store.scene();
    if (!x || !m_store.hasVolume()) return {};
    QStringList parts{valueText(*x), tr("opacity %1").arg(QString::number(tf().opacity(*x), 'g', 3))};
    const SeenBins bins = seenHistogram();
    if (const int bin = bins.at(*x); bin >= 0 && scene.histogram->total > 0) {
        const double count = std::round(bins.counts[static_cast<std::size_t>(bin)]);
        const double share = 100 * count / static_cast<double>(scene.histogram->total);
        const QString percent = share > 0 && share < 0.01 ? tr("< 0.01") : QString::number(share, 'g', 2);
        parts << (count == 1 ? tr("1 voxel (%1 %)").arg(percent)
                             : tr("%1 voxels (%2 %)").arg(QLocale().toString(static_cast<qlonglong>(count)), percent));
    }
    if (const int here = featureAt(tf().features, *x); here >= 0) {
        const Feature& f = feature(here);
        const QString name = QString::fromStdString(f.name);
        const bool empty = scene.isEmpty(static_cast<std::size_t>(here));
        parts << (f.hidden ? tr("%1 (hidden)").arg(name) : empty ? tr("%1 (empty)").arg(name) : name);
    }
    return parts.join(QStringLiteral("  ·  "));
}

QString TfCanvas::pointText(int index) const {
    const ControlPoint& p = point(index);
    return tr("value %1, opacity %2%3")
        .arg(valueText(p.x), QString::number(p.opacity, 'g', 4), p.fixed ? tr(", fixed") : QString());
}

QString TfCanvas::spokenValue() const {
    if (!m_store.hasVolume()) return tr("No volume is open");
    const std::size_t count = tf().points.size();
    QStringList parts{count == 1 ? tr("1 point") : tr("%1 points").arg(count)};
    const int current = m_points.current();
    if (current >= 0) {
        if (m_points.size() > 1) parts << tr("%1 of them selected").arg(m_points.size());
        parts << tr("point %1 selected: %2").arg(current + 1).arg(pointText(current));
        if (const int here = featureAt(tf().features, point(current).x); here >= 0)
            parts << tr("in the feature %1").arg(QString::fromStdString(feature(here).name));
    } else {
        parts << tr("none selected");
    }
    if (!m_axis.isWhole()) parts << tr("shown from %1 to %2").arg(valueText(m_axis.lo()), valueText(m_axis.hi()));
    return parts.join("; ");
}

QString TfCanvas::toolTipAt(const QPointF& position) const {
    if (const int index = pointAt(position); index >= 0) {
        return pointText(index) + "\n" +
               tr("opacity of a path one voxel long (d0)\n"
                  "Shift: along one axis; Ctrl: a tenth as fast; Ctrl+click: select several");
    }
    if (const std::optional<BarHit> bar = barAt(position)) {
        const Feature& f = feature(bar->feature);
        return tr("feature %1: values %2 to %3\nDrag the middle to move it, an end to widen it; double-click to zoom")
            .arg(QString::fromStdString(f.name), valueText(f.a), valueText(f.b));
    }
    switch (zoneAt(position)) {
    case Zone::Axis:
    case Zone::Overview:
        return m_axis.isWhole() ? tr("Values%1\nThe wheel zooms in").arg(m_unit.isEmpty() ? QString() : ", " + m_unit)
                                : tr("Values %1 to %2\nDrag to move along; double-click to see all")
                                      .arg(valueText(m_axis.lo()), valueText(m_axis.hi()));
    case Zone::Plot:
        return tr("Grey: how many voxels have this value; line: how much of the picture they make (visibility)\n"
                  "Double-click to add a point; drag to select several; the wheel zooms\n"
                  "Enter colours, Delete removes, Space fixes; arrows move, Page Up and Down go to the next");
    case Zone::None:
    case Zone::Bars:
        break;
    }
    if (position.x() < plot().left() && position.y() > plot().top())
        return tr("Opacity of a path one voxel long (d0), 0 to 1%1")
            .arg(m_opacityAxis.isFine() ? tr("\nHeight is its cube root: room for the small ones") : QString());
    if (m_showJoint && position.x() > plot().right())
        return tr("Gradient magnitude: by how much the value changes\nover the length of a voxel (d0)");
    return {};
}

bool TfCanvas::event(QEvent* event) {
    const auto tip = [this](const QPoint& position) { return m_drag ? QString() : toolTipAt(position); };
    return (m_store.hasVolume() && showsTip(*event, *this, tip)) || QWidget::event(event);
}

} // namespace pellucid::gui
