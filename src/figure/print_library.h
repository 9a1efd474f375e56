// What sets letters and writes PDF: a library of its own, loaded when the first figure is made. It is linked with Pango
// and Cairo, which bring fonts and the libraries of X11 along, so that no other command needs them.
#pragma once

#include <string>
#include <vector>

#include "figure/figure.h"

namespace pellucid {

/// How much room a text takes, millimetres.
struct TextExtent {
    double width = 0, height = 0; ///< of its widest line; of all lines
    double baseline = 0;          ///< of the first line, below its top
    double capital = 0;           ///< height of an H
};

/// The functions return what went wrong; empty: nothing. From any thread.
struct PrintLibrary {
    /// Of a text that lies straight, whatever its across and up are.
    std::string (*measure)(const FigureText& text, const std::string& font, TextExtent& extent);
    /// The outlines of its letters on the page, as the attribute `d` of an SVG path.
    std::string (*outline)(const FigureText& text, const std::string& font, std::string& path);
    std::string (*pdf)(const Figure& figure, std::string& bytes);
    /// On white paper. `image` has its size already.
    std::string (*raster)(const Figure& figure, Image& image);
    /// The names of the font that is taken where these families are asked for, the usual one first; none: there is no
    /// font at all.
    std::string (*family)(const std::string& font, std::vector<std::string>& names);
};

/// The name under which the library has them: a function without arguments that returns `const PrintLibrary*`.
inline constexpr const char* kPrintLibrarySymbol = "pellucidPrintLibrary";

} // namespace pellucid
