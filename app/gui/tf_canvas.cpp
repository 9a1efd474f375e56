#include "tf_canvas.h"

#include <algorithm>
#include <cmath>

#include <QColorDialog>
#include <QContextMenuEvent>
#include <QHelpEvent>
#include <QKeyEvent>
#include <QMenu>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>

#include "number_text.h"
#include "store/edits.h"
#include "tf/edit.h"
#include "theme.h"

namespace pellucid::gui {
namespace {

constexpr double kLeft = 46, kRight = 14, kTop = 24, kBottom = 36; // margins around the plot, pixels
constexpr double kBar = 13;                                        // height of the features' bars
constexpr double kStrip = 8;                                       // height of the colour strip
constexpr double kGrab = 9;                                        // how near the mouse must come to a point
constexpr double kRadius = 5;

QColor translucent(QColor color, double alpha) {
    color.setAlphaF(static_cast<float>(alpha));
    return color;
}

} // namespace

TfCanvas::TfCanvas(SessionStore& store, Results& results, QWidget* parent)
    : QWidget(parent), m_store(store), m_results(results) {
    setObjectName("tfCanvas");
    setAccessibleName(tr("Transfer function"));
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
    connect(&store, &SessionStore::changed, this, &TfCanvas::follow);
    connect(&results, &Results::changed, this, qOverload<>(&TfCanvas::update));
    connect(&m_axis, &IntensityAxis::changed, this, qOverload<>(&TfCanvas::update));
}

void TfCanvas::setLogHistogram(bool on) {
    m_logHistogram = on;
    update();
}

void TfCanvas::setRootOpacityAxis(bool on) {
    m_rootOpacity = on;
    update();
}

void TfCanvas::setReadOnly(bool on) {
    m_readOnly = on;
    m_drag.reset();
    update();
}

void TfCanvas::follow(const Scene& before, const Scene& after) {
    if (before.data != after.data) {
        m_drag.reset();
        selectPoint(-1);
        update();
        return;
    }
    // A change that this drag did not make (undo, another file) ends it.
    if (m_drag && m_drag->moved && !m_store.isPreviewing()) m_drag.reset();
    const auto &old = before.tf.points, &now = after.tf.points;
    if (old == now) return update();
    m_hovered = -1;
    // What was selected stays so: the point in its place where none came or went, else the one that is as it was.
    if (m_selected >= 0 && old.size() != now.size() && static_cast<std::size_t>(m_selected) < old.size()) {
        const auto same = std::find(now.begin(), now.end(), old[static_cast<std::size_t>(m_selected)]);
        selectPoint(same == now.end() ? -1 : static_cast<int>(same - now.begin()));
    }
    if (m_selected >= static_cast<int>(now.size())) selectPoint(-1);
    update();
}

void TfCanvas::selectPoint(int index) {
    if (index >= static_cast<int>(tf().points.size())) index = -1;
    if (index == m_selected) return;
    m_selected = index;
    update();
    Q_EMIT selectionChanged(index);
}

void TfCanvas::addPoint(double x, double opacity) {
    if (m_readOnly || !m_store.hasVolume()) return;
    m_store.commit();
    const AddedPoint added = withPointAdded(tf(), x, opacity);
    editTf(m_store, added.tf, tr("Add point"));
    selectPoint(added.index);
}

void TfCanvas::removeSelected() {
    if (m_readOnly || m_selected < 0) return;
    m_drag.reset(); // the point goes, also out of a hand that holds it
    m_store.commit();
    const TransferFunction without = withPointRemoved(tf(), m_selected);
    selectPoint(-1);
    editTf(m_store, without, tr("Remove point"));
}

void TfCanvas::toggleFixed() {
    if (m_readOnly || m_selected < 0) return;
    m_store.commit();
    const bool fixed = !tf().points[static_cast<std::size_t>(m_selected)].fixed;
    editTf(m_store, withPointFixed(tf(), m_selected, fixed), fixed ? tr("Fix point") : tr("Free point"));
}

void TfCanvas::chooseColor() {
    if (m_readOnly || m_selected < 0) return;
    const int index = m_selected;
    const QColor before = colorFromRgb(tf().points[static_cast<std::size_t>(index)].color);
    const QColor color = QColorDialog::getColor(before, this, tr("Colour of the point"));
    if (color.isValid()) editTf(m_store, withPointColor(tf(), index, rgbFromColor(color)), tr("Colour"));
}

QRectF TfCanvas::plot() const {
    return {kLeft, kTop, std::max(1.0, width() - kLeft - kRight), std::max(1.0, height() - kTop - kBottom)};
}

double TfCanvas::heightOfOpacity(double opacity) const { return m_rootOpacity ? std::sqrt(opacity) : opacity; }
double TfCanvas::opacityOfHeight(double height) const {
    height = std::clamp(height, 0.0, 1.0);
    return m_rootOpacity ? height * height : height;
}

QPointF TfCanvas::positionOf(double x, double opacity) const {
    const QRectF r = plot();
    return {m_axis.toPixel(x, r), r.bottom() - heightOfOpacity(opacity) * r.height()};
}

double TfCanvas::intensityAt(double pixelX) const { return m_axis.toIntensity(pixelX, plot()); }
double TfCanvas::opacityAt(double pixelY) const {
    return opacityOfHeight((plot().bottom() - pixelY) / plot().height());
}

int TfCanvas::pointAt(const QPointF& position) const {
    int best = -1;
    double nearest = kGrab;
    const auto& points = tf().points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double d = QLineF(positionOf(points[i].x, points[i].opacity), position).length();
        // The selected one wins where several lie on each other.
        if (d < nearest || (d <= kGrab && static_cast<int>(i) == m_selected)) {
            best = static_cast<int>(i);
            nearest = static_cast<int>(i) == m_selected ? 0.0 : d;
        }
    }
    return best;
}

