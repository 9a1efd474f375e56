// What people stumbled over, each as it happened to them.
#include "gui_support.h"

#include <filesystem>
#include <fstream>

#include <QAction>
#include <QApplication>
#include <QCheckBox>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QTableWidget>
#include <QTemporaryDir>
#include <QTimer>
#include <QToolTip>

#include "image_io/image_file.h"
#include "render/camera_motion.h"
#include "tf/edit.h"
#include "widgets/input_habits.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

void send(QWidget& widget, QEvent::Type type, const QPointF& at, Qt::MouseButtons held) {
    QMouseEvent event(type, at, widget.mapToGlobal(at), type == QEvent::MouseMove ? Qt::NoButton : Qt::LeftButton, held,
                      Qt::NoModifier);
    QCoreApplication::sendEvent(&widget, &event);
}

/// Presses on the first peak and moves it down; the button stays pressed.
QPointF beginDrag(OpenWindow& w, double opacity = 0.1) {
    const ControlPoint peak = w.document().tf().points[1];
    const QPointF from = w.canvas().positionOf(peak.x, peak.opacity), to = w.canvas().positionOf(peak.x, opacity);
    send(w.canvas(), QEvent::MouseButtonPress, from, Qt::LeftButton);
    send(w.canvas(), QEvent::MouseMove, to, Qt::LeftButton);
    REQUIRE(w.document().isPreviewing());
    return to;
}

/// Answers the next modal dialog by `act`.
template <class Act>
void whenAsked(Act act) {
    auto* timer = new QTimer;
    QObject::connect(timer, &QTimer::timeout, [timer, act] {
        auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
        if (dialog == nullptr) return;
        timer->stop();
        timer->deleteLater();
        act(*dialog);
    });
    timer->start(10);
}

VolumeSource sampleSource(const std::string& name, int size) {
    VolumeSource source;
    source.path = "sample:" + name;
    source.sampleSize = size;
    return source;
}

} // namespace

TEST_CASE("a second picture that is saved does not discard the first", "[mend]") {
    OpenWindow w;
    const QTemporaryDir folder;
    const QString one = folder.filePath("one.png"), two = folder.filePath("two.png");
    w.saving().saveImage({one, {700, 500}, false});
    w.saving().saveImage({two, {64, 48}, false});
    w.settle();
    CHECK(readImage(one.toStdString()).width == 700);
    CHECK(readImage(two.toStdString()).width == 64);
}

TEST_CASE("delete during a drag deletes the point, and it does not come back", "[mend]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QPointF to = beginDrag(w);
    QTest::keyClick(&w.canvas(), Qt::Key_Delete);
    CHECK(w.document().tf().points.size() == start.points.size() - 1);
    send(w.canvas(), QEvent::MouseMove, to + QPointF(3, 20), Qt::LeftButton);
    send(w.canvas(), QEvent::MouseButtonRelease, to + QPointF(3, 20), Qt::NoButton);
    CHECK(w.document().tf().points.size() == start.points.size() - 1);
    w.document().undo(); // the deletion
    CHECK(w.document().tf().points[1].opacity == Approx(0.1).margin(0.01));
    w.document().undo(); // the drag
    CHECK(w.document().tf() == start);
}

TEST_CASE("redo during a drag redoes, and the drag is over", "[mend]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    w.document().setTf(tents(2), "Two");
    const TransferFunction two = w.document().tf();
    w.document().undo();
    const QPointF to = beginDrag(w);
    w.child<QAction>("redoAction").trigger();
    CHECK(w.document().tf() == two);
    send(w.canvas(), QEvent::MouseMove, to + QPointF(5, 5), Qt::LeftButton);
    send(w.canvas(), QEvent::MouseButtonRelease, to + QPointF(5, 5), Qt::NoButton);
    CHECK(w.document().tf() == two);
    w.document().undo();
    CHECK(w.document().tf() == start);
}

TEST_CASE("undo works while the very first drag is on", "[mend]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    CHECK_FALSE(w.child<QAction>("undoAction").isEnabled());
    const QPointF to = beginDrag(w);
    REQUIRE(w.child<QAction>("undoAction").isEnabled());
    w.child<QAction>("undoAction").trigger();
    CHECK(w.document().tf() == start);
    send(w.canvas(), QEvent::MouseMove, to + QPointF(0, 9), Qt::LeftButton);
    send(w.canvas(), QEvent::MouseButtonRelease, to, Qt::NoButton);
    CHECK(w.document().tf() == start);
    CHECK_FALSE(w.document().canUndo());
}

