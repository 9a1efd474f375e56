// Marks over a picture, as Qt draws them.
#pragma once

#include "render/annotation.h"

class QPainter;

namespace pellucid::gui {

/// One of annotationMarks() and their like; `painter` is of the picture's pixels.
void drawMark(QPainter& painter, const Mark& mark);

} // namespace pellucid::gui
