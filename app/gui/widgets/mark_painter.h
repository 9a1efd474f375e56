// Marks over a picture, as Qt draws them.
#pragma once

#include <QImage>

#include "render/annotation.h"

class QPainter;

namespace pellucid::gui {

/// One of annotationMarks() and their like; `painter` is of the picture's pixels.
void drawMark(QPainter& painter, const Mark& mark);

/// Draws marks again and again while a picture turns. Those that stay the same are stroked once.
class MarkPainter {
public:
    /// As drawMark() does each of them.
    void draw(QPainter& painter, const std::vector<Mark>& marks);

private:
    struct Drawn {
        Mark mark;
        QImage image = {}; ///< of it; null: so far it has been drawn once
        QPointF corner = {};
    };
    std::vector<Drawn> m_last;
    qreal m_ratio = 0; ///< of the images, to pixels of the picture
};

} // namespace pellucid::gui