TEST_CASE("undo after a typed number undoes what the number did", "[mend]") {
    InputHabits habits;
    qApp->installEventFilter(&habits);
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    w.window.activateWindow();
    REQUIRE(QTest::qWaitForWindowActive(&w.window, kPatience));
    w.canvas().selectPoint(1);
    auto& box = w.child<QDoubleSpinBox>("pointOpacity");
    box.setFocus();
    box.selectAll();
    QTest::keyClicks(&box, QLocale().toString(0.25));
    QTest::keyClick(&box, Qt::Key_Return);
    QCoreApplication::processEvents();
    REQUIRE(w.document().tf().points[1].opacity == 0.25);
    QTest::keyClick(&box, Qt::Key_Z, Qt::ControlModifier);
    CHECK(w.document().tf() == start);
    CHECK(box.value() == start.points[1].opacity);
}

TEST_CASE("undoing a preset brings the targets back", "[mend]") {
    OpenWindow w;
    w.document().setTargets({0.2, 0.3, 0.5});
    w.child<QAction>("tents:6").trigger();
    CHECK(w.document().targets().size() == 6);
    w.document().undo();
    CHECK(w.document().targets() == std::vector<double>{0.2, 0.3, 0.5});
    w.document().undo(); // they are a step themselves
    CHECK(w.document().targets() == std::vector<double>(3, 1.0 / 3));
}

TEST_CASE("the table of keys says what the keys do", "[mend]") {
    OpenWindow w;
    const QString table = w.services().actions().keyTable();
    const auto says = [&](const QString& keys, const QString& what) {
        return table.contains(QStringLiteral("<td>%1&nbsp;&nbsp;</td><td>%2</td>").arg(keys, what));
    };
    CHECK(says("R, F", "Fit"));
    CHECK(says("Home", "Reset"));
    CHECK(says("Ctrl+Z", "Undo"));
    CHECK(says("Ctrl+I", "Influence"));
    // Every shortcut of the window is in it.
    for (const QAction* action : w.window.findChildren<QAction*>())
        if (!action->shortcut().isEmpty() && !action->objectName().isEmpty()) {
            INFO(action->objectName().toStdString() << ": " << action->shortcut().toString().toStdString());
            CHECK(table.contains(action->shortcut().toString(QKeySequence::NativeText).toHtmlEscaped()));
        }
}

TEST_CASE("no two actions have the same keys", "[actions]") {
    OpenWindow w;
    QMap<QString, QString> owners;
    for (const QAction* action : w.window.findChildren<QAction*>()) {
        if (action->shortcutContext() != Qt::WindowShortcut) continue;
        for (const QKeySequence& key : action->shortcuts()) {
            INFO(key.toString().toStdString() << ": " << action->objectName().toStdString() << " and "
                                              << owners.value(key.toString()).toStdString());
            CHECK_FALSE(owners.contains(key.toString()));
            owners[key.toString()] = action->objectName();
        }
    }
    CHECK(owners.size() > 15);
}

TEST_CASE("a measurement that fails is said to have failed", "[mend]") {
    StoreAlone w;
    w.store.open(sampleScene("shells", 12, tents(3)));
    Camera inside = w.store.scene().camera; // no engine measures from there
    inside.eye = w.store.scene().volume->geometry().boxCenter() + Vec3(0.5, 0.25, 0.125);
    w.store.setCamera(inside);
    REQUIRE(waitFor([&] { return w.results.state() == Results::State::Failed; }));
    CHECK_FALSE(w.results.isBusy());
    REQUIRE(w.results.failure());
    CHECK(w.results.measures() == nullptr);
    w.store.undoCamera();
    CHECK(waitFor([&] { return w.results.state() == Results::State::Current; }));
    CHECK_FALSE(w.results.failure());
}

