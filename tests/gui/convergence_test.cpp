// The panel of convergence: curves that follow the moves, runs compared, dots that can be clicked, exports, reports.
#include "gui_support.h"

#include <set>

#include <QAction>
#include <QApplication>
#include <QCheckBox>
#include <QDir>
#include <QDockWidget>
#include <QLabel>
#include <QLineEdit>
#include <QTemporaryDir>
#include <QToolButton>
#include <QTreeWidget>

#include "panels/convergence_panel.h"
#include "report/convergence.h"
#include "report/report.h"
#include "session/session_json.h"
#include "widgets/plot_view.h"
#include "widgets/theme.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

const std::vector<Run>& runsOf(OpenWindow& w) { return *w.services().scene().session.runs; }

void optimize(OpenWindow& w, SearchMethod method, int mostMoves) {
    w.services().store().edit("Method", {}, [&](Session& session) {
        session.optimize.edit([&](OptimizeOptions& o) {
            o.method = method;
            o.maxIterations = mostMoves;
            o.exactShares = true; // the runs are what is looked at, not the pictures
        });
    });
    w.optimizing().start();
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    w.settle();
}

/// With the panel open, as high as it needs.
void openPanel(OpenWindow& w) {
    w.child<QAction>("showConvergence").trigger();
    auto& dock = w.child<QDockWidget>("convergenceDock");
    w.window.resizeDocks({&dock}, {260}, Qt::Vertical);
    QTest::qWait(50);
    REQUIRE(w.child<QWidget>("objectivePlot").isVisible());
}

/// Colours of all pixels but those that text smooths.
std::set<QRgb> colorsOf(QWidget& widget) {
    const QImage image = widget.grab().toImage().convertToFormat(QImage::Format_RGB32);
    std::set<QRgb> colors;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) colors.insert(image.pixel(x, y));
    return colors;
}

QPointF dotOf(const PlotView& view, std::size_t series, std::size_t point) {
    const PlotPoint& p = view.plot().series.at(series).points.at(point);
    const PlotBox box = view.box();
    return {box.xOf(p.x), box.yOf(p.y)};
}

QRgb rgbOf(const Rgb& color) { return colorFromRgb(color).rgb(); }

} // namespace

TEST_CASE("curves follow an optimization, and a dot shows its move", "[convergence]") {
    OpenWindow w;
    openPanel(w);
    auto& plot = w.child<PlotView>("objectivePlot");
    auto& vws = w.child<PlotView>("vwsPlot");
    CHECK_FALSE(w.child<QToolButton>("exportCurves").isEnabled());
    CHECK(colorsOf(plot).count(rgbOf(curveColor(0))) == 0);
    w.document().setTargets({0.1, 0.3, 0.6});

    std::size_t mostWhileRunning = 0;
    QObject::connect(&w.optimizing(), &OptimizeController::moved, [&] {
        REQUIRE(w.optimizing().underWay() != nullptr);
        if (!plot.plot().series.empty())
            mostWhileRunning = std::max(mostWhileRunning, plot.plot().series[0].points.size());
    });
    optimize(w, SearchMethod::Parallel, 4);
    CHECK(mostWhileRunning > 1); // they were drawn before it ended
    REQUIRE(runsOf(w).size() == 1);
    const Run run = runsOf(w).front();
    CHECK(run.number == 1);
    CHECK(run.evaluations > 0);
    CHECK_FALSE(run.started.empty());
    CHECK(run.start->options.method == SearchMethod::Parallel);
    REQUIRE(run.history.size() > 2);

    // The curves are the run's: F in its colour, VWS in those of the features.
    REQUIRE(plot.plot().series.front().points.size() == run.history.size());
    CHECK(plot.plot().series.front().points.back().y == run.history.back().objective);
    const QImage image = plot.grab().toImage();
    const QPointF last = dotOf(plot, 0, run.history.size() - 1) * image.devicePixelRatio();
    CHECK(image.pixelColor(last.toPoint()).rgb() == rgbOf(curveColor(0)));
    const auto features = colorsOf(vws);
    for (const Feature& f : w.document().tf().features)
        CHECK(features.count(seenOn(theme::kPanel, colorFromRgb(f.color)).rgb()) == 1);

    // The mouse reads values.
    QTest::mouseMove(&vws, dotOf(vws, 0, 1).toPoint());
    QMouseEvent move(QEvent::MouseMove, dotOf(vws, 0, 1), vws.mapToGlobal(dotOf(vws, 0, 1)), Qt::NoButton, {}, {});
    QCoreApplication::sendEvent(&vws, &move);
    const QString read = w.child<QLabel>("convergenceReadOut").text();
    INFO(read.toStdString());
    CHECK(read.startsWith("move 1: f1 "));
    CHECK(read.contains(QString::number(run.history[1].vws[0], 'g', run.history[1].vws[0] < 0.1 ? 3 : 4)));

    // A click on a dot is an edit.
    const TransferFunction answer = w.document().tf();
    const int steps = w.document().stepCount();
    QTest::mouseClick(&plot, Qt::LeftButton, {}, dotOf(plot, 0, 1).toPoint());
    CHECK(w.document().stepCount() == steps + 1);
    CHECK(w.services().store().undoText() == "Show move 1");
    const std::vector<double> shown = featureOpacities(w.document().tf());
    for (std::size_t f = 0; f < shown.size(); ++f) CHECK(shown[f] == Approx(run.history[1].opacity[f]).margin(1e-12));
    w.document().undo();
    CHECK(w.document().tf() == answer);

    // Undoing the optimization takes back what came of it, not that it was made.
    w.document().undo();
    CHECK(featureOpacities(w.document().tf()) == std::vector<double>(3, 0.5));
    CHECK(runsOf(w) == std::vector<Run>{run});
    w.document().redo();
    CHECK(w.document().tf() == answer);
    CHECK(runsOf(w) == std::vector<Run>{run});

    // Logarithmic: a decade is as high as another.
    QTest::mouseClick(&w.child<QCheckBox>("convergenceLog"), Qt::LeftButton, {}, QPoint(8, 8));
    CHECK(plot.plot().y.logarithmic);
    CHECK(plot.grab().toImage() != image);

    // In the other theme it has that one's ground.
    applyTheme(*qApp, Theme::Light);
    CHECK(colorsOf(plot).count(theme::kPanel.rgb()) == 1);
    CHECK(plot.grab().toImage().pixelColor(1, 1) == theme::kPanel);
    applyTheme(*qApp, Theme::Dark);
    CHECK(plot.grab().toImage().pixelColor(1, 1) == theme::kPanel);
}

