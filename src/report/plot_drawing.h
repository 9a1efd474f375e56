// Where everything of a plot lies, in pixels: what SVG files, the window and reports draw each in their way.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "report/plot.h"

namespace pellucid {

using Vec2 = glm::dvec2;

/// What a mark is drawn in: themes and media have their own colours for each but Own.
enum class PlotInk {
    Text,
    Faint, ///< labels of axes
    Grid,
    Shade, ///< bands
    Rim,   ///< around curves, so that light ones are seen on a light ground and dark ones on a dark ground
    Ground,
    Own ///< the mark's `color`
};

struct PlotStroke {
    std::vector<Vec2> points;
    PlotInk ink = PlotInk::Text;
    Rgb color = {};
    double width = 1;
    bool dashed = false;
};

struct PlotDot {
    Vec2 at{0, 0};
    double radius = 3;
    PlotInk ink = PlotInk::Text;
    Rgb color = {};
    bool hollow = false; ///< filled with the ground
};

struct PlotArea {
    Vec2 lo{0, 0}, hi{0, 0}; ///< corners
    PlotInk ink = PlotInk::Shade;
    Rgb color = {};
};

struct PlotText {
    enum class Anchor { Start, Middle, End };
    Vec2 at{0, 0};    ///< of the baseline
    std::string text; ///< UTF-8, one line
    PlotInk ink = PlotInk::Text;
    Anchor anchor = Anchor::Start;
    double size = 12;    ///< of the font
    bool upward = false; ///< turned to the left by a quarter
    bool bold = false;
};

/// From the top left corner, y down; areas first, then strokes, dots and texts, each in their order.
struct PlotDrawing {
    double width = 0, height = 0;
    std::vector<PlotArea> areas;
    std::vector<PlotStroke> strokes;
    std::vector<PlotDot> dots;
    std::vector<PlotText> texts;
};

/// The paper: its size and the font.
struct PlotPage {
    double width = 480, height = 300;
    double fontSize = 12;
    /// Width of a text in the font; empty: an estimate that sans-serif fonts stay below.
    std::function<double(const std::string&)> textWidth = {};

    double widthOf(const std::string& text) const;
    /// `text`, or its beginning with an ellipsis that is not wider than `most`.
    std::string fitted(const std::string& text, double most) const;
};

/// Where the axes of a plot lie on a page.
struct PlotBox {
    double left = 0, top = 0, right = 0, bottom = 0; ///< pixels
    PlotAxis x, y;

    double xOf(double value) const; ///< clamped into the box, as yOf()
    double yOf(double value) const;
    double valueAtX(double pixel) const;
};

/// Values at which an axis has ticks: round numbers; of a logarithmic one powers of ten, and 2 and 5 times these where
/// they are few. `wanted`: about so many.
std::vector<double> ticksOf(const PlotAxis& axis, int wanted);
/// The number beside a tick.
std::string tickText(const PlotAxis& axis, double value);

PlotBox boxOf(const Plot& plot, const PlotPage& page);
PlotDrawing drawingOf(const Plot& plot, const PlotPage& page);

/// The point of a dotted series nearest to a place on the page, within `reach` pixels.
struct PlotHit {
    std::size_t series = 0, point = 0;
};
std::optional<PlotHit> hitAt(const Plot& plot, const PlotBox& box, const Vec2& at, double reach);

} // namespace pellucid
