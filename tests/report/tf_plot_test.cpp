// A transfer function as a plot.
#include "report/tf_plot.h"

#include <catch2/catch.hpp>

#include "report/plot_drawing.h"

using namespace pellucid;

namespace {

/// A red tent over the lower half: 0 at 0 and 0.5, 0.4 at 0.25.
TransferFunction redTent() {
    TransferFunction tf;
    for (const auto& [x, opacity] : {std::pair{0.0, 0.0}, std::pair{0.25, 0.4}, std::pair{0.5, 0.0}})
        tf.points.push_back({.x = x, .opacity = opacity, .color = {1, 0, 0}, .fixed = false, .extraJson = {}});
    return tf;
}

} // namespace

TEST_CASE("the curve of a transfer function is plotted over data units, its area in its colours", "[report]") {
    const Plot plot = tfPlot(redTent(), {.window = {-100, 300}, .unit = "HU"});
    CHECK(plot.x.label == "value (HU)");
    CHECK(plot.x.lo == -100);
    CHECK(plot.x.hi == 300);
    CHECK(plot.y.hi == Approx(0.42)); // a twentieth above the peak
    REQUIRE(plot.series.size() == 1);
    // Its three points and the end at 1; intensity x is −100 + 400 x.
    const std::vector<PlotPoint>& curve = plot.series[0].points;
    REQUIRE(curve.size() == 4);
    CHECK(curve[1].x == Approx(0));
    CHECK(curve[1].y == 0.4);
    CHECK(curve[3].x == 300);
    CHECK(curve[3].y == 0);
    // Bars only below the tent, red, the highest ones beside its peak at value 0.
    double highest = 0;
    for (const PlotBar& bar : plot.bars) {
        CHECK(bar.from < 100);
        CHECK(bar.color == Rgb{1, 0, 0});
        highest = std::max(highest, bar.height);
    }
    CHECK(highest > 0.39);
    CHECK(highest <= 0.4);
}

TEST_CASE("the histogram is drawn as steps, the fullest bin as high as the plot", "[report]") {
    Histogram histogram;
    histogram.counts = {99, 0, 9, 0}; // log1p: ln 100, 0, ln 10, 0
    histogram.total = 108;
    const Plot plot = tfPlot(redTent(), {.window = {0, 4}, .histogram = &histogram, .highest = 0.5});
    REQUIRE(plot.series.size() == 2);
    CHECK(plot.y.hi == 0.5);
    const std::vector<PlotPoint>& steps = plot.series[0].points;
    REQUIRE(steps.size() == 8);
    CHECK(steps[0] == PlotPoint{0, 0.5});
    CHECK(steps[1] == PlotPoint{1, 0.5});
    CHECK(steps[2].y == 0);
    CHECK(steps[4].x == 2);
    CHECK(steps[4].y == Approx(0.25)); // half as high: ln 10 / ln 100
}

TEST_CASE("bars of a plot stand on its axis, below the curves", "[report]") {
    Plot plot{.title = "", .x = {.label = "", .hi = 10}, .y = {.label = "", .hi = 1}, .series = {}};
    plot.bars = {{2, 4, 0.5, Rgb{0, 0, 1}}, {4, 6, 2, {}}};
    const PlotPage page;
    const PlotBox box = boxOf(plot, page);
    const PlotDrawing drawing = drawingOf(plot, page);
    REQUIRE(drawing.areas.size() == 2);
    const PlotArea &own = drawing.areas[0], &shade = drawing.areas[1];
    CHECK(own.ink == PlotInk::Own);
    CHECK(own.color == Rgb{0, 0, 1});
    CHECK(own.lo.x == Approx(box.xOf(2)));
    CHECK(own.hi.x == Approx(box.xOf(4)));
    CHECK(own.lo.y == Approx((box.top + box.bottom) / 2));
    CHECK(own.hi.y == Approx(box.bottom));
    CHECK(shade.ink == PlotInk::Shade);
    CHECK(shade.lo.y == Approx(box.top)); // higher than the plot: up to its edge
}