int TfCanvas::featureBarAt(const QPointF& position) const {
    const QRectF r = plot();
    if (position.y() > r.top() || position.y() < r.top() - kBar - 4 || position.x() < r.left() ||
        position.x() > r.right())
        return -1;
    return featureAt(tf().features, intensityAt(position.x()));
}

QString TfCanvas::valueText(double x) const {
    if (!m_store.hasVolume()) return {};
    const Volume& volume = *m_store.scene().volume;
    return numberText(volume.valueOfIntensity(x), volume.range().hi - volume.range().lo);
}

void TfCanvas::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return event->ignore();
    const int index = pointAt(event->position());
    selectPoint(index);
    if (index < 0 || m_readOnly) return;
    const ControlPoint& point = tf().points[static_cast<std::size_t>(index)];
    m_drag = Drag{tf(), index, event->position(), positionOf(point.x, point.opacity) - event->position(), false};
}

void TfCanvas::mouseMoveEvent(QMouseEvent* event) {
    if (!m_drag) {
        const int hovered = m_readOnly ? -1 : pointAt(event->position());
        setCursor(hovered >= 0 ? Qt::PointingHandCursor : Qt::ArrowCursor);
        if (hovered != m_hovered) {
            m_hovered = hovered;
            update();
        }
        return;
    }
    // A click that trembles is not a drag.
    if (!m_drag->moved && (event->position() - m_drag->pressed).manhattanLength() < 3) return;
    m_drag->moved = true;
    const ControlPoint& start = m_drag->start.points[static_cast<std::size_t>(m_drag->index)];
    const QPointF target = event->position() + m_drag->grip;
    double x = intensityAt(target.x());
    double opacity = opacityAt(target.y());
    if (event->modifiers().testFlag(Qt::ShiftModifier)) { // along one axis, the one that was moved along more
        const QPointF way = event->position() - m_drag->pressed;
        if (std::abs(way.x()) > std::abs(way.y())) {
            opacity = start.opacity;
        } else {
            x = start.x;
        }
    }
    previewTf(m_store, withPointMoved(m_drag->start, m_drag->index, x, opacity), tr("Move point"));
}

void TfCanvas::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !m_drag) return;
    const bool moved = m_drag->moved;
    m_drag.reset();
    if (moved) m_store.commit();
}

