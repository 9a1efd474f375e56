// Where things stand in the window: what fits the screen, what stays under the hand, what is in front.
#include "gui_support.h"

#include <QAction>
#include <QApplication>
#include <QDialog>
#include <QDockWidget>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QProcess>
#include <QScreen>
#include <QScrollBar>
#include <QSlider>
#include <QStyle>
#include <QTableWidget>
#include <QTemporaryDir>
#include <QTextBrowser>
#include <QTimer>
#include <QToolButton>

#include "panels/density_slider.h"
#include "panels/panel.h"
#include "session/session_json.h"
#include "tf/edit.h"
#include "widgets/theme.h"
#include "window/dock_space.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

QPoint placeOf(OpenWindow& w, const char* name) {
    QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
    QCoreApplication::processEvents();
    return w.child<QWidget>(name).mapTo(&w.window, QPoint(0, 0));
}

/// A turn of the event loop in which docks arrange themselves.
void arrange(OpenWindow& w) {
    QTest::qWait(50);
    w.settle();
}

/// Takes the slider where it is, holds it until the curve of equal shares is known, then drags it by `way` pixels.
void dragDensity(OpenWindow& w, double way) {
    auto& slider = w.child<QSlider>("densitySlider");
    const auto send = [&](QEvent::Type type, const QPointF& at, Qt::MouseButton button, Qt::MouseButtons held) {
        QMouseEvent event(type, at, slider.mapToGlobal(at), button, held, {});
        QCoreApplication::sendEvent(&slider, &event);
    };
    const int handle = slider.style()->pixelMetric(QStyle::PM_SliderLength, nullptr, &slider);
    const int left =
        QStyle::sliderPositionFromValue(slider.minimum(), slider.maximum(), slider.value(), slider.width() - handle);
    const QPointF from(left + handle / 2, slider.height() / 2), to = from + QPointF(way, 0);
    send(QEvent::MouseButtonPress, from, Qt::LeftButton, Qt::LeftButton);
    REQUIRE(waitFor([&] { return w.child<DensitySlider>("densityRow").curve() != nullptr; }));
    send(QEvent::MouseMove, to, Qt::NoButton, Qt::LeftButton);
    send(QEvent::MouseButtonRelease, to, Qt::LeftButton, Qt::NoButton);
    w.settle();
}

} // namespace

TEST_CASE("the table of keys fits the screen, scrolls and is searched", "[layout]") {
    OpenWindow w;
    bool looked = false;
    QTimer::singleShot(0, &w.window, [&] {
        auto* const dialog = w.window.findChild<QDialog*>("keysBox");
        if (dialog == nullptr) return;
        looked = true;
        CHECK(dialog->frameGeometry().height() <= w.window.screen()->availableSize().height());
        auto& table = *dialog->findChild<QTextBrowser*>("keysTable");
        CHECK(table.verticalScrollBar()->maximum() > 0); // there is more than fits
        CHECK(table.toPlainText().contains("Ctrl+Z"));
        QTest::keyClicks(dialog->findChild<QLineEdit*>("keysFind"), "undo");
        CHECK(table.toPlainText().contains("Ctrl+Z"));
        CHECK_FALSE(table.toPlainText().contains("Ctrl+O"));
        QTest::keyClick(dialog, Qt::Key_Escape);
    });
    w.child<QAction>("keysAction").trigger();
    CHECK(looked);
}

