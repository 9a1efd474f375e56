#include "view/ruler_layer.h"

#include <cmath>

#include <QPainter>

#include "controllers/ruler_controller.h"
#include "render/mark_maker.h"
#include "widgets/mark_painter.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kReach = 8;          // pixels from a handle at which it is taken
constexpr double kHandleRadius = 4.5; // of a handle
constexpr int kHintTop = 14;          // of the hint, below the letter at the upper edge

/// What to do next, in the middle above.
void paintHint(QPainter& painter, const QString& text, double width, double top) {
    const QFontMetricsF metrics(painter.font());
    const QSizeF size(metrics.horizontalAdvance(text) + 20, metrics.height() + 10);
    const QRectF box(QPointF((width - size.width()) / 2, top), size);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(0, 0, 0, 190));
    painter.drawRoundedRect(box, 5, 5);
    painter.setPen(theme::kMark);
    painter.drawText(box, Qt::AlignCenter, text);
}

} // namespace

void RulerHand::paint(QPainter& painter, const std::vector<Mark>& marks,
                      const std::vector<RulerHandle>& handles) const {
    for (const Mark& mark : marks) drawMark(painter, mark);
    for (const RulerHandle& handle : handles) {
        const bool isActive = m_held      ? handle.number == m_held->number && handle.part == m_held->part
                              : m_hovered ? handle.number == m_hovered->number && handle.part == m_hovered->part
                                          : false;
        if (handle.number != m_rulers.selected() && !isActive) continue;
        painter.setPen(QPen(QColor(0, 0, 0, 170), 2.5));
        painter.setBrush(isActive ? theme::kMarkAccent.lighter(130) : theme::kMarkAccent);
        const double radius = isActive ? kHandleRadius + 1.5 : kHandleRadius;
        painter.drawEllipse(QPointF(handle.at.x, handle.at.y), radius, radius);
        painter.setPen(QPen(Qt::white, 1.2));
        painter.setBrush(Qt::NoBrush);
        painter.drawEllipse(QPointF(handle.at.x, handle.at.y), radius, radius);
    }
}

bool RulerHand::hover(const std::vector<RulerHandle>& handles, const QPointF& point) {
    const std::optional<RulerHandle> before = m_hovered;
    m_hovered.reset();
    double nearest = kReach;
    for (const RulerHandle& handle : handles) {
        const double distance = std::hypot(handle.at.x - point.x(), handle.at.y - point.y());
        if (distance > nearest) continue;
        nearest = distance;
        m_hovered = handle;
    }
    const auto isSame = [](const RulerHandle& a, const RulerHandle& b) {
        return a.number == b.number && a.part == b.part;
    };
    return before.has_value() != m_hovered.has_value() || (before && !isSame(*before, *m_hovered));
}

bool RulerHand::press(const std::vector<RulerHandle>& handles, const QPointF& point) {
    hover(handles, point);
    const Ruler* const ruler = m_hovered ? m_rulers.find(m_hovered->number) : nullptr;
    if (ruler == nullptr) return false;
    m_held = m_hovered;
    m_start = *ruler;
    m_rulers.select(m_start.number);
    return true;
}

void RulerHand::drag(const Vec3& world) { m_rulers.preview(withHandleAt(m_start, *m_held, world)); }

void RulerHand::end(bool kept, SessionStore& store) {
    m_held.reset();
    kept ? store.commit() : store.cancel();
}

bool RulerHand::key(int key) {
    if (key == Qt::Key_Escape && m_rulers.placing()) {
        m_rulers.giveUp();
        return true;
    }
    if ((key != Qt::Key_Delete && key != Qt::Key_Backspace) || m_rulers.find(m_rulers.selected()) == nullptr)
        return false;
    m_rulers.remove(m_rulers.selected());
    return true;
}

RulerLayer::RulerLayer(RulerController& rulers, SessionStore& store, QWidget& overlay)
    : m_rulers(rulers), m_store(store), m_overlay(overlay), m_hand(rulers) {
    QObject::connect(&rulers, &RulerController::changed, &overlay, qOverload<>(&QWidget::update));
}

std::vector<RulerHandle> RulerLayer::handles(const LayerView& view) const {
    return rulerHandles(m_rulers.draggable(), view.picture());
}

std::optional<Vec3> RulerLayer::placeAt(const QPointF& point, const LayerView& view) const {
    if (const auto center = m_rulers.center()) return besideInView(view.picture(), *center, {point.x(), point.y()});
    return m_rulers.seenAt(view.scene.camera, point, view.size);
}

void RulerLayer::paint(QPainter& painter, const LayerView& view) {
    const PictureView picture = view.picture();
    const double cap = MarkMaker(picture.width, picture.height, 1, {}).capHeight;
    m_hand.paint(painter, rulerMarks(m_rulers.shown(), picture, {1, cap}), handles(view));
    if (m_rulers.placing()) paintHint(painter, m_rulers.hint(), view.size.width(), kHintTop + 2 * cap);
}

Qt::CursorShape RulerLayer::cursorAt(const QPointF& point, const LayerView& view) {
    if (m_rulers.placing()) {
        m_rulers.pointAt(placeAt(point, view));
        return Qt::CrossCursor;
    }
    if (m_hand.hover(handles(view), point)) m_overlay.update();
    return m_hand.isOver() ? Qt::OpenHandCursor : Qt::ArrowCursor;
}

bool RulerLayer::press(const QPointF& point, Qt::KeyboardModifiers keys, const LayerView& view) {
    if (keys != Qt::NoModifier || m_rulers.placing() || !m_hand.press(handles(view), point)) return false;
    m_store.commit();
    return true;
}

void RulerLayer::drag(const QPointF& point, Qt::KeyboardModifiers, const LayerView& view) {
    const Ruler& start = m_hand.start();
    const RulerHandle& held = m_hand.held();
    const PictureView picture = view.picture();
    const PixelPoint to{point.x(), point.y()};
    Vec3 world = besideInView(picture, held.world, to);
    if (start.kind == RulerKind::Distance || start.kind == RulerKind::Angle)
        world = m_rulers.seenAt(view.scene.camera, point, view.size).value_or(world);
    if (start.kind == RulerKind::Sphere && held.part == 1) world = besideInView(picture, start.points[0], to);
    if (start.kind == RulerKind::Box && held.part > 0) { // a face, along its axis
        Vec3 along(0);
        along[(held.part - 1) / 2] = 1;
        world = held.world + along * draggedAlong(picture, held.world, along, held.at, to);
    }
    m_hand.drag(world);
}

void RulerLayer::end(bool kept) {
    m_hand.end(kept, m_store);
    m_overlay.update();
}

bool RulerLayer::key(int key, const LayerView&) { return m_hand.key(key); }

bool RulerLayer::wantsClicks() const { return m_rulers.placing().has_value(); }

void RulerLayer::click(const QPointF& point, const LayerView& view) {
    if (const auto world = placeAt(point, view)) return m_rulers.addPoint(*world);
    m_rulers.sayNothingSeen();
}

} // namespace pellucid::gui