void TfCanvas::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || m_readOnly) return;
    m_drag.reset();
    if (pointAt(event->position()) >= 0) {
        chooseColor();
    } else if (plot().adjusted(-4, -4, 4, 4).contains(event->position())) {
        addPoint(intensityAt(event->position().x()), opacityAt(event->position().y()));
    }
}

void TfCanvas::contextMenuEvent(QContextMenuEvent* event) {
    if (m_readOnly || !m_store.hasVolume() || m_drag) return;
    const QPointF position = event->reason() == QContextMenuEvent::Keyboard && m_selected >= 0
                                 ? positionOf(tf().points[static_cast<std::size_t>(m_selected)].x,
                                              tf().points[static_cast<std::size_t>(m_selected)].opacity)
                                 : QPointF(event->pos());
    const int index = pointAt(position);
    QMenu menu(this);
    menu.setObjectName("tfContextMenu");
    if (index >= 0) {
        selectPoint(index);
        menu.addAction(tr("Colour…"), this, &TfCanvas::chooseColor);
        QAction* fixed = menu.addAction(tr("Fixed (refinement leaves it alone)"), this, &TfCanvas::toggleFixed);
        fixed->setCheckable(true);
        fixed->setChecked(tf().points[static_cast<std::size_t>(index)].fixed);
        menu.addSeparator();
        menu.addAction(tr("Remove point"), this, &TfCanvas::removeSelected);
    } else {
        menu.addAction(tr("Add point here"), this,
                       [this, position] { addPoint(intensityAt(position.x()), opacityAt(position.y())); });
    }
    menu.exec(mapToGlobal(position.toPoint()));
}

void TfCanvas::nudge(double dx, double dHeight) {
    if (m_readOnly || m_selected < 0) return;
    const ControlPoint& point = tf().points[static_cast<std::size_t>(m_selected)];
    const double opacity = dHeight == 0 ? point.opacity : opacityOfHeight(heightOfOpacity(point.opacity) + dHeight);
    editTf(m_store, withPointMoved(tf(), m_selected, point.x + dx, opacity), tr("Move point"),
           QStringLiteral("nudge-%1").arg(m_selected));
}

void TfCanvas::keyPressEvent(QKeyEvent* event) {
    const double step = event->modifiers().testFlag(Qt::ShiftModifier) ? 1.0 / 1024 : 1.0 / 128;
    const int count = static_cast<int>(tf().points.size());
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
        return nudge(-step, 0);
    case Qt::Key_Right:
        return nudge(step, 0);
    case Qt::Key_Up:
        return nudge(0, step);
    case Qt::Key_Down:
        return nudge(0, -step);
    case Qt::Key_PageDown:
        return selectPoint(count == 0 ? -1 : (m_selected + 1) % count);
    case Qt::Key_PageUp:
        return selectPoint(count == 0 ? -1 : (std::max(m_selected, 0) + count - 1) % count);
    case Qt::Key_Escape:
        if (m_drag) {
            m_drag.reset();
            m_store.cancel();
        } else {
            selectPoint(-1);
        }
        return;
    default:
        QWidget::keyPressEvent(event);
    }
}

void TfCanvas::leaveEvent(QEvent*) {
    m_hovered = -1;
    update();
}

bool TfCanvas::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip || !m_store.hasVolume()) return QWidget::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    const QPointF position = help->pos();
    QString text;
    if (const int index = pointAt(position); index >= 0) {
        const ControlPoint& p = tf().points[static_cast<std::size_t>(index)];
        text = tr("value %1, opacity %2%3\nopacity of a path one voxel long (d0)")
                   .arg(valueText(p.x), QString::number(p.opacity, 'g', 4), p.fixed ? tr(", fixed") : QString());
    } else if (const int feature = featureBarAt(position); feature >= 0) {
        const Feature& f = tf().features[static_cast<std::size_t>(feature)];
        text = tr("feature %1: values %2 to %3").arg(QString::fromStdString(f.name), valueText(f.a), valueText(f.b));
    } else if (plot().contains(position)) {
        text = tr("Grey: how many voxels have this value; line: how much of the picture they make (visibility)\n"
                  "Drag a point; double-click to add one; Enter colours, Delete removes, Space fixes it\n"
                  "Arrows move the point, Page Up and Down go to the next");
    }
    QToolTip::showText(help->globalPos(), text, this);
    return true;
}

