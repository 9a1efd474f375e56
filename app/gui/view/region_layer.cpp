#include "view/region_layer.h"

#include <algorithm>
#include <cmath>

#include <QPainter>

#include "controllers/refine_controller.h"
#include "services/services.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kReach = 8;    // pixels from a corner or an edge at which it is taken
constexpr double kSmallest = 4; // pixels: what is smaller was a click
constexpr double kStride = 3;   // pixels between corners of a lasso
constexpr std::size_t kMostCorners = 2000;

using Selecting = RefineController::Selecting;

glm::dvec2 fractionOf(const QPointF& point, const QSizeF& size) {
    return {std::clamp(point.x() / std::max(1.0, size.width()), 0.0, 1.0),
            std::clamp(point.y() / std::max(1.0, size.height()), 0.0, 1.0)};
}

QPolygonF polygonOf(const ImageRegion& region, const QSizeF& size) {
    QPolygonF polygon;
    for (const glm::dvec2& corner : region.outline)
        polygon << QPointF(corner.x * size.width(), corner.y * size.height());
    return polygon;
}

ImageRegion rectangle(const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 lo = glm::min(a, b), hi = glm::max(a, b);
    return {{lo, {hi.x, lo.y}, hi, {lo.x, hi.y}}};
}

bool isRectangle(const ImageRegion& region) {
    return region.outline.size() == 4 && region == rectangle(region.outline[0], region.outline[2]);
}

/// Moved as far as it stays in the picture.
ImageRegion moved(ImageRegion region, glm::dvec2 by) {
    glm::dvec2 lo(1), hi(0);
    for (const glm::dvec2& corner : region.outline) {
        lo = glm::min(lo, corner);
        hi = glm::max(hi, corner);
    }
    by = glm::clamp(by, -lo, 1.0 - hi);
    for (glm::dvec2& corner : region.outline) corner = glm::clamp(corner + by, 0.0, 1.0);
    return region;
}

} // namespace

RegionLayer::RegionLayer(Services& services, RefineController& refining, QWidget& overlay)
    : m_services(services), m_refining(refining), m_overlay(overlay) {
    for (const auto changed : {&RefineController::busyChanged, &RefineController::selectingChanged})
        QObject::connect(&refining, changed, &overlay, qOverload<>(&QWidget::update));
}

RegionLayer::Hold RegionLayer::holdAt(const QPointF& point, const LayerView& view) const {
    if (m_services.isReadOnly()) return {};
    const std::optional<ImageRegion> region = m_refining.region();
    if (m_refining.selecting() != Selecting::Nothing) return {Grip::Draw}; // over an older one too
    if (!region) return {};
    const QRectF r = polygonOf(*region, view.size).boundingRect();
    if (isRectangle(*region) && r.adjusted(-kReach, -kReach, kReach, kReach).contains(point)) {
        const auto side = [](double at, double lo, double hi) {
            if (std::abs(at - hi) <= kReach) return 1;
            return std::abs(at - lo) <= kReach ? -1 : 0;
        };
        const Hold hold{Grip::Resize, side(point.x(), r.left(), r.right()), side(point.y(), r.top(), r.bottom())};
        if (hold.right != 0 || hold.down != 0) return hold;
    }
    const glm::dvec2 at = fractionOf(point, view.size);
    return {region->contains(at.x, at.y) ? Grip::Move : Grip::None};
}

Qt::CursorShape RegionLayer::cursorAt(const QPointF& point, const LayerView& view) {
    const Hold hold = holdAt(point, view);
    if (hold.grip == Grip::None) return Qt::ArrowCursor;
    if (hold.grip == Grip::Draw) return Qt::CrossCursor;
    if (hold.grip == Grip::Move) return Qt::SizeAllCursor;
    if (hold.right == 0) return Qt::SizeVerCursor;
    if (hold.down == 0) return Qt::SizeHorCursor;
    return hold.right == hold.down ? Qt::SizeFDiagCursor : Qt::SizeBDiagCursor;
}

