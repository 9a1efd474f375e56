// How the room of the window is shared out: layouts of tasks, the mode with the picture alone, menus and the tool bar.
#include "gui_support.h"

#include <QAbstractItemView>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QHelpEvent>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QScrollArea>
#include <QSettings>
#include <QStatusBar>
#include <QTableView>
#include <QToolBar>
#include <QToolButton>
#include <QToolTip>

#include "panels/panel.h"
#include "panels/target_bars.h"
#include "widgets/fitting_row.h"
#include "widgets/icons.h"
#include "window/room.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

QDockWidget& dock(OpenWindow& w, const char* id) { return w.child<QDockWidget>((std::string(id) + "Dock").c_str()); }

void trigger(OpenWindow& w, const char* action) {
    w.child<QAction>(action).trigger();
    QTest::qWait(20);
}

/// Entries of a menu, its submenus counted as one each.
int rowsOf(const QMenu& menu) {
    const QList<QAction*> actions = menu.actions();
    return static_cast<int>(std::ranges::count_if(actions, [](const QAction* a) { return !a->isSeparator(); }));
}

} // namespace

TEST_CASE("menus are short, and panels stand in four groups", "[room]") {
    OpenWindow w;
    const QMenu* const view = w.services().actions().menu("&View");
    REQUIRE(view != nullptr);
    QStringList rows;
    for (const QAction* action : view->actions())
        if (!action->isSeparator()) rows << action->text();
    INFO(rows.join(", ").toStdString());
    CHECK(rowsOf(*view) <= 15);
    const QMenu* const panels = w.services().actions().menu("&Panels");
    REQUIRE(panels != nullptr);
    CHECK(rowsOf(*panels) == static_cast<int>(panelRegistry().size()));
    QStringList sections;
    for (const QAction* action : panels->actions())
        if (action->isSeparator()) sections << action->text();
    CHECK(sections == QStringList{"Look", "Shares", "Time", "Files"});
}

TEST_CASE("at first only what everybody needs is open", "[room]") {
    OpenWindow w;
    for (const char* id : {"settings", "refinement", "influence", "convergence"}) CHECK(dock(w, id).isHidden());
    for (const char* id : {"tf", "features"}) CHECK_FALSE(dock(w, id).isHidden());
}

TEST_CASE("with a series and its variables open the picture has half of the window", "[room]") {
    OpenWindow w(16);
    VolumeSource series;
    series.path = "sample:vortex";
    series.sampleSize = 16;
    w.open(series);
    trigger(w, "variablesAction");
    trigger(w, "featuresAction"); // in front of it, as a tab
    REQUIRE_FALSE(dock(w, "player").isHidden());
    REQUIRE_FALSE(dock(w, "variables").isHidden());
    // Screens of laptops and desks; 1280 x 720 is 2560 x 1440 at 200 %.
    for (const QSize size : {QSize(1280, 800), QSize(1366, 768), QSize(1600, 1000), QSize(1280, 720)}) {
        INFO(size.width() << " x " << size.height());
        w.window.resize(size);
        trigger(w, "resetLayoutAction");
        trigger(w, "playerAction");
        trigger(w, "variablesAction");
        trigger(w, "featuresAction");
        w.settle();
        const QSize picture = w.window.views().size();
        CHECK(2 * picture.width() * picture.height() >= size.width() * size.height());
        CHECK(w.canvas().plot().height() >= 120);
        auto& bars = w.child<TargetBars>("targetBars");
        CHECK(bars.visibleRegion().boundingRect().height() >= bars.sizeHint().height()); // each feature's
        CHECK(w.child<QWidget>("timeStrip").visibleRegion().boundingRect().height() >= 48);
        for (const char* id : {"tf", "player", "features"}) { // no bars to scroll with
            INFO(id);
            const auto& content = *static_cast<QScrollArea*>(dock(w, id).widget());
            CHECK(content.widget()->width() <= content.width());
            CHECK(content.widget()->height() <= content.height());
        }
    }
}