void TfCanvas::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.fillRect(rect(), theme::kWindow);
    painter.fillRect(plot(), theme::kPanel);
    if (!m_store.hasVolume()) return;
    paintHistogram(painter);
    paintVisibility(painter);
    paintAxes(painter);
    paintFeatures(painter);
    for (const auto& layer : m_layers) layer->paint(painter, *this);
    paintCurve(painter);
    paintPoints(painter);
}

void TfCanvas::paintHistogram(QPainter& painter) const {
    if (!m_store.scene().histogram) return;
    const auto& counts = m_store.scene().histogram->counts;
    if (counts.empty()) return;
    const double most = static_cast<double>(*std::max_element(counts.begin(), counts.end()));
    if (most <= 0) return;
    const QRectF r = plot();
    const double n = static_cast<double>(counts.size());
    QPainterPath path(r.bottomLeft());
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double c = static_cast<double>(counts[i]);
        const double h = m_logHistogram ? std::log1p(c) / std::log1p(most) : c / most;
        const double y = r.bottom() - 0.94 * h * r.height();
        path.lineTo(r.left() + static_cast<double>(i) / n * r.width(), y);
        path.lineTo(r.left() + static_cast<double>(i + 1) / n * r.width(), y);
    }
    path.lineTo(r.bottomRight());
    path.closeSubpath();
    painter.fillPath(path, theme::kHistogram);
}

void TfCanvas::paintVisibility(QPainter& painter) const {
    const Measures* const measures = m_results.measures();
    if (measures == nullptr) return;
    const auto& shares = measures->visibilityHistogram;
    if (shares.empty()) return;
    const double most = *std::max_element(shares.begin(), shares.end());
    if (most <= 0) return;
    const QRectF r = plot();
    QPolygonF line;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(shares.size());
        line << QPointF(r.left() + x * r.width(), r.bottom() - 0.94 * shares[i] / most * r.height());
    }
    painter.setPen(QPen(translucent(theme::kCurve, m_results.measuresAreCurrent() ? 0.55 : 0.2), 1));
    painter.drawPolyline(line);
}

void TfCanvas::paintAxes(QPainter& painter) const {
    const QRectF r = plot();
    QFont small = font();
    small.setPointSizeF(small.pointSizeF() * 0.85);
    painter.setFont(small);
    const QFontMetricsF metrics(small);

    const ValueRange range = m_store.scene().volume->range();
    const double span = range.hi - range.lo;
    painter.setPen(theme::kFaint);
    const double labelTop = r.bottom() + kStrip + 6;
    if (span > 0) {
        for (const double value : axisTicks(range.lo, range.hi, std::max(2, static_cast<int>(r.width() / 80)))) {
            const double x = r.left() + (value - range.lo) / span * r.width();
            const QString text = numberText(value, span);
            const double w = metrics.horizontalAdvance(text);
            const double left = std::clamp(x - w / 2, 0.0, width() - w);
            painter.drawText(QRectF(left, labelTop, w + 2, metrics.height()), Qt::AlignLeft, text);
            painter.drawLine(QPointF(x, r.bottom() + kStrip + 2), QPointF(x, r.bottom() + kStrip + 5));
        }
    } else { // a constant volume has one value, which is intensity 0
        painter.drawText(QRectF(r.left(), labelTop, r.width(), metrics.height()), Qt::AlignLeft,
                         numberText(range.lo, 0));
    }

    const std::vector<double> opacities =
        m_rootOpacity ? std::vector<double>{0, 0.01, 0.05, 0.2, 0.5, 1} : std::vector<double>{0, 0.25, 0.5, 0.75, 1};
    for (const double opacity : opacities) {
        const double y = positionOf(0, opacity).y();
        painter.setPen(QPen(translucent(theme::kLine, 0.6), 1));
        painter.drawLine(QPointF(r.left(), y), QPointF(r.right(), y));
        painter.setPen(theme::kFaint);
        painter.drawText(QRectF(0, y - metrics.height() / 2, kLeft - 6, metrics.height()),
                         Qt::AlignRight | Qt::AlignVCenter, QString::number(opacity));
    }
    painter.drawText(QRectF(2, 2, kLeft + 10, metrics.height()), Qt::AlignLeft, tr("opacity"));
}

