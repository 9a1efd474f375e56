// What came of a study, as plots, table and page.
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "report/plot_drawing.h"
#include "report/study_plots.h"
#include "report/study_report.h"
#include "study/participation.h"
#include "study/simulation.h"
#include "support/study_cases.h"
#include "support/text_parts.h"

using namespace pellucid;
using pellucid::test::contains;
using pellucid::test::studyOf;
using pellucid::test::TempFolder;
using pellucid::test::timesIn;
using pellucid::test::writePrepared;

namespace {

/// Three pictures, a1 shown twice; VWS 0.3, 0.1, 0.2.
Study smallStudy() {
    Study study = studyOf(0, 3);
    study.title = "Teeth";
    for (std::size_t i = 0; i < 3; ++i) {
        study.stimuli[i].data = i == 2 ? "foot" : "tooth";
        study.stimuli[i].vws = std::array{0.3, 0.1, 0.2}[i];
        study.stimuli[i].color = Rgb{1, 0, 0};
    }
    return study;
}

Participant someone(const std::string& id, const std::vector<int>& scores, int again) {
    Participant who{.id = id, .colorVision = ColorVision::Normal, .answers = {}};
    for (std::size_t i = 0; i <= scores.size(); ++i) {
        const bool repeat = i == scores.size();
        who.answers.push_back({.trial = static_cast<int>(i) + 1,
                               .stimulus = "a" + std::to_string(repeat ? 1 : i + 1),
                               .feature = "f1",
                               .repeat = repeat,
                               .score = repeat ? again : scores[i],
                               .time = {}});
    }
    return who;
}

StudyAnalysis smallAnalysis() {
    return analyzeStudy(smallStudy(), {someone("p1", {4, 1, 2}, 5), someone("p2", {4, 2, 3}, 4)});
}

} // namespace

TEST_CASE("opinions as plots", "[report][study]") {
    const StudyAnalysis analysis = smallAnalysis();
    const Plot vws = opinionPlot(analysis, StudyMeasure::Vws);
    // MOS 4, 4.5 (a1 again), 1.5, 2.5 over 0.3, 0.3, 0.1, 0.2: ranks 3, 4, 1, 2 and 3.5, 3.5, 1, 2: ρ = 4.5/√(5·4.5).
    CHECK(vws.title == "MOS and VWS, rank correlation 0.949");
    REQUIRE(vws.series.size() == 2);
    CHECK(vws.series[0].name == "tooth");
    CHECK(vws.series[0].points == std::vector<PlotPoint>{{0.3, 4}, {0.3, 4.5, true}, {0.1, 1.5}});
    CHECK(vws.series[1].points == std::vector<PlotPoint>{{0.2, 2.5}});
    CHECK((vws.y.lo == 1 && vws.y.hi == 5));
    CHECK(opinionPlot(analysis, StudyMeasure::Fs).title == "MOS and 2DFS"); // of no picture is it known
    CHECK(opinionPlot(analysis, StudyMeasure::Fs).series[0].points.empty());

    const Plot tooth = featureOpinionPlot(analysis, analysis.features[0]);
    CHECK(tooth.title == "tooth, RED");
    REQUIRE(tooth.series[0].points.size() == 3);
    CHECK(tooth.series[0].points[0].x == 0.1);
    // Scores 1 and 2: 1.5 ± 12.706205·√½/√2.
    CHECK(tooth.series[0].points[0].spread == Approx(12.706204736174698 / 2));
    CHECK(tooth.series[0].points[1].spread == 0); // both gave 4
    CHECK(tooth.series[0].color == Rgb{1, 0, 0});

    const Plot consistency = consistencyPlot(analysis);
    // p2 gave 4 and 4, p1 4 and 5.
    CHECK(consistency.series[0].points == std::vector<PlotPoint>{{1, 0}, {2, 1}});
    CHECK(consistency.series.size() == 1); // one pair each says nothing of what is tolerated
}

