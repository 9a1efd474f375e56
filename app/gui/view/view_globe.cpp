#include "view/view_globe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <QApplication>
#include <QMouseEvent>
#include <QPainter>

#include <glm/geometric.hpp>

#include "render/view_direction.h"
#include "tf/color_maps.h"
#include "view/camera_hand.h"
#include "widgets/controls.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kColumns = 192, kRows = 96; ///< of the table
constexpr int kMargin = 8;                ///< around the sphere
constexpr int kLegend = 26;               ///< height below it
constexpr double kPale = 0.7;             ///< of the panel's colour in that of an older state

const std::array<QRgb, 256>& colors() {
    static const std::array<QRgb, 256> s_colors = [] {
        std::array<QRgb, 256> all{};
        const ColorMap& map = colorMapNamed("ember");
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] = colorFromRgb(pellucid::colorOf(map, static_cast<double>(i) / 255)).rgb();
        return all;
    }();
    return s_colors;
}

QColor mixed(const QColor& a, const QColor& b, double share) {
    const auto part = [share](int x, int y) { return static_cast<int>(std::lround(x + share * (y - x))); };
    return {part(a.red(), b.red()), part(a.green(), b.green()), part(a.blue(), b.blue())};
}

} // namespace

ViewGlobe::ViewGlobe(QWidget* parent) : QWidget(parent), Spoken(*this, QAccessible::Graphic) {
    setObjectName("viewGlobe");
    setAccessibleName(tr("Sphere of views"));
    setMouseTracking(true);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void ViewGlobe::setMap(const ViewMap& map, bool current, const std::optional<Vec3>& best) {
    m_current = current;
    m_bestDirection = best;
    update();
    if (map.metric == m_map.metric && map.values == m_map.values) return;
    m_map = map;
    m_table.clear();
    if (m_map.isEmpty()) return;
    m_best = m_map.values[m_map.best()];
    m_worst = m_map.values[m_map.worst()];
    m_table.resize(kColumns * kRows);
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const ViewAngles angles{360.0 * (column + 0.5) / kColumns - 180, 90 - 180.0 * (row + 0.5) / kRows, 1};
            m_table[static_cast<std::size_t>(row * kColumns + column)] =
                static_cast<float>(m_map.interpolated(towardEye(angles)));
        }
}

void ViewGlobe::setCamera(const Camera& camera, WorldAxes axes) {
    if (camera == m_camera && axes == m_worldAxes) return;
    m_camera = camera;
    m_worldAxes = axes;
    update();
}

QPointF ViewGlobe::middle() const { return {width() / 2.0, (height() - kLegend) / 2.0}; }

double ViewGlobe::radius() const { return std::max(8.0, std::min(width(), height() - kLegend) / 2.0 - kMargin); }

std::optional<Vec3> ViewGlobe::directionAt(const QPointF& point) const {
    const QPointF p = (point - middle()) / radius();
    const double square = p.x() * p.x() + p.y() * p.y();
    if (square > 1) return {};
    return glm::normalize(p.x() * m_camera.right() - p.y() * m_camera.trueUp() -
                          std::sqrt(1 - square) * m_camera.forward());
}

std::optional<QPointF> ViewGlobe::pointOf(const Vec3& direction) const {
    if (glm::dot(direction, m_camera.forward()) > 0) return {};
    return middle() +
           radius() * QPointF(glm::dot(direction, m_camera.right()), -glm::dot(direction, m_camera.trueUp()));
}

double ViewGlobe::valueAt(const Vec3& direction) const {
    const double column = (std::atan2(direction.x, -direction.y) / (2 * kPi) + 0.5) * kColumns - 0.5;
    const double row = (0.5 - std::asin(std::clamp(direction.z, -1.0, 1.0)) / kPi) * kRows - 0.5;
    const int c = static_cast<int>(std::floor(column)), r = static_cast<int>(std::floor(row));
    const double u = column - c, v = row - r;
    const auto at = [&](int i, int j) {
        i = (i + kColumns) % kColumns;
        j = std::clamp(j, 0, kRows - 1);
        return static_cast<double>(m_table[static_cast<std::size_t>(j * kColumns + i)]);
    };
    return (1 - v) * ((1 - u) * at(c, r) + u * at(c + 1, r)) + v * ((1 - u) * at(c, r + 1) + u * at(c + 1, r + 1));
}