TEST_CASE("a new volume is never seen under the old transfer function", "[mend]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    w.child<QAction>("tents:8").trigger();
    w.settle();
    int heard = 0;
    QObject::connect(&w.services().store(), &SessionStore::changed, &w.window,
                     [&](const Scene& before, const Scene& after) {
                         if (before.volume == after.volume) return;
                         ++heard;
                         CHECK(after.tf.features.size() == 3); // its own, from the first moment on
                         CHECK(w.services().scene().volume == after.volume);
                     });
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    // Of the old volume nothing is left as soon as the new one is there.
    QImage seen;
    QObject::connect(&w.opening(), &OpenController::opened, &w.window,
                     [&] { seen = w.view().grab().toImage().convertToFormat(QImage::Format_RGB32); });
    w.opening().openVolume(sampleSource("disks", 20));
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    CHECK(heard == 1);
    REQUIRE_FALSE(seen.isNull());
    int drawn = 0;
    for (int y = 0; y < seen.height() * 7 / 10; y += 4) // below are cube and scale bar, of the new one
        for (int x = 0; x < seen.width(); x += 4) drawn += (seen.pixel(x, y) & 0xffffffu) != 0;
    CHECK(drawn == 0);
    w.settle();
}

TEST_CASE("what is said of an optimization goes when it is not true any more", "[mend]") {
    OpenWindow w;
    w.child<QCheckBox>("exactSharesCheck").click(); // else the floors, not the shares, may be what is spoken of
    const auto optimize = [&] {
        w.document().setTargets({0.2, 0.2, 0.6});
        w.optimizing().start();
        REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
        w.settle();
        REQUIRE(w.child<QLabel>("panelMessage").text().startsWith("On target"));
    };
    const auto silent = [&] { return w.child<QLabel>("panelMessage").text().isEmpty(); };
    optimize();
    w.document().undo();
    CHECK(silent());
    w.document().redo();
    optimize();
    w.document().setTf(withPointMoved(w.document().tf(), 1, 0.2, 0.9), "Move");
    CHECK(silent());
    optimize();
    w.document().setTarget(0, 0.9);
    CHECK(silent());
    optimize();
    w.document().setCamera(cameraFromView(w.document().volume()->geometry(), 80, 5, 1, Projection::Perspective));
    CHECK(silent());
}

TEST_CASE("turning the view during an optimization shows the figures of before as such", "[mend]") {
    OpenWindow w;
    w.document().setTargets({0.2, 0.2, 0.6});
    bool turned = false, shownAsOld = false;
    QObject::connect(&w.optimizing(), &OptimizeController::moved, &w.window, [&] {
        if (w.optimizing().move() < 0 || turned) return;
        turned = true;
        CHECK(w.services().results().vwsIsCurrent()); // of this very move
        w.document().setCamera(cameraFromView(w.document().volume()->geometry(), -70, 30, 1, Projection::Perspective));
        shownAsOld = !w.services().results().vwsIsCurrent();
    });
    w.optimizing().start();
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    REQUIRE(turned);
    CHECK(shownAsOld);
    CHECK(w.optimizing().message().contains("restarted from the new view"));
    w.settle();
    CHECK(w.document().measuresAreCurrent());
    if (w.optimizing().message().startsWith("On target")) // of this view
        CHECK(*w.services().results().objective() < w.services().store().session().optimize->tolerance);
}

TEST_CASE("raw files are among the recent ones, with their layout", "[mend]") {
    QSettings().remove("recentFiles");
    OpenWindow w;
    const QTemporaryDir folder;
    const QString path = folder.filePath("block.raw");
    std::ofstream(path.toStdString(), std::ios::binary) << std::string(4 * 5 * 6, '\x20') + std::string(120, '\x40');
    VolumeSource source;
    source.path = path.toStdString();
    source.raw = parseRawLayout("4,5,6,u16,big");
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    w.opening().openVolume(source);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    QMenu* menu = w.services().actions().menu("&File/Open &recent");
    REQUIRE(menu != nullptr);
    REQUIRE(menu->actions().first()->text() == "block.raw");
    w.opening().openVolume(sampleSource("disks", 16));
    REQUIRE(waitFor([&] { return opened.count() == 2; }));
    menu->actions().first()->trigger();
    REQUIRE(waitFor([&] { return opened.count() == 3; }));
    CHECK(w.document().volume()->dims() == Int3(4, 5, 6));
    CHECK(w.document().volume()->sampleType() == SampleType::U16);
    w.settle();
    QSettings().remove("recentFiles");
}

