// A figure for print as data: what lies where on the page. Lengths are millimetres from the top left corner, y down.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/color.h"
#include "base/image.h"
#include "render/mark_maker.h"

namespace pellucid {

inline constexpr double kMmPerInch = 25.4, kMmPerPoint = kMmPerInch / 72;

/// Through its points, with round ends.
struct FigureLine {
    std::vector<Vec2> points = {};
    Rgb color = {};
    double width = 0.1, alpha = 1;
};

/// A colour at a place of a gradient, [0,1] from left to right.
struct FigureStop {
    double at = 0;
    Rgb color = {};
};

/// A polygon, in one colour or in those of its stops.
struct FigureArea {
    std::vector<Vec2> corners = {};
    Rgb color = {};
    double alpha = 1;
    std::vector<FigureStop> stops = {}; ///< in order; empty: `color`
};

struct FigureText {
    std::string text = {}; ///< printable() UTF-8
    Vec2 at{0, 0};         ///< start, middle or end of the baseline of its first line
    double points = 7;     ///< size of the font
    Align align = Align::Start;
    bool bold = false;
    Rgb color = {};
    double alpha = 1;
    double width = 0; ///< what is wider goes on in the next line; 0: as wide as it is, in one line
    int lines = 1;    ///< at most so many, with "…" at the end of what is cut; 0: as many as it takes
    double halo = 0;  ///< how far a rim of `haloColor` reaches around the letters; 0: none
    Rgb haloColor = {};
    Vec2 across{1, 0}, up{0, -1}; ///< along the line and upward: as long as 1 of the text is on the page
};

struct FigurePicture {
    Vec2 at{0, 0};
    double width = 0, height = 0;
    std::shared_ptr<const Image> image;
};

using FigureElement = std::variant<FigurePicture, FigureArea, FigureLine, FigureText>;

/// What belongs together, drawn in its order.
struct FigureGroup {
    std::string name;             ///< one word: "legend"
    std::string label;            ///< what it is, for those who do not see it
    std::optional<PixelBox> clip; ///< what lies beyond is not drawn; empty: all is
    std::vector<FigureElement> elements = {};
};

/// The bar that tells lengths.
struct FigureScale {
    double millimetres = 0; ///< on paper
    std::string text;       ///< what it stands for: "20 mm"
};

struct Figure {
    double width = 0, height = 0;
    std::string title, description; ///< for lists of files, and for those who do not see it
    std::string font;               ///< families with commas between, the first that is there counts
    std::vector<FigureGroup> groups;
    std::optional<FigureScale> scale; ///< empty: there is no bar
};

} // namespace pellucid