QColor ViewGlobe::colorOf(double value) const {
    const double t = m_best == m_worst ? 1 : std::clamp((value - m_worst) / (m_best - m_worst), 0.0, 1.0);
    const QColor color(colors()[static_cast<std::size_t>(std::lround(255 * t))]);
    return m_current ? color : mixed(color, theme::kPanel, kPale);
}

void ViewGlobe::paintSphere(QPainter& painter) const {
    const double density = devicePixelRatioF(), r = radius();
    const int size = static_cast<int>(std::ceil(2 * r * density));
    QImage image(size, size, QImage::Format_ARGB32_Premultiplied);
    image.fill(Qt::transparent);
    const Vec3 right = m_camera.right(), up = m_camera.trueUp(), toward = -m_camera.forward();
    const QColor none = theme::kTrack;
    for (int y = 0; y < size; ++y) {
        auto* line = reinterpret_cast<QRgb*>(image.scanLine(y));
        for (int x = 0; x < size; ++x) {
            const double px = 2 * (x + 0.5) / size - 1, py = 1 - 2 * (y + 0.5) / size;
            const double square = px * px + py * py;
            if (square > 1) continue;
            const double depth = std::sqrt(1 - square);
            const QColor c = m_table.empty() ? none : colorOf(valueAt(px * right + py * up + depth * toward));
            const double light = 0.8 + 0.2 * depth; // a little rounder, without changing what colours say
            line[x] = qRgb(static_cast<int>(c.red() * light), static_cast<int>(c.green() * light),
                           static_cast<int>(c.blue() * light));
        }
    }
    painter.drawImage(QRectF(middle() - QPointF(r, r), QSizeF(2 * r, 2 * r)), image);
    painter.setPen(QPen(theme::kLine, 1.5));
    painter.setBrush(Qt::NoBrush);
    painter.drawEllipse(middle(), r, r);
}

void ViewGlobe::paintMarks(QPainter& painter) const {
    const auto edged = [&](const QColor& color, const auto& draw) {
        painter.setPen(QPen(QColor(0, 0, 0, 170), 3.5));
        draw();
        painter.setPen(QPen(color, 1.5));
        draw();
    };
    // Where the axes of the world come out.
    const QStringList letters = m_worldAxes == WorldAxes::Patient
                                    ? QStringList{tr("L"), tr("R"), tr("P"), tr("A"), tr("S"), tr("I")}
                                    : QStringList{"x", "−x", "y", "−y", "z", "−z"};
    QFont font = painter.font();
    font.setPointSizeF(font.pointSizeF() * 0.85);
    painter.setFont(font);
    for (int n = 0; n < 6; ++n) {
        Vec3 direction(0);
        direction[n / 2] = n % 2 == 0 ? 1 : -1;
        if (const auto at = pointOf(direction); at && glm::dot(direction, m_camera.forward()) < -0.1) {
            const QRectF box(*at - QPointF(14, 9), QSizeF(28, 18));
            painter.setPen(QColor(0, 0, 0, 190));
            painter.drawText(box.translated(1, 1), Qt::AlignCenter, letters[n]);
            painter.setPen(QColor(255, 255, 255, 220));
            painter.drawText(box, Qt::AlignCenter, letters[n]);
        }
    }
    painter.setBrush(Qt::NoBrush);
    const QPointF m = middle();
    edged(theme::kMark, [&] { // from here
        for (const QPointF& way : {QPointF(-1, 0), QPointF(1, 0), QPointF(0, -1), QPointF(0, 1)})
            painter.drawLine(m + 2 * way, m + 6 * way);
    });
    if (!m_bestDirection || !m_current) return;
    if (const auto at = pointOf(*m_bestDirection)) {
        edged(theme::kMarkAccent, [&] { painter.drawEllipse(*at, 6.0, 6.0); });
        return;
    }
    // On the far side: a mark at the rim, on the shortest way there.
    QPointF way(glm::dot(*m_bestDirection, m_camera.right()), -glm::dot(*m_bestDirection, m_camera.trueUp()));
    const double length = std::hypot(way.x(), way.y());
    way = length > 1e-9 ? way / length : QPointF(1, 0);
    const QPointF side(-way.y(), way.x()), tip = m + (radius() + 6) * way;
    painter.setPen(QPen(QColor(0, 0, 0, 170), 1));
    painter.setBrush(theme::kMarkAccent);
    painter.drawPolygon(QPolygonF({tip, tip - 9 * way + 5 * side, tip - 9 * way - 5 * side}));
}