TEST_CASE("a file of an unknown suffix asks for its layout", "[mend]") {
    OpenWindow w;
    const QTemporaryDir folder;
    const QString path = folder.filePath("scan_4x4x4_uint8.data");
    std::ofstream(path.toStdString(), std::ios::binary) << std::string(63, 'a') + "z";
    QString asked;
    whenAsked([&](QDialog& dialog) {
        asked = dialog.objectName();
        dialog.accept();
    });
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    w.opening().openPath(path);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    CHECK(asked == "rawDialog");
    CHECK(w.document().volume()->dims() == Int3(4, 4, 4));
    w.settle();
}

TEST_CASE("the selection stays with its point through undo", "[mend]") {
    OpenWindow w;
    w.canvas().selectPoint(0);
    w.canvas().removeSelected(); // the points behind it move up
    w.canvas().selectPoint(3);
    const ControlPoint chosen = w.document().tf().points[3];
    w.document().undo(); // and down again
    REQUIRE(w.canvas().selectedPoint() >= 0);
    CHECK(w.document().tf().points[static_cast<std::size_t>(w.canvas().selectedPoint())] == chosen);
    w.document().redo();
    REQUIRE(w.canvas().selectedPoint() == 3);
    w.canvas().addPoint(0.01, 0.2);
    REQUIRE(w.canvas().selectedPoint() >= 0);
    w.document().undo(); // the point that is selected is gone: Delete hits nobody
    CHECK(w.canvas().selectedPoint() == -1);
    const TransferFunction before = w.document().tf();
    QTest::keyClick(&w.canvas(), Qt::Key_Delete);
    CHECK(w.document().tf() == before);
}

TEST_CASE("no point, no numbers", "[mend]") {
    OpenWindow w;
    w.canvas().selectPoint(1);
    CHECK_FALSE(w.child<QDoubleSpinBox>("pointOpacity").text().isEmpty());
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    w.opening().openVolume(sampleSource("disks", 16));
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    CHECK(w.child<QLabel>("pointLabel").text() == "No point selected");
    CHECK(w.child<QDoubleSpinBox>("pointOpacity").text().isEmpty());
    CHECK(w.child<QDoubleSpinBox>("pointValue").text().isEmpty());
    w.canvas().selectPoint(0); // whose opacity is 0, the least
    CHECK(w.child<QDoubleSpinBox>("pointOpacity").text().startsWith('0'));
    CHECK_FALSE(w.child<QDoubleSpinBox>("pointValue").text().isEmpty());
    w.settle();
}

TEST_CASE("a target's handle is bright only under the mouse", "[mend]") {
    OpenWindow w;
    auto& bars = w.child<TargetBars>("targetBars");
    const QImage still = bars.grab().toImage();
    send(bars, QEvent::MouseMove, bars.handlePosition(1), Qt::NoButton);
    CHECK(bars.grab().toImage() != still);
    QEvent leave(QEvent::Leave);
    QCoreApplication::sendEvent(&bars, &leave);
    CHECK(bars.grab().toImage() == still);
}

TEST_CASE("influences of many features can be read", "[mend]") {
    OpenWindow w;
    w.child<QAction>("tents:8").trigger();
    w.child<QAction>("influenceAction").trigger();
    REQUIRE(waitFor([&] { return w.document().influenceIsCurrent(); }));
    w.settle();
    auto& table = w.child<QTableWidget>("influenceTable");
    REQUIRE(table.columnCount() == 8);
    CHECK(table.textElideMode() == Qt::ElideNone);
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 8; ++column) {
            const int needed = table.fontMetrics().horizontalAdvance(table.item(row, column)->text());
            CHECK(table.columnWidth(column) >= needed);
        }
}

TEST_CASE("tool tips stay inside the window", "[mend]") {
    InputHabits habits;
    qApp->installEventFilter(&habits);
    OpenWindow w;
    w.window.resize(900, 640);
    w.window.move(40, 40);
    w.window.activateWindow();
    REQUIRE(QTest::qWaitForWindowActive(&w.window, kPatience));
    const QPoint corner = w.window.mapToGlobal(QPoint(w.window.width() - 4, w.window.height() - 4));
    QToolTip::showText(corner, QString(120, 'x'), &w.window);
    const auto tip = [] {
        for (QWidget* widget : QApplication::topLevelWidgets())
            if (widget->inherits("QTipLabel") && widget->isVisible()) return widget;
        return static_cast<QWidget*>(nullptr);
    };
    REQUIRE(waitFor([&] { return tip() != nullptr; }));
    CHECK(waitFor([&] { return w.window.frameGeometry().contains(tip()->frameGeometry()); }));
    QToolTip::hideText();
}
