// Curves over the frames of a series.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

#include "report/image_plot.h"
#include "report/temporal_curves.h"

using namespace pellucid;

namespace {

FrameFigures figuresAt(int frame, std::vector<double> vws, double objective) {
    FrameFigures f;
    f.frame = frame;
    f.time = 0.5 * frame;
    f.vws = std::move(vws);
    f.visibility = {0.5, 0.25};
    f.opacity = {0.01, 0.1};
    f.targets = {0.5, 0.5};
    f.objective = objective;
    if (frame > 2) {
        f.flicker = 1.5;
        f.moves = 2;
        f.seconds = 0.25;
    }
    return f;
}

/// Frames 2 to 6, of which 4 is broken.
TemporalCurves twoCurves() {
    TemporalCurves curves;
    curves.features = {"skin", "=bone"};
    curves.colors = {{1, 0, 0}, {0, 0, 1}};
    FrameFigures broken;
    broken.frame = 4;
    broken.time = 2;
    broken.problem = "it ends too early";
    curves.runs.push_back({"optimize",
                           {figuresAt(2, {0.5, 0.5}, 0), figuresAt(3, {0.52, 0.48}, 0.02), broken,
                            figuresAt(5, {0.5, 0.5}, 0), figuresAt(6, {0.49, 0.51}, 0.01)}});
    curves.runs.push_back({"static", {figuresAt(2, {0.5, 0.5}, 0), figuresAt(3, {0.6, 0.4}, 0.1)}});
    return curves;
}

} // namespace

TEST_CASE("curves of a series have a gap where a frame is broken", "[temporal]") {
    const TemporalCurves curves = twoCurves();
    const Plot vws = temporalVwsPlot(curves, 0);
    // Two pieces of each feature, and of its target; each name once.
    REQUIRE(vws.series.size() == 8);
    CHECK(vws.series[0].name == "skin");
    CHECK(vws.series[0].points == std::vector<PlotPoint>{{2, 0.5}, {3, 0.52}});
    CHECK(vws.series[1].name.empty());
    CHECK(vws.series[1].color == Rgb{1, 0, 0});
    CHECK(vws.series[1].points == std::vector<PlotPoint>{{5, 0.5}, {6, 0.49}});
    CHECK(vws.series[4].dashed);
    CHECK(vws.series[4].points == std::vector<PlotPoint>{{2, 0.5}, {3, 0.5}});
    CHECK(vws.x.lo == 2);
    CHECK(vws.x.hi == 6);
    CHECK(vws.x.whole);
    CHECK(vws.y.hi == Approx(0.572)); // a tenth above 0.52
    CHECK(vws.title == "Visibility-weighted saliency, optimize");
    CHECK_FALSE(curves.empty());
}

TEST_CASE("runs are compared in the plots of F and flicker, and VWS have one axis", "[temporal]") {
    const TemporalCurves curves = twoCurves();
    const Plot f = temporalObjectivePlot(curves);
    REQUIRE(f.series.size() == 3); // two pieces, and the static one
    CHECK(f.series[0].name == "optimize");
    CHECK(f.series[2].name == "static");
    CHECK(f.series[2].points == std::vector<PlotPoint>{{2, 0}, {3, 0.1}});
    const Plot flicker = temporalFlickerPlot(curves);
    CHECK(flicker.series[0].points == std::vector<PlotPoint>{{3, 1.5}}); // frame 2 has none before it
    CHECK(flicker.series[0].dotted);
    const auto plots = temporalPlots(curves);
    REQUIRE(plots.size() == 8);
    CHECK(plots[0].y.hi == Approx(0.66)); // of the static one, 0.6
    CHECK(plots[1].y.hi == plots[0].y.hi);
    const Plot opacity = temporalOpacityPlot(curves, 0, true);
    CHECK(opacity.y.logarithmic);
    CHECK(opacity.y.lo == Approx(0.01));
    CHECK(opacity.y.hi == Approx(0.1));
}