TEST_CASE("what is on looks different from what is off, in both themes", "[layout][theme]") {
    OpenWindow w;
    auto& live = w.child<QToolButton>("liveTargetsButton");
    for (const Theme theme : {Theme::Light, Theme::Dark}) {
        INFO(name(theme));
        applyTheme(*qApp, theme);
        const QPoint ground(4, live.height() / 2); // beside the letters
        const QColor off = live.grab().toImage().pixelColor(ground);
        w.child<QAction>("liveTargetsAction").trigger();
        REQUIRE(live.isChecked());
        const QColor on = live.grab().toImage().pixelColor(ground);
        CHECK(contrast(on, off) >= kMarkContrast);
        CHECK(contrast(theme::kPanel, on) >= kTextContrast); // its text
        w.child<QAction>("liveTargetsAction").trigger();
    }
    // What scales all opacities is a button, with a frame and a ground of its own.
    auto& all = w.child<QToolButton>("densityAll");
    CHECK_FALSE(all.autoRaise());
    CHECK(all.grab().toImage().pixelColor(4, all.height() / 2) != theme::kWindow);
}

TEST_CASE("nothing that is taken hold of moves when a message comes or goes", "[layout]") {
    OpenWindow w;
    const char* const held[] = {"densitySlider", "targetBars", "optimizeButton", "featuresTable"};
    std::vector<QPoint> before;
    for (const char* name : held) before.push_back(placeOf(w, name));
    w.optimizing().say("Out of reach: what lies in front hides it from this view. Another view, a lower opacity of the "
                       "outer feature or another colour would help. This is a sentence of several lines.");
    REQUIRE(w.child<QLabel>("panelMessage").isVisible());
    for (std::size_t i = 0; i < before.size(); ++i) {
        INFO(held[i]);
        CHECK(placeOf(w, held[i]) == before[i]);
    }
    w.optimizing().say({});
    REQUIRE_FALSE(w.child<QLabel>("panelMessage").isVisible());
    for (std::size_t i = 0; i < before.size(); ++i) {
        INFO(held[i]);
        CHECK(placeOf(w, held[i]) == before[i]);
    }
}

TEST_CASE("the density slider's place is part of the session", "[layout][density]") {
    OpenWindow w;
    w.document().setTf(tents(3, 0.3), "some");
    w.settle();
    auto& slider = w.child<QSlider>("densitySlider");
    dragDensity(w, 0);
    const int start = slider.value();
    dragDensity(w, -slider.width() / 4.0);
    const int left = slider.value();
    CHECK(left < start - 100);
    REQUIRE(w.services().store().session().density);
    CHECK(*w.services().store().session().density == Approx(left / 1000.0).margin(0.001));

    // Another step keeps it, though nobody knows the curve from there.
    w.document().setTf(withFeatureOpacities(tents(3), {0.6, 0.05, 0.3}), "others");
    w.settle();
    CHECK(w.child<DensitySlider>("densityRow").curve() == nullptr);
    CHECK(slider.value() == left);
    dragDensity(w, -slider.width() / 3.0);
    const int right = slider.value();
    CHECK(right != Approx(left).margin(20));
    // Undo brings it back, and so does the file.
    w.document().undo();
    w.document().undo();
    w.settle();
    CHECK(slider.value() == Approx(left).margin(1));
    w.document().redo();
    w.document().redo();
    w.settle();
    const QTemporaryDir folder;
    const std::string file = folder.filePath("s.pellucid.json").toStdString();
    writeSession(w.services().store().session(), file);
    OpenWindow again;
    again.opening().openPath(QString::fromStdString(file));
    REQUIRE(waitFor([&] { return again.services().store().session().density.has_value(); }));
    again.settle();
    CHECK(again.child<QSlider>("densitySlider").value() == Approx(right).margin(1));
}

