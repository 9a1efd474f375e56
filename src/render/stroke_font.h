// Letters made of lines: the same on every machine and in every painter, without a font file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "volume/grid.h"

namespace pellucid {

using Polyline = std::vector<Vec2>;

/// Middle lines of the strokes of a text, in heights of a capital: x from the text's left end, y upward from its
/// baseline. UTF-8; it has ASCII, the letters of western Europe and some signs, and draws a box for any other
/// character.
std::vector<Polyline> textStrokes(std::string_view utf8);

/// Its width, in heights of a capital.
double textWidth(std::string_view utf8);

/// `utf8` cut so that it is not wider than `most` heights of a capital, with "…" at its end where it was.
std::string shortenedText(std::string_view utf8, double most);

} // namespace pellucid