TEST_CASE("the table of a series has a line per frame and run", "[temporal]") {
    const std::string csv = csvOf(twoCurves());
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 8); // the head, five frames and two
    CHECK(csv.rfind("run,frame,file,time,F,flicker,moves,seconds,VWS skin,target skin,FV skin,opacity skin,VWS =bone,"
                    "target =bone,FV =bone,opacity =bone,problem\n",
                    0) == 0);
    CHECK(csv.find("\noptimize,3,,1.5,0.02,1.5,2,0.25,0.52,0.5,0.5,0.01,0.48,0.5,0.25,0.1,\n") != std::string::npos);
    CHECK(csv.find("\noptimize,4,,2,,,,,,,,,,,,,it ends too early\n") != std::string::npos);
    CHECK(csv.find("\nstatic,2,,1,0,,,,") != std::string::npos);
}

TEST_CASE("2D feature saliency has curves and columns where pictures were looked at", "[temporal]") {
    TemporalCurves curves = twoCurves();
    CHECK_FALSE(curves.hasPictures());
    curves.runs[0].frames[1].fs = {0.75, 0.25}; // of frame 3 alone
    CHECK(curves.hasPictures());
    const Plot plot = temporalPicturePlot(curves, 0);
    REQUIRE(plot.series.size() == 2);
    CHECK(plot.series[1].points == std::vector<PlotPoint>{{3, 0.25}});
    CHECK(plot.title == "2D feature saliency, optimize");
    CHECK(temporalPlots(curves).size() == 10);
    const std::string csv = csvOf(curves);
    CHECK(csv.find("FV skin,opacity skin,2DFS skin,VWS =bone") != std::string::npos);
    CHECK(csv.find("\noptimize,3,,1.5,0.02,1.5,2,0.25,0.52,0.5,0.5,0.01,0.75,0.48,0.5,0.25,0.1,0.25,\n") !=
          std::string::npos);
    CHECK(csv.find("\nstatic,2,,1,0,,,,0.5,0.5,0.5,0.01,,0.5,0.5,0.25,0.1,,\n") != std::string::npos);
}

TEST_CASE("figures of a series are means over what could be read", "[temporal]") {
    const SequenceFigures s = summaryOf(twoCurves().runs[0].frames);
    CHECK(s.frames == 4);
    CHECK(s.broken == 1);
    CHECK(s.rms == Approx(std::sqrt((0.02 * 0.02 + 0.01 * 0.01) / 4)));
    CHECK(s.flicker == Approx(1.5));
    CHECK(s.moves == Approx(2));
    CHECK(s.seconds == Approx(0.25));
}

TEST_CASE("plots are pictures", "[temporal]") {
    const std::array plots{temporalVwsPlot(twoCurves(), 0), temporalObjectivePlot(twoCurves())};
    const PlotPage page{.width = 300, .height = 200};
    const Image image = imageOf(plots, page, 2);
    CHECK(image.width == 600);
    CHECK(image.height == 800);
    const auto isNear = [&](int x, int y, const Rgb& c) {
        const float* p = image.pixel(x, y);
        return std::abs(static_cast<double>(p[0]) - c.r) + std::abs(static_cast<double>(p[1]) - c.g) +
                   std::abs(static_cast<double>(p[2]) - c.b) <
               0.05;
    };
    CHECK(isNear(1, 1, {1, 1, 1})); // the ground
    // The skin's curve passes where the frame of the plot says.
    const PlotBox frame = boxOf(plots[0], page);
    const double x = 2.25, y = 0.5 + 0.02 * 0.25;
    bool red = false;
    for (int dy = -2; dy <= 2; ++dy)
        red = red || isNear(static_cast<int>(2 * frame.xOf(x)), static_cast<int>(2 * frame.yOf(y)) + dy, {1, 0, 0});
    CHECK(red);
}