TEST_CASE("dots without a line, and intervals around them", "[report]") {
    Plot plot{.title = {}, .x = {}, .y = {}, .series = {}};
    const auto strokes = [&] { return drawingOf(plot, {}).strokes.size(); };
    const std::size_t axes = strokes();
    plot.series.push_back({.name = {}, .dotted = true, .points = {{0.2, 0.2}, {0.8, 0.8}}, .joined = false});
    CHECK(strokes() == axes);
    CHECK(drawingOf(plot, {}).dots.size() == 2);
    plot.series[0].points[1].spread = 0.1;
    CHECK(strokes() == axes + 3); // upright, and a cross-line at either end
    plot.series[0].joined = true;
    CHECK(strokes() == axes + 4);
    plot.series[0].name = "named";
    plot.series[0].joined = false;
    CHECK(drawingOf(plot, {}).dots.size() == 3); // in the legend, too
}

TEST_CASE("a study's points as a table", "[report][study]") {
    const std::string csv = csvOf(smallAnalysis());
    CHECK(contains(csv, "stimulus,volume,feature,word,repeat,scores,mos,deviation,low,high,vws,fv,2dfs\n"));
    CHECK(contains(csv, "\na1,tooth,f1,RED,0,2,4,0,4,4,0.3,,\n"));
    CHECK(contains(csv, "\na1,tooth,f1,RED,1,2,4.5,0.7071067811865476,"));
    CHECK(timesIn(csv, "\n") == 5);
}

TEST_CASE("the page of a study says what came of it", "[report][study]") {
    const TempFolder folder;
    const Study study = writePrepared(studyOf(1, 12, 4), folder);
    simulateParticipants(folder.path(""), {.participants = 4, .correlation = 0.9});
    {
        Participation colorBlind(folder.path(""), "p1");
        colorBlind.setColorVision(ColorVision::Deficient);
        while (!colorBlind.isDone()) colorBlind.answer(3, {});
    }
    std::filesystem::remove(study.stimuli[2].picture);
    // A study without one of its pictures is read all the same.
    StudyReport report = makeStudyReport(folder.path(""), {});
    report.command = "pellucid-cli study analyze <DIR>";
    const std::string html = htmlOf(report);
    CHECK(contains(html, "4 of 5 participants gave 64 scores to 12 pictures, 4 of them shown twice."));
    CHECK(contains(html, "All of them are simulated"));
    CHECK(contains(html, "no: colour vision is deficient"));
    CHECK(contains(html, "The picture of a2 cannot be shown"));
    CHECK(timesIn(html, "<img src=\"data:image/png;base64,") == 11); // not that of the training
    // Figure 4.14, one feature of one volume, consistency.
    CHECK(timesIn(html, "<svg") == 5);
    for (const char* thesis : {"0.67508", "0.678626", "0.550472"}) CHECK(contains(html, thesis));
    CHECK(contains(html, "VWS and FV cannot be told apart: the difference of their correlations is 0.000"));
    CHECK(contains(html, "study analyze &lt;DIR&gt;"));
    CHECK(contains(html, "data:text/csv;base64,"));
    CHECK_FALSE(contains(html, "nan"));
}

TEST_CASE("hostile texts of a study are only texts on its page", "[report][study]") {
    const std::string evil = "<script>alert(\"1\")</script>";
    Study study = smallStudy();
    study.title = study.question = evil;
    for (Stimulus& s : study.stimuli) s.data = s.feature = s.label = s.id = evil + s.id;
    Participant who = someone(evil, {4, 1, 2}, 5);
    for (Answer& a : who.answers) a.stimulus = evil + a.stimulus;
    StudyReport report{.analysis = analyzeStudy(study, {who}),
                       .pictures = {},
                       .command = evil,
                       .liesWithStudy = true,
                       .program = evil};
    for (int i = 0; i < 3; ++i) report.pictures.push_back(encoded(Image(2, 2)));
    const std::string html = htmlOf(report);
    CHECK_FALSE(contains(html, "<script"));
    CHECK_FALSE(contains(html, "alert(\"1\")"));
    CHECK(timesIn(html, "&lt;script&gt;") > 15);
}

TEST_CASE("a study that nobody took part in has no page", "[report][study]") {
    const TempFolder folder;
    CHECK_THROWS_AS(makeStudyReport(folder.path(""), {}), Error);
    writePrepared(studyOf(0, 3), folder);
    CHECK_THROWS_WITH(makeStudyReport(folder.path(""), {}), Catch::Contains("nobody has taken part yet"));
}