void TfCanvas::paintFeatures(QPainter& painter) const {
    const QRectF r = plot();
    QFont small = font();
    small.setPointSizeF(small.pointSizeF() * 0.82);
    painter.setFont(small);
    for (const Feature& f : tf().features) {
        const double left = positionOf(f.a, 0).x(), right = positionOf(f.b, 0).x();
        const QColor color = colorFromRgb(f.color);
        painter.fillRect(QRectF(left, r.top(), right - left, r.height()), translucent(color, 0.07));
        const QRectF bar(left, r.top() - kBar - 3, right - left, kBar);
        painter.setPen(Qt::NoPen);
        painter.setBrush(translucent(color, 0.85));
        painter.drawRoundedRect(bar, 3, 3);
        painter.setPen(qGray(color.rgb()) > 110 ? QColor(20, 20, 20) : QColor(Qt::white));
        const QString name =
            QFontMetricsF(small).elidedText(QString::fromStdString(f.name), Qt::ElideRight, bar.width() - 4);
        painter.drawText(bar, Qt::AlignCenter, name);
    }
}

void TfCanvas::paintCurve(QPainter& painter) const {
    const QRectF r = plot();
    const std::vector<ControlPoint> points = tf().pointsWithEnds();
    QPainterPath line;
    QLinearGradient gradient(r.left(), 0, r.right(), 0);
    QLinearGradient fill = gradient;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const QPointF here = positionOf(points[i].x, points[i].opacity);
        if (i == 0) {
            line.moveTo(here);
        } else if (m_rootOpacity && points[i].x > points[i - 1].x) { // a straight line of α is curved here
            constexpr int kPieces = 24;
            for (int k = 1; k <= kPieces; ++k) {
                const double t = static_cast<double>(k) / kPieces;
                line.lineTo(positionOf(points[i - 1].x + t * (points[i].x - points[i - 1].x),
                                       points[i - 1].opacity + t * (points[i].opacity - points[i - 1].opacity)));
            }
        } else {
            line.lineTo(here);
        }
        gradient.setColorAt(std::clamp(points[i].x, 0.0, 1.0), colorFromRgb(points[i].color));
        fill.setColorAt(std::clamp(points[i].x, 0.0, 1.0), translucent(colorFromRgb(points[i].color), 0.3));
    }
    QPainterPath area = line;
    area.lineTo(r.bottomRight());
    area.lineTo(r.bottomLeft());
    area.closeSubpath();
    painter.fillPath(area, fill);
    painter.strokePath(line, QPen(theme::kCurve, 1.6));
    painter.fillRect(QRectF(r.left(), r.bottom() + 3, r.width(), kStrip - 2), gradient);
}

void TfCanvas::paintPoints(QPainter& painter) const {
    const auto& points = tf().points;
    const auto paintOne = [&](std::size_t i) {
        const ControlPoint& p = points[i];
        const QPointF c = positionOf(p.x, p.opacity);
        const bool selected = static_cast<int>(i) == m_selected;
        const double radius = kRadius + (selected || static_cast<int>(i) == m_hovered ? 1.5 : 0.0);
        if (selected) {
            painter.setPen(Qt::NoPen);
            painter.setBrush(translucent(theme::kAccent, 0.5));
            painter.drawEllipse(c, radius + 4, radius + 4);
        }
        painter.setPen(QPen(m_readOnly ? theme::kFaint : theme::kKnob, 1.5));
        painter.setBrush(colorFromRgb(p.color));
        if (p.fixed) { // squares stay put in refinement
            painter.drawRect(QRectF(c.x() - radius + 1, c.y() - radius + 1, 2 * radius - 2, 2 * radius - 2));
        } else {
            painter.drawEllipse(c, radius, radius);
        }
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (static_cast<int>(i) != m_selected) paintOne(i);
    }
    if (m_selected >= 0) paintOne(static_cast<std::size_t>(m_selected));
}

} // namespace pellucid::gui