TEST_CASE("a panel's key raises what lies behind a tab, and hides what is in front", "[layout]") {
    OpenWindow w;
    w.window.activateWindow();
    REQUIRE(QTest::qWaitForWindowActive(&w.window, kPatience));
    auto& curve = w.child<QDockWidget>("tfDock");
    auto& convergence = w.child<QDockWidget>("convergenceDock");
    auto* const action = w.window.findChild<QAction*>("tfAction");
    REQUIRE(action != nullptr);
    w.child<QAction>("showConvergence").trigger();
    arrange(w);
    REQUIRE(isInFront(convergence));
    REQUIRE_FALSE(isInFront(curve));
    REQUIRE_FALSE(curve.isHidden());
    CHECK(action->isChecked()); // it is open, if behind
    const auto press = [&] {
        QTest::keyClick(&w.window, Qt::Key_1, Qt::ControlModifier);
        arrange(w);
    };
    press();
    CHECK(isInFront(curve));
    CHECK_FALSE(curve.isHidden());
    CHECK(w.child<QWidget>("tfCanvas").visibleRegion().isEmpty() == false);
    CHECK(action->isChecked());
    CHECK_FALSE(convergence.isHidden()); // it lies behind now
    press();
    CHECK(curve.isHidden());
    CHECK_FALSE(action->isChecked());
    press();
    CHECK(isInFront(curve));
}

TEST_CASE("a panel that is closed gives its room back", "[layout]") {
    OpenWindow w;
    w.window.resize(1280, 800);
    arrange(w);
    const QSize picture = w.view().size();
    for (const PanelInfo& panel : panelRegistry()) {
        auto& dock = w.child<QDockWidget>((std::string(panel.id) + "Dock").c_str());
        if (!dock.isHidden()) continue;
        INFO(panel.id);
        auto& action = w.child<QAction>((std::string(panel.id) + "Action").c_str());
        action.trigger();
        arrange(w);
        CHECK(isInFront(dock));
        dock.close(); // by its cross
        arrange(w);
        CHECK(w.view().size() == picture);
        CHECK(w.window.size() == QSize(1280, 800));
    }
}

TEST_CASE("four features' influences are seen at once", "[layout]") {
    OpenWindow w;
    w.window.resize(1280, 800);
    TransferFunction tf = tents(4);
    const char* const names[] = {"fat", "soft tissue", "bone", "dense bone"};
    for (std::size_t f = 0; f < 4; ++f) tf.features[f].name = names[f];
    w.document().setTf(tf, "tissues");
    w.child<QAction>("influenceAction").trigger();
    REQUIRE(waitFor([&] { return w.document().influenceIsCurrent(); }));
    arrange(w);
    auto& table = w.child<QTableWidget>("influenceTable");
    REQUIRE(table.columnCount() == 4);
    CHECK(table.horizontalScrollBar()->maximum() == 0);
    for (int column = 0; column < 4; ++column) {
        CHECK(table.columnViewportPosition(column) + table.columnWidth(column) <= table.viewport()->width());
        for (int row = 0; row < 4; ++row)
            CHECK(table.columnWidth(column) >= table.fontMetrics().horizontalAdvance(table.item(row, column)->text()));
    }
    // All rows, too, but for many.
    CHECK(table.verticalScrollBar()->maximum() == 0);
}

TEST_CASE("the window fits a small screen, and one of twice the scale", "[layout][program]") {
    {
        OpenWindow w;
        // 1280 x 800 at twice the scale.
        CHECK(w.window.minimumSizeHint().width() <= 640);
        CHECK(w.window.minimumSizeHint().height() <= 400);
        w.window.resize(640, 400);
        arrange(w);
        CHECK(w.window.size() == QSize(640, 400));
        CHECK(w.window.rect().contains(QRect(placeOf(w, "volumeView"), w.view().size())));
    }
    const QTemporaryDir folder;
    const QString path = folder.filePath("window.png");
    QProcess process;
    QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
    environment.insert("XDG_CONFIG_HOME", folder.path());
    environment.insert("QT_SCALE_FACTOR", "2");
    process.setProcessEnvironment(environment);
    process.start(PELLUCID_PROGRAM, {"sample:disks", "--screenshot", path});
    REQUIRE(process.waitForFinished(kPatience));
    REQUIRE(process.exitCode() == 0);
    const QImage image(path);
    const QSize screen = QGuiApplication::primaryScreen()->size();
    CHECK(image.width() <= screen.width());
    CHECK(image.height() <= screen.height());
}
