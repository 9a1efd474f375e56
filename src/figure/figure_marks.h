// What stands over a picture (render/annotation.h), as parts of a figure.
#pragma once

#include <vector>

#include "figure/figure.h"
#include "render/annotation.h"

namespace pellucid {

/// Marks of a picture whose pixels are `mmPerPixel` wide and whose top left corner is at `corner`, in order. Texts are
/// set in `font`, each in the middle of where its own strokes would be. Throws as extentOf() does.
std::vector<FigureElement> figureElements(const std::vector<Mark>& marks, double mmPerPixel, const Vec2& corner,
                                          const std::string& font);
/// The bar of part Scale among them; empty: there is none.
std::optional<FigureScale> scaleOf(const std::vector<Mark>& marks, double mmPerPixel);

} // namespace pellucid