TEST_CASE("runs are compared, renamed and deleted", "[convergence]") {
    OpenWindow w;
    openPanel(w);
    auto& plot = w.child<PlotView>("objectivePlot");
    auto& list = w.child<QTreeWidget>("runList");
    w.document().setTargets({0.1, 0.3, 0.6});
    const std::vector<double> opacities = featureOpacities(w.document().tf());
    optimize(w, SearchMethod::Parallel, 3);
    QTest::mouseClick(&w.child<QToolButton>("showStart"), Qt::LeftButton);
    CHECK(featureOpacities(w.document().tf()) == opacities);
    optimize(w, SearchMethod::Fixed, 5);
    REQUIRE(list.topLevelItemCount() == 2);
    // The latest first, both checked: two curves in two colours.
    CHECK(list.topLevelItem(0)->text(0).startsWith("fixed "));
    CHECK(list.topLevelItem(1)->text(0).startsWith("parallel "));
    auto colors = colorsOf(plot);
    CHECK(colors.count(rgbOf(curveColor(0))) == 1);
    CHECK(colors.count(rgbOf(curveColor(1))) == 1);
    CHECK(w.child<PlotView>("vwsPlot").plot().x.hi == 5); // that of the latest

    // Unchecked, the first one is gone from the plot; selected, it has the others.
    const QRect row = list.visualItemRect(list.topLevelItem(1));
    QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, QPoint(row.left() + 9, row.center().y()));
    CHECK(list.topLevelItem(1)->checkState(0) == Qt::Unchecked);
    colors = colorsOf(plot);
    CHECK(colors.count(rgbOf(curveColor(0))) == 0);
    CHECK(colors.count(rgbOf(curveColor(1))) == 1);
    QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, QPoint(row.right() - 60, row.center().y()));
    CHECK(w.child<PlotView>("vwsPlot").plot().x.hi == 3);

    // F2, another name.
    list.setFocus();
    QTest::keyClick(&list, Qt::Key_F2);
    auto* editor = list.findChild<QLineEdit*>();
    REQUIRE(editor != nullptr);
    editor->selectAll();
    QTest::keyClicks(editor, "eight at once");
    QTest::keyClick(editor, Qt::Key_Return);
    REQUIRE(waitFor([&] { return runsOf(w).front().name == "eight at once"; }));
    CHECK(list.topLevelItem(1)->text(0) == "eight at once");

    // Delete takes the selected one away, undo brings it back with its name.
    w.window.activateWindow();
    list.setFocus();
    list.setCurrentItem(list.topLevelItem(1));
    QTest::keyClick(&list, Qt::Key_Delete);
    REQUIRE(runsOf(w).size() == 1);
    CHECK(list.topLevelItemCount() == 1);
    CHECK(w.services().store().undoText() == "Delete run");
    w.document().undo();
    CHECK(runsOf(w).size() == 2);
    CHECK(list.topLevelItem(1)->text(0) == "eight at once");
}

TEST_CASE("a run has one count of moves, and says what else there was", "[convergence]") {
    OpenWindow w;
    openPanel(w);
    // 1 move on the volume, after 3 along rays; a step for the strength of the picture follows.
    const auto state = [](int level, double f) {
        OptimizeState s;
        s.opacity = {0.5, 0.5, 0.5};
        s.vws = {0.3, 0.3, 0.4};
        s.objective = f;
        s.level = level;
        return s;
    };
    OptimizeResult result;
    result.tf = w.document().tf();
    result.targets = {0.1, 0.3, 0.6};
    result.history = {state(0, 0.3), state(2, 0.3), state(2, 0.2), state(1, 0.1), state(0, 0.05), state(0, 0.05)};
    result.best = 5;
    result.searched = 5;
    w.services().store().edit("Run", {}, [&](Session& session) { session.addRun(runOf(result, {})); });
    auto& list = w.child<QTreeWidget>("runList");
    REQUIRE(list.topLevelItemCount() == 1);
    CHECK(list.topLevelItem(0)->text(1) == "1");
    CHECK(sayOf(result, 0).contains("in 1 move"));
    const QString tip = list.topLevelItem(0)->toolTip(1);
    INFO(tip.toStdString());
    CHECK(tip.contains("moves: 1 on the volume, 3 along rays, 1 after the search"));
}

