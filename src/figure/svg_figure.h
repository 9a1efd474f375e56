// Figures as SVG.
#pragma once

#include <string>

#include "figure/figure.h"

namespace pellucid {

/// Nothing but the text: the picture is in it as PNG, letters are outlines and need no font, and what they say stands
/// beside them for screen readers. Each group of the figure is one of the drawing. Throws as outlineOf() does.
std::string svgOf(const Figure& figure);

} // namespace pellucid
