// A padlock, as small as a letter.
#pragma once

#include <QPainter>
#include <QPainterPath>

namespace pellucid::gui {

/// Closed, or open with its shackle up; 9 × 12 pixels about `center`.
inline void paintLock(QPainter& painter, const QPointF& center, bool closed, const QColor& color) {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF body(center.x() - 4.5, center.y() - 0.5, 9, 6.5);
    QPainterPath shackle(QPointF(body.left() + 1.8, body.top()));
    const double top = body.top() - (closed ? 1.5 : 3.5);
    shackle.lineTo(body.left() + 1.8, top);
    shackle.arcTo(QRectF(body.left() + 1.8, top - 2.7, 5.4, 5.4), 180, -180);
    if (closed) shackle.lineTo(body.right() - 1.8, body.top());
    painter.setPen(QPen(color, 1.4));
    painter.setBrush(Qt::NoBrush);
    painter.drawPath(shackle);
    painter.setPen(Qt::NoPen);
    painter.setBrush(color);
    painter.drawRoundedRect(body, 1.5, 1.5);
    painter.restore();
}

} // namespace pellucid::gui
