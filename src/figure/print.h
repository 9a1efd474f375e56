// Letters and PDF files, by the library that print_library.h describes. All functions throw FileError where it is not
// installed, and Error for what it cannot do.
#pragma once

#include <string>
#include <vector>

#include "figure/print_library.h"

namespace pellucid {

/// How much room a text takes on the page, whatever its across and up are.
TextExtent extentOf(const FigureText& text, const std::string& font);
/// The attribute `d` of an SVG path around its letters, as they lie on the page.
std::string outlineOf(const FigureText& text, const std::string& font);
/// One page with pictures inside, and with the letters that it needs of its fonts. The same figure has the same bytes.
std::string pdfOf(const Figure& figure);
/// As it looks on white paper, `width` pixels wide.
Image rasterOf(const Figure& figure, int width);
/// The names of the font that letters of these families have, the usual one first.
std::vector<std::string> familyOf(const std::string& font);

} // namespace pellucid
