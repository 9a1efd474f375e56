// How the room of the window is shared out: layouts of tasks, the mode with the picture alone, menus and the tool bar.
#include "gui_support.h"

#include <QDockWidget>
#include <QMenu>
#include <QMenuBar>
#include <QSettings>
#include <QStatusBar>
#include <QToolBar>
#include <QToolButton>

#include "panels/panel.h"
#include "panels/target_bars.h"
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