void ViewGlobe::paintLegend(QPainter& painter) const {
    const QRectF all(kMargin, height() - kLegend, width() - 2 * kMargin, kLegend);
    const QRectF bar(all.left(), all.top() + 2, all.width(), 7);
    for (int x = 0; x < static_cast<int>(bar.width()); ++x) {
        const double t = (x + 0.5) / bar.width();
        painter.fillRect(QRectF(bar.left() + x, bar.top(), 1, bar.height()),
                         m_table.empty() ? theme::kTrack : colorOf(m_worst + t * (m_best - m_worst)));
    }
    if (m_table.empty()) return;
    painter.setPen(m_current ? theme::kText : theme::kFaint);
    const QRectF words(all.left(), bar.bottom(), all.width(), all.bottom() - bar.bottom());
    const auto about = [](double value) { return QStringLiteral("≈ %1").arg(value, 0, 'f', 2); };
    painter.drawText(words, Qt::AlignLeft | Qt::AlignVCenter, about(m_worst));
    painter.drawText(words, Qt::AlignRight | Qt::AlignVCenter, about(m_best));
    const QString name =
        m_map.metric.figure == ViewMetric::Figure::Objective ? terms().distance() : terms().attention();
    painter.drawText(words, Qt::AlignCenter, name);
}

void ViewGlobe::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    paintSphere(painter);
    paintLegend(painter);
    paintMarks(painter);
}

QString ViewGlobe::spokenValue() const {
    const Vec3 toward = -m_camera.forward();
    QStringList parts{m_words ? m_words(toward).replace('\n', ", ") : anglesText(anglesOf(toward))};
    if (m_bestDirection && m_current) parts << tr("best so far: %1").arg(anglesText(anglesOf(*m_bestDirection)));
    return parts.join("; ");
}

bool ViewGlobe::event(QEvent* event) {
    const auto tip = [this](const QPoint& point) {
        const auto direction = directionAt(point);
        return direction && m_words ? m_words(*direction) : QString();
    };
    return showsTip(*event, *this, tip) || QWidget::event(event);
}

void ViewGlobe::hover(const QPointF& point) {
    const auto direction = directionAt(point);
    if (!direction) return endHover();
    m_hovering = true;
    Q_EMIT hovered(*direction);
}

void ViewGlobe::endHover() {
    if (std::exchange(m_hovering, false)) Q_EMIT left();
}

void ViewGlobe::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !directionAt(event->position())) return event->ignore();
    m_pressed = true;
    m_dragging = false;
    m_from = m_last = event->position();
}

void ViewGlobe::mouseMoveEvent(QMouseEvent* event) {
    if (!m_pressed) return hover(event->position());
    if (!m_dragging && (event->position() - m_from).manhattanLength() < QApplication::startDragDistance()) return;
    if (!m_dragging) {
        m_dragging = true;
        endHover();
        Q_EMIT dragBegan();
    }
    const QPointF way = (event->position() - m_last) / radius();
    m_last = event->position();
    Q_EMIT dragged(way);
}

void ViewGlobe::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !m_pressed) return;
    m_pressed = false;
    if (std::exchange(m_dragging, false)) return;
    const auto direction = directionAt(m_from);
    m_hovering = false; // what was a glimpse stays
    if (direction) Q_EMIT chosen(*direction);
}

void ViewGlobe::leaveEvent(QEvent* event) {
    endHover();
    QWidget::leaveEvent(event);
}

} // namespace pellucid::gui