bool RegionLayer::press(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) {
    if (keys != Qt::NoModifier) return false; // the view is panned, the light turned, whatever is selected
    const Hold hold = holdAt(point, view);
    if (hold.grip == Grip::None) return false;
    m_hold = hold;
    m_from = point;
    m_size = view.size;
    m_start = hold.grip == Grip::Draw ? ImageRegion() : *m_refining.region();
    m_region = hold.grip == Grip::Draw ? ImageRegion{{fractionOf(point, m_size)}} : m_start;
    return true;
}

void RegionLayer::drag(const QPointF& point, Qt::KeyboardModifiers, const LayerView&) {
    if (!m_region) return;
    const glm::dvec2 from = fractionOf(m_from, m_size), to = fractionOf(point, m_size);
    const auto& start = m_start.outline;
    if (m_hold.grip == Grip::Draw && m_refining.selecting() == Selecting::Rectangle) {
        m_region = rectangle(from, to);
    } else if (m_hold.grip == Grip::Draw) {
        const glm::dvec2 last = m_region->outline.back();
        if (std::hypot((to.x - last.x) * m_size.width(), (to.y - last.y) * m_size.height()) >= kStride &&
            m_region->outline.size() < kMostCorners)
            m_region->outline.push_back(to);
    } else if (m_hold.grip == Grip::Move) {
        m_region =
            moved(m_start, {(point.x() - m_from.x()) / m_size.width(), (point.y() - m_from.y()) / m_size.height()});
    } else {
        const glm::dvec2 by = to - from;
        glm::dvec2 lo = start[0], hi = start[2];
        if (m_hold.right < 0) lo.x += by.x;
        if (m_hold.right > 0) hi.x += by.x;
        if (m_hold.down < 0) lo.y += by.y;
        if (m_hold.down > 0) hi.y += by.y;
        m_region = rectangle(glm::clamp(lo, 0.0, 1.0), glm::clamp(hi, 0.0, 1.0));
    }
    m_overlay.update();
}

void RegionLayer::end(bool kept) {
    const Grip grip = std::exchange(m_hold, {}).grip;
    const std::optional<ImageRegion> region = std::exchange(m_region, {});
    m_overlay.update();
    if (!kept || !region || m_services.isReadOnly()) return;
    const QRectF bounds = polygonOf(*region, m_size).boundingRect();
    const bool click = region->outline.size() < 3 || bounds.width() < kSmallest || bounds.height() < kSmallest;
    if (click || *region == m_start) return;
    m_refining.prioritize(*region,
                          grip == Grip::Draw ? QObject::tr("Refine for a region") : QObject::tr("Change region"));
    if (grip == Grip::Draw) m_refining.setSelecting(Selecting::Nothing); // the mouse turns the volume again
}

bool RegionLayer::key(int key, const LayerView&) {
    if (key == Qt::Key_Escape && m_refining.selecting() != Selecting::Nothing) {
        m_refining.setSelecting(Selecting::Nothing);
        return true;
    }
    const bool removes = key == Qt::Key_Escape || key == Qt::Key_Delete || key == Qt::Key_Backspace;
    if (!removes || m_services.isReadOnly() || !m_refining.region()) return false;
    m_refining.prioritizeNothing();
    return true;
}

void RegionLayer::paint(QPainter& painter, const LayerView& view) {
    const std::optional<ImageRegion> region = m_region ? m_region : m_refining.region();
    if (!region) return;
    const QPolygonF outline = polygonOf(*region, view.size);
    painter.setBrush(QColor(255, 255, 255, m_region ? 30 : 14));
    painter.setPen(QPen(QColor(0, 0, 0, 160), 3));
    painter.drawPolygon(outline);
    painter.setBrush(Qt::NoBrush);
    QPen pen(QColor(Qt::white), 1.3);
    pen.setDashPattern({4, 3});
    painter.setPen(pen);
    painter.drawPolygon(outline);
    if (!isRectangle(*region)) return;
    const QRectF r = outline.boundingRect();
    painter.setPen(QPen(QColor(0, 0, 0, 170), 1));
    painter.setBrush(theme::kMarkAccent);
    for (const double x : {r.left(), r.center().x(), r.right()})
        for (const double y : {r.top(), r.center().y(), r.bottom()})
            if (x != r.center().x() || y != r.center().y()) painter.drawRect(QRectF(x - 3.5, y - 3.5, 7, 7));
}

} // namespace pellucid::gui
