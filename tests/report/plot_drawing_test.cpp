#include <catch2/catch.hpp>

#include <algorithm>

#include "report/plot_drawing.h"

using namespace pellucid;

namespace {

/// Each character as wide as 10 pixels.
PlotPage page(double width = 400, double height = 300) {
    return {.width = width, .height = height, .fontSize = 10, .textWidth = [](const std::string& text) {
                return 10.0 * static_cast<double>(text.size());
            }};
}

Plot line() {
    return {.title = "A line",
            .x = {.label = "move", .lo = 0, .hi = 10, .whole = true},
            .y = {.label = "F", .lo = 0, .hi = 1},
            .series = {
                {.name = "one", .color = Rgb{1, 0, 0}, .dotted = true, .points = {{0, 1}, {5, 0.5, true}, {10, 0}}}}};
}

bool hasText(const PlotDrawing& drawing, const std::string& text) {
    return std::any_of(drawing.texts.begin(), drawing.texts.end(), [&](const PlotText& t) { return t.text == text; });
}

} // namespace

TEST_CASE("a plot lies where its axes say", "[plot]") {
    // Left: gap 6, the label's line 15, the widest tick "0.2" 30, gap 6: 57. Right: 400 − 2·6 = 388. Top: the title's
    // line and gap 21, one row of the legend 15, gap 6: 42. Bottom: 300 − 6 − two lines = 264.
    const PlotBox frame = boxOf(line(), page());
    CHECK(frame.left == Approx(57));
    CHECK(frame.right == Approx(388));
    CHECK(frame.top == Approx(42));
    CHECK(frame.bottom == Approx(264));
    CHECK(frame.xOf(0) == Approx(57));
    CHECK(frame.xOf(5) == Approx((57 + 388) / 2.0));
    CHECK(frame.yOf(0.25) == Approx(264 - 0.25 * (264 - 42)));
    CHECK(frame.valueAtX(frame.xOf(7)) == Approx(7));
    CHECK(frame.yOf(2) == frame.top); // beyond the axis: at its edge
    CHECK(frame.xOf(-1) == frame.left);

    const PlotDrawing drawing = drawingOf(line(), page());
    REQUIRE(drawing.dots.size() == 3);
    CHECK(drawing.dots[1].at.x == Approx(frame.xOf(5)));
    CHECK(drawing.dots[1].at.y == Approx(frame.yOf(0.5)));
    CHECK(drawing.dots[1].hollow);
    CHECK_FALSE(drawing.dots[0].hollow);
    // The curve has a rim below it, of the same points.
    const auto own = std::find_if(drawing.strokes.begin(), drawing.strokes.end(),
                                  [](const PlotStroke& s) { return s.ink == PlotInk::Own && s.points.size() == 3; });
    REQUIRE(own != drawing.strokes.end());
    REQUIRE(own != drawing.strokes.begin());
    CHECK((own - 1)->ink == PlotInk::Rim);
    CHECK((own - 1)->points == own->points);
    CHECK((own - 1)->width > own->width);
    for (const char* text : {"A line", "one", "move", "F", "0", "10", "0.2", "1"}) {
        INFO(text);
        CHECK(hasText(drawing, text));
    }
}

TEST_CASE("a logarithmic axis has equal decades", "[plot]") {
    Plot plot = line();
    plot.y = {.label = "F", .lo = 1e-4, .hi = 1, .logarithmic = true};
    const PlotBox frame = boxOf(plot, page());
    CHECK(frame.yOf(1e-2) == Approx((frame.top + frame.bottom) / 2));
    CHECK(frame.yOf(0) == frame.bottom); // zero has no place of its own
    // Four decades, about six ticks wanted: powers of ten alone. One decade: 2 and 5 between.
    CHECK(ticksOf(plot.y, 6) == std::vector<double>{1e-4, 1e-3, 1e-2, 1e-1, 1});
    CHECK(ticksOf({.label = "", .lo = 1, .hi = 10, .logarithmic = true}, 4) == std::vector<double>{1, 2, 5, 10});
    CHECK(tickText(plot.y, 1e-3) == "0.001");
}

TEST_CASE("an axis of moves has no ticks between them", "[plot]") {
    CHECK(ticksOf({.label = "move", .lo = 0, .hi = 2, .whole = true}, 8) == std::vector<double>{0, 1, 2});
    CHECK(ticksOf({.label = "move", .lo = 0, .hi = 2}, 4) == std::vector<double>{0, 0.5, 1, 1.5, 2});
}

TEST_CASE("a legend that finds no room says how much is missing", "[plot]") {
    Plot plot = line();
    plot.series.clear();
    for (int i = 0; i < 32; ++i)
        plot.series.push_back(
            {.name = "feature " + std::to_string(i), .color = Rgb{0, 0, 1}, .points = {{0, 0}, {1, 1}}});
    const PlotDrawing drawing = drawingOf(plot, page());
    int shown = 0, more = 0;
    for (const PlotText& t : drawing.texts) {
        shown += t.text.rfind("feature ", 0) == 0 ? 1 : 0;
        if (t.text.front() == '+') more = std::stoi(t.text.substr(1));
        CHECK(t.at.x >= 0);
        CHECK(t.at.y <= 300);
    }
    CHECK(shown > 3);
    CHECK(shown + more == 32);
    const PlotBox frame = boxOf(plot, page());
    CHECK(frame.bottom - frame.top > 100); // room for what it is about
}

TEST_CASE("long texts are cut between characters", "[plot]") {
    const PlotPage p = page();
    CHECK(p.fitted("abcdef", 60) == "abcdef");
    // The ellipsis has three bytes, 30 here: 60 leave room for three letters.
    CHECK(p.fitted("abcdefg", 60) == "abc…");
    CHECK(p.fitted("äöü", 50) == "ä…"); // two bytes each; never half of one
}

TEST_CASE("the dot under the mouse", "[plot]") {
    const Plot plot = line();
    const PlotBox frame = boxOf(plot, page());
    const auto hit = hitAt(plot, frame, {frame.xOf(5) + 3, frame.yOf(0.5) - 3}, 8);
    REQUIRE(hit);
    CHECK(hit->point == 1);
    CHECK_FALSE(hitAt(plot, frame, {frame.xOf(5) + 30, frame.yOf(0.5)}, 8));
}

TEST_CASE("a page that is far too small is drawn on all the same", "[plot]") {
    const PlotDrawing drawing = drawingOf(line(), page(20, 10));
    for (const PlotDot& dot : drawing.dots) {
        CHECK(std::isfinite(dot.at.x));
        CHECK(std::isfinite(dot.at.y));
    }
}