TEST_CASE("what is to be said lies over the picture, which keeps its size", "[room]") {
    OpenWindow w;
    const QSize before = w.view().size();
    w.services().notices().add({"Something is worth a remark.", {{"Do it", [] {}}}});
    auto& bar = w.child<QWidget>("noticeBar");
    REQUIRE(waitFor([&] { return bar.isVisible() && bar.width() > 100; }));
    w.settle();
    CHECK(w.view().size() == before);
    const QRect whole = w.window.centralWidget()->rect();
    CHECK(whole.contains(bar.geometry()));
    auto& text = w.child<QLabel>("noticeText");
    CHECK(text.width() >= text.fontMetrics().horizontalAdvance(text.text())); // in one line
    // A long one has lines, and room for them.
    w.services().notices().add({QString("A long remark has several lines. ").repeated(12), {}});
    w.settle();
    QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
    CHECK(whole.contains(bar.geometry()));
    CHECK(text.height() >= text.heightForWidth(text.width()));
}

TEST_CASE("names in lists lose their middle, and tool tips have them whole", "[room]") {
    OpenWindow w;
    for (const char* id : {"featuresTable", "variablesList", "measureList", "runList", "galleryList"}) {
        INFO(id);
        CHECK(w.child<QAbstractItemView>(id).textElideMode() == Qt::ElideMiddle);
    }
    auto& table = w.child<QTableView>("featuresTable");
    const auto tipOver = [&](int row) {
        const QPoint at = table.visualRect(table.model()->index(row, FeaturesModel::Name)).center();
        QHelpEvent asks(QEvent::ToolTip, at, table.viewport()->mapToGlobal(at));
        QCoreApplication::sendEvent(table.viewport(), &asks);
        return QToolTip::text();
    };
    const QString name = "the anterior cruciate ligament, with what lies around it, of the left knee";
    table.model()->setData(table.model()->index(0, FeaturesModel::Name), name);
    CHECK(tipOver(0).startsWith(name + "\n"));
    CHECK_FALSE(tipOver(1).startsWith(table.model()->index(1, FeaturesModel::Name).data().toString()));
    QToolTip::hideText();
    // Opacities have their digits.
    const auto& number = *table.findChild<QDoubleSpinBox*>("opacitySpin");
    CHECK(number.width() >= number.fontMetrics().horizontalAdvance("0.0000"));
}

TEST_CASE("a row that is too narrow leaves out what matters least", "[room]") {
    QWidget widget;
    auto* row = new FittingRow(4);
    widget.setLayout(row);
    row->setContentsMargins(0, 0, 0, 0);
    std::vector<QWidget*> cells;
    for (const int rank : {2, 0, 1}) {
        auto* const cell = new QWidget(&widget);
        cell->setFixedSize(50, 10);
        row->add(cell, rank);
        cells.push_back(cell);
    }
    widget.resize(158, 20); // 3 × 50 + 2 × 4
    widget.show();
    REQUIRE(QTest::qWaitForWindowExposed(&widget, kPatience));
    CHECK(widget.minimumSizeHint().width() == 0);
    CHECK(std::ranges::none_of(cells, [&](QWidget* cell) { return row->isLeftOut(*cell); }));
    CHECK(cells[2]->x() == 108);
    const auto give = [&](int width) { row->setGeometry(QRect(0, 0, width, 20)); };
    give(157);
    CHECK(row->isLeftOut(*cells[0]));
    CHECK(cells[1]->x() == 0);
    CHECK(cells[2]->x() == 54);
    give(60);
    CHECK(row->isLeftOut(*cells[2]));
    CHECK_FALSE(row->isLeftOut(*cells[1]));
    // What is hidden needs no room.
    cells[1]->hide();
    give(60);
    CHECK_FALSE(row->isLeftOut(*cells[2]));
}