TEST_CASE("a cream curve can be seen on white", "[convergence][theme]") {
    OpenWindow w;
    openPanel(w);
    TransferFunction tf = w.document().tf();
    const Rgb cream{0.95, 0.91, 0.8};
    tf.features[0].color = cream;
    w.document().setTf(tf, "cream");
    optimize(w, SearchMethod::Parallel, 2);
    applyTheme(*qApp, Theme::Light);
    auto& plot = w.child<PlotView>("vwsPlot");
    const QColor drawn = seenOn(theme::kPanel, colorFromRgb(cream));
    CHECK(contrast(drawn, theme::kPanel) >= kMarkContrast);
    const auto light = colorsOf(plot);
    CHECK(light.count(drawn.rgb()) == 1);
    CHECK(light.count(rgbOf(cream)) == 0);
    applyTheme(*qApp, Theme::Dark); // where it can be seen as it is
    CHECK(colorsOf(plot).count(rgbOf(cream)) == 1);
}

TEST_CASE("curves are exported as table, picture and drawing", "[convergence]") {
    OpenWindow w;
    openPanel(w);
    w.document().setTargets({0.1, 0.3, 0.6});
    optimize(w, SearchMethod::Parallel, 3);
    const QTemporaryDir folder;
    auto* panel = w.window.findChild<ConvergencePanel*>();
    REQUIRE(panel != nullptr);
    for (const char* name : {"c.csv", "c.png", "c.svg"}) panel->exportTo(folder.filePath(name));

    QFile csv(folder.filePath("c.csv"));
    REQUIRE(csv.open(QIODevice::ReadOnly));
    const QStringList lines = QString::fromUtf8(csv.readAll()).split('\n', Qt::SkipEmptyParts);
    CHECK(static_cast<std::size_t>(lines.size()) == runsOf(w).front().history.size() + 1);
    CHECK(lines.front().startsWith("run,method,move,level,F,VWS f1,"));
    const QImage picture(folder.filePath("c.png"));
    CHECK(picture.size() == QSize(1280, 2400)); // three plots of 640 × 400, at two pixels each
    CHECK(picture.pixelColor(2, 2) == QColor(Qt::white));
    QFile svg(folder.filePath("c.svg"));
    REQUIRE(svg.open(QIODevice::ReadOnly));
    const QByteArray text = svg.readAll();
    CHECK(text.startsWith("<?xml"));
    CHECK(text.contains("Visibility-weighted saliency"));
    CHECK(text.contains("height=\"1200\""));
}

TEST_CASE("a report of the last run is saved from the window", "[convergence]") {
    OpenWindow w;
    CHECK_FALSE(w.child<QAction>("saveReportAction").isEnabled());
    w.document().setTargets({0.1, 0.3, 0.6});
    optimize(w, SearchMethod::Parallel, 3);
    CHECK(w.child<QAction>("saveReportAction").isEnabled());
    const Run run = runsOf(w).back();
    const QImage before = w.picture();
    // What has changed since is no part of it.
    w.document().setTargets({0.6, 0.3, 0.1});
    const Session now = w.services().store().session();

    const QTemporaryDir folder;
    w.saving().saveReport(run, folder.filePath("report"));
    CHECK(w.saving().isBusy());
    REQUIRE(waitFor([&] { return !w.saving().isBusy(); }));
    CHECK(QDir(folder.filePath("report")).entryList(QDir::Files) ==
          QStringList{"curves.csv", "report.html", "start.pellucid.json"});
    QFile page(folder.filePath("report/report.html"));
    REQUIRE(page.open(QIODevice::ReadOnly));
    const QByteArray html = page.readAll();
    CHECK(html.contains("pellucid-cli optimize --session start.pellucid.json"));
    CHECK(html.count("data:image/png;base64,") == static_cast<int>(run.history.size()) + 2);
    const SessionFile start = readSession(folder.filePath("report/start.pellucid.json").toStdString());
    CHECK(targetsOf(*start.session.tf(), *start.session.goals) == std::vector<double>{0.1, 0.3, 0.6});
    // The window has not changed by it.
    CHECK(w.services().store().session() == now);
    CHECK(w.picture() == before);

    // Cancelled, there is nothing.
    w.saving().saveReport(run, folder.filePath("cancelled"));
    w.saving().cancel();
    REQUIRE(waitFor([&] { return !w.saving().isBusy(); }));
    w.settle();
    CHECK_FALSE(QFileInfo::exists(folder.filePath("cancelled")));
}
