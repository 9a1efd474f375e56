#include <catch2/catch.hpp>

#include <array>

#include "report/convergence.h"
#include "report/csv.h"
#include "run_support.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("the curves of a run are its history", "[convergence]") {
    const Run run = exampleRun();
    const std::array runs{RunCurve{&run, curveColor(0)}};
    const Plot f = objectivePlot(runs);
    // The run's curve, and the tolerance as a dashed line through all moves.
    REQUIRE(f.series.size() == 2);
    CHECK(f.series[0].name == "newton 14:03");
    CHECK(f.series[0].points == std::vector<PlotPoint>{{0, 0.4}, {1, 0.1, true}, {2, 0.02}});
    CHECK(f.series[1].dashed);
    CHECK(f.series[1].points == std::vector<PlotPoint>{{0, 0.03}, {2, 0.03}});
    CHECK(f.x.hi == 2);
    CHECK(f.y.hi == Approx(0.44)); // a tenth above the largest value
    // The move along rays is half a move to both sides.
    CHECK(f.bands == std::vector<PlotBand>{{0.5, 1.5, "along rays"}});

    const Plot vws = vwsPlot(run);
    REQUIRE(vws.series.size() == 4); // a curve and a target for each of the two features
    CHECK(vws.series[0].name == "skin");
    CHECK(vws.series[0].color == Rgb{1, 0.5, 0});
    CHECK(vws.series[0].points == std::vector<PlotPoint>{{0, 0.8}, {1, 0.3, true}, {2, 0.24}});
    CHECK(vws.series[1].dashed);
    CHECK(vws.series[1].color == Rgb{1, 0.5, 0});
    CHECK(vws.series[1].points.front().y == 0.25);

    const Plot opacity = opacityPlot(run, true);
    CHECK(opacity.series[1].points == std::vector<PlotPoint>{{0, 0.5}, {1, 0.8, true}, {2, 0.9}});
    CHECK(opacity.y.logarithmic);
    CHECK(opacity.y.lo == Approx(0.001)); // the decade below 0.005
    CHECK(opacity.y.hi == Approx(1));
    CHECK(convergencePlots(run) == std::vector<Plot>{f, vws, opacityPlot(run)});
}

TEST_CASE("F of 0 has a place on a logarithmic axis", "[convergence]") {
    Run run = exampleRun();
    run.history.back().objective = 0;
    const std::array runs{RunCurve{&run, curveColor(0)}};
    const Plot plot = objectivePlot(runs, true);
    CHECK(plot.y.lo == Approx(1e-6));
    CHECK(plot.y.hi == Approx(1));
}

TEST_CASE("runs are compared in one plot", "[convergence]") {
    const Run first = exampleRun();
    Run second = exampleRun();
    second.name = "with fixed steps";
    second.history.push_back(second.history.back());
    second.start.edit([](RunStart& start) { start.options.tolerance = 0.01; });
    const std::array runs{RunCurve{&first, curveColor(0)}, RunCurve{&second, curveColor(1)}};
    const Plot plot = objectivePlot(runs);
    REQUIRE(plot.series.size() == 4); // two curves, two tolerances
    CHECK(plot.series[1].name == "with fixed steps");
    CHECK(plot.series[1].color == curveColor(1));
    CHECK(plot.x.hi == 3); // the longer one
    CHECK(plot.series[2].points.back().x == 3);
    CHECK(plot.bands.empty());
}

TEST_CASE("a run of an earlier version has curves too", "[convergence]") {
    Run run = exampleRun();
    run.start = {};
    run.started.clear();
    CHECK(titleOf(run) == "optimize");
    CHECK(vwsPlot(run).series[0].color == curveColor(0));
    const Run nothing;
    CHECK(vwsPlot(nothing).series.empty());
    CHECK(convergencePlots(nothing).size() == 3);
}

TEST_CASE("curves as a table", "[csv]") {
    const Run run = exampleRun();
    const Run* const only = &run;
    CHECK(csvOf(std::span(&only, 1)) ==
          "run,method,move,level,F,VWS skin,target skin,opacity skin,"
          "\"VWS bone, \"\"hard\"\"\",\"target bone, \"\"hard\"\"\",\"opacity bone, \"\"hard\"\"\"\n"
          "newton 14:03,newton,0,0,0.4,0.8,0.25,0.5,0.2,0.75,0.5\n"
          "newton 14:03,newton,1,1,0.1,0.3,0.25,0.05,0.7,0.75,0.8\n"
          "newton 14:03,newton,2,0,0.02,0.24,0.25,0.005,0.76,0.75,0.9\n");

    // Another run, without bone but with two features named skin: each finds its own column.
    Run other = exampleRun();
    other.name = "=1+1"; // a spreadsheet must not compute it
    other.features = {"skin", "skin"};
    other.history.resize(1);
    const std::array<const Run*, 2> both{&run, &other};
    const std::string csv = csvOf(both);
    CHECK(csv.substr(0, csv.find('\n')).ends_with(",VWS skin (2),target skin (2),opacity skin (2)"));
    CHECK(csv.find("newton 14:03,newton,0,0,0.4,0.8,0.25,0.5,0.2,0.75,0.5,,,\n") != std::string::npos);
    CHECK(csv.ends_with("'=1+1,newton,0,0,0.4,0.8,0.25,0.5,,,,0.2,0.75,0.5\n"));
}