TEST_CASE("each tool has an icon in the colour of the text, and words where these are wanted", "[room]") {
    OpenWindow w;
    auto& bar = w.child<QToolBar>("viewToolBar");
    CHECK(bar.toolButtonStyle() == Qt::ToolButtonIconOnly);
    for (const QAction* action : bar.actions()) {
        if (action->isSeparator()) continue;
        INFO(action->objectName().toStdString());
        CHECK_FALSE(action->icon().isNull());
        CHECK_FALSE(action->toolTip().isEmpty());
        // Something is drawn, at both scales.
        for (const int size : {20, 40}) {
            const QImage drawn = action->icon().pixmap(size, size).toImage();
            int marked = 0;
            for (int y = 0; y < drawn.height(); ++y)
                for (int x = 0; x < drawn.width(); ++x) marked += qAlpha(drawn.pixel(x, y)) > 100;
            CHECK(marked > size);
        }
    }
    trigger(w, "toolBarWordsAction");
    CHECK(bar.toolButtonStyle() == Qt::ToolButtonTextUnderIcon);
    trigger(w, "toolBarWordsAction");
    CHECK(bar.toolButtonStyle() == Qt::ToolButtonIconOnly);
    CHECK(iconNamed("no such action").isNull());
}

TEST_CASE("Tab in the picture leaves the picture and the bars, and brings everything back", "[room]") {
    OpenWindow w;
    const QSize before = w.view().size();
    const auto openDocks = [&] {
        QStringList open;
        for (const QDockWidget* d : w.window.findChildren<QDockWidget*>())
            if (!d->isHidden()) open << d->objectName();
        return open;
    };
    const QStringList docks = openDocks();
    w.view().setFocus();
    QTest::keyClick(&w.view(), Qt::Key_Tab);
    REQUIRE(w.window.room().isFocused());
    CHECK(openDocks().isEmpty());
    CHECK(w.window.menuBar()->isHidden());
    CHECK(w.window.statusBar()->isHidden());
    CHECK_FALSE(w.child<QToolBar>("viewToolBar").isVisible());
    CHECK(w.child<TargetBars>("focusBars").isVisible());
    REQUIRE(waitFor([&] { return w.view().width() * w.view().height() > before.width() * before.height() * 3 / 2; }));
    // Keys of the menus work all the same.
    w.window.activateWindow();
    REQUIRE(QTest::qWaitForWindowActive(&w.window, kPatience));
    w.document().setTargets({0.1, 0.3, 0.6});
    QTest::keyClick(&w.window, Qt::Key_Z, Qt::ControlModifier);
    CHECK(w.document().targets()[2] != Approx(0.6));
    QTest::keyClick(&w.view(), Qt::Key_Tab);
    CHECK_FALSE(w.window.room().isFocused());
    CHECK(openDocks() == docks);
    CHECK_FALSE(w.window.menuBar()->isHidden());
    REQUIRE(waitFor([&] { return w.view().size() == before; }));
}

TEST_CASE("a task has its panels, and finds them as they were left", "[room]") {
    OpenWindow w;
    trigger(w, "taskTargetsAction");
    CHECK(w.window.room().task() == Task::Targets);
    CHECK_FALSE(dock(w, "convergence").isHidden());
    CHECK_FALSE(dock(w, "influence").isHidden());
    dock(w, "influence").hide();
    trigger(w, "taskSeriesAction");
    CHECK_FALSE(dock(w, "player").isHidden());
    CHECK(dock(w, "convergence").isHidden());
    trigger(w, "taskTargetsAction");
    CHECK(dock(w, "influence").isHidden());
    trigger(w, "resetLayoutAction");
    CHECK_FALSE(dock(w, "influence").isHidden());
    trigger(w, "taskSlicesAction");
    CHECK(w.services().scene().session.slices->layout == SliceViews::Layout::Four);
    trigger(w, "taskExploreAction");
    CHECK(w.services().scene().session.slices->layout == SliceViews::Layout::Volume);
    CHECK_FALSE(dock(w, "gallery").isHidden());
    // The next window opens at the task that this one was left at.
    trigger(w, "taskSeriesAction");
    w.window.room().save();
    MainWindow next;
    next.restoreLayout();
    CHECK(next.room().task() == Task::Series);
    QSettings().clear();
}
