// The whole window, with the mouse and the keys that people use.
#include "gui_support.h"

#include <cmath>
#include <fstream>

#include <glm/geometric.hpp>

#include <QAction>
#include <QApplication>
#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QDialog>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFile>
#include <QImage>
#include <QLabel>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QSignalSpy>
#include <QTableWidget>
#include <QTemporaryDir>
#include <QTimer>
#include <QToolButton>
#include <QUrl>
#include <QWheelEvent>

#include "image_io/image_file.h"
#include "optimize/refine/refine.h"
#include "render/camera_motion.h"
#include "session/home_view.h"
#include "tf/formats/tf_json.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

std::vector<double> shownVws(const Document& document) {
    REQUIRE(document.measures());
    std::vector<double> vws;
    for (const FeatureMeasures& m : document.measures()->features) vws.push_back(m.vws);
    return vws;
}

/// What a volume opens with where nothing else is said.
TransferFunction automaticOf(const VolumeSource& source) {
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    return openScene(inputs).tf;
}

QDialog* errorDialog(MainWindow& window) { return window.findChild<QDialog*>("errorDialog"); }

void drop(QWidget& widget, const QString& path) {
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(path)});
    QDragEnterEvent enter(QPoint(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&widget, &enter);
    CHECK(enter.isAccepted());
    QDropEvent event(QPointF(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&widget, &event);
    CHECK(event.isAccepted());
}

// An optimization that goes on until it is stopped: nothing comes as near as that.
void startEndlessOptimization(OpenWindow& w) {
    w.child<QDoubleSpinBox>("toleranceSpin").setValue(0.0001);
    auto& method = w.child<QComboBox>("methodCombo");
    method.setCurrentIndex(method.findData(static_cast<int>(SearchMethod::Fixed)));
    w.document().setTargets({0.05, 0.05, 0.9});
    QTest::mouseClick(&w.child<QPushButton>("optimizeButton"), Qt::LeftButton);
    REQUIRE(w.optimizing().isRunning());
}

} // namespace

TEST_CASE("dragging a control point changes the picture, and undo brings it back", "[window]") {
    OpenWindow w;
    const TransferFunction tf = w.document().tf();
    const QImage before = w.picture();
    // The picture shows the volume: not one colour only.
    QSet<QRgb> colors;
    for (int x = 0; x < before.width(); x += 3) {
        for (int y = 0; y < before.height(); y += 3) colors.insert(before.pixel(x, y));
    }
    CHECK(colors.size() > 20);

    const ControlPoint& peak = tf.points[1];
    drag(w.canvas(), w.canvas().positionOf(peak.x, peak.opacity), w.canvas().positionOf(peak.x, 0.02));
    CHECK(w.document().tf().points[1].opacity < 0.1);
    const QImage after = w.picture();
    CHECK(after != before);
    CHECK(w.window.isWindowModified());

    w.child<QAction>("undoAction").trigger();
    CHECK(w.document().tf() == tf);
    CHECK(w.picture() == before);
    CHECK_FALSE(w.window.isWindowModified());
}

TEST_CASE("the picture follows while the mouse is still down", "[window]") {
    OpenWindow w;
    const QImage before = w.picture();
    const ControlPoint peak = w.document().tf().points[1];
    const QPointF from = w.canvas().positionOf(peak.x, peak.opacity), to = w.canvas().positionOf(peak.x, 0.01);
    QTest::mousePress(&w.canvas(), Qt::LeftButton, {}, from.toPoint());
    QMouseEvent move(QEvent::MouseMove, to, w.canvas().mapToGlobal(to), Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&w.canvas(), &move);
    CHECK(w.document().isPreviewing());
    CHECK(waitFor([&] { return w.view().grab().toImage().convertToFormat(QImage::Format_RGB32) != before; }));
    CHECK(w.document().isPreviewing());
    QTest::mouseRelease(&w.canvas(), Qt::LeftButton, {}, to.toPoint());
    CHECK_FALSE(w.document().isPreviewing());
}

TEST_CASE("optimizing brings the VWS bars to the targets, and undo everything back", "[window]") {
    OpenWindow w;
    w.child<QCheckBox>("exactSharesCheck").click();
    const TransferFunction tf = w.document().tf();
    const QImage before = w.picture();
    auto& bars = w.child<TargetBars>("targetBars");
    const QPointF handle = bars.handlePosition(2);
    drag(bars, handle, {bars.pixelOfShare(0.6), handle.y()});
    const std::vector<double> targets = w.document().targets();
    CHECK(targets[2] == Approx(0.6).margin(0.01));
    REQUIRE(objectiveOf(shownVws(w.document()), targets) > 0.03); // else there would be nothing to do
    const int steps = w.document().stepCount();                   // the target is one

    int ticks = 0;
    QTimer heart;
    QObject::connect(&heart, &QTimer::timeout, [&] { ++ticks; });
    heart.start(1);
    QTest::mouseClick(&w.child<QPushButton>("optimizeButton"), Qt::LeftButton);
    CHECK(w.optimizing().isRunning());
    CHECK_FALSE(w.child<QPushButton>("optimizeButton").isVisible());
    CHECK(w.child<QPushButton>("cancelButton").isVisible());
    CHECK_FALSE(w.child<QAction>("undoAction").isEnabled());
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    CHECK(ticks > 0); // the window went on living meanwhile
    w.settle();
    REQUIRE(w.document().measuresAreCurrent());
    // Measured anew, from the present transfer function.
    CHECK(objectiveOf(shownVws(w.document()), targets) < 0.03);
    CHECK(w.document().stepCount() == steps + 1);
    CHECK(w.picture() != before);

    w.child<QAction>("undoAction").trigger();
    CHECK(w.document().tf() == tf);
    CHECK(w.picture() == before);
}

TEST_CASE("a cancelled optimization changes nothing", "[window]") {
    OpenWindow w(40);
    const TransferFunction tf = w.document().tf();
    startEndlessOptimization(w);
    const Session session = w.services().store().committed().session;
    const int steps = w.document().stepCount(); // targets and settings are steps
    QTest::mouseClick(&w.child<QPushButton>("cancelButton"), Qt::LeftButton);
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    CHECK(w.document().tf() == tf);
    CHECK(w.services().store().session() == session);
    CHECK(w.document().stepCount() == steps);
    CHECK(w.child<QPushButton>("optimizeButton").isVisible());
    w.settle();
    CHECK(w.document().measuresAreCurrent());
}

TEST_CASE("bars and picture follow each move of an optimization", "[window]") {
    OpenWindow w;
    const TransferFunction tf = w.document().tf();
    startEndlessOptimization(w);
    // Stopped from inside the first change, so that it cannot have come to its end before.
    int changes = 0;
    const auto watch =
        QObject::connect(&w.services().store(), &SessionStore::changed, [&](const Scene& before, const Scene& after) {
            if (before.tf == after.tf || changes++ > 0) return;
            CHECK(w.document().isPreviewing());
            CHECK(w.document().committedTf() == tf);
            CHECK_FALSE(w.document().tf() == tf);
            w.optimizing().cancel();
        });
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    QObject::disconnect(watch);
    CHECK(changes > 1); // there, and back again
    CHECK(w.document().tf() == tf);
}

TEST_CASE("refining is one undo step", "[window]") {
    OpenWindow w;
    const TransferFunction tf = w.document().tf();
    const Histogram& histogram = w.document().histogram();
    QTest::mouseClick(&w.child<QPushButton>("refineButton"), Qt::LeftButton);
    CHECK_FALSE(w.document().tf() == tf);
    CHECK(edgeEnergy(edgeWeights(histogram, w.document().tf())) < edgeEnergy(edgeWeights(histogram, tf)));
    CHECK(w.document().stepCount() == 1);
    QTest::mouseClick(&w.child<QPushButton>("undoButton"), Qt::LeftButton);
    CHECK(w.document().tf() == tf);
    QTest::mouseClick(&w.child<QPushButton>("redoButton"), Qt::LeftButton);
    CHECK_FALSE(w.document().tf() == tf);
}

TEST_CASE("a file that cannot be opened gives a dialog in three parts, and the old volume stays", "[window]") {
    OpenWindow w;
    const auto volume = w.document().volume();
    const TransferFunction tf = w.document().tf();
    const QString missing = "/nonexistent/brain.nrrd";
    w.opening().openPath(missing);
    REQUIRE(waitFor([&] { return errorDialog(w.window) != nullptr; }));
    QDialog* dialog = errorDialog(w.window);
    for (const char* part : {"errorWhat", "errorWhere", "errorWhatToDo"}) {
        auto* label = dialog->findChild<QLabel*>(part);
        INFO(part);
        REQUIRE(label != nullptr);
        CHECK_FALSE(label->text().isEmpty());
    }
    CHECK(dialog->findChild<QLabel*>("errorWhere")->text().contains("brain.nrrd"));
    dialog->accept();
    CHECK(w.document().volume() == volume);
    CHECK(w.document().tf() == tf);
    w.settle();
}

TEST_CASE("a transfer function that cannot be read leaves the present one", "[window]") {
    OpenWindow w;
    const QTemporaryDir folder;
    const QString path = folder.filePath("bad.tf.json");
    std::ofstream(path.toStdString()) << "{\"format\":\"pellucid-tf\",\"version\":99}";
    const TransferFunction tf = w.document().tf();
    w.opening().openPath(path);
    REQUIRE(errorDialog(w.window) != nullptr);
    errorDialog(w.window)->accept();
    CHECK(w.document().tf() == tf);
    CHECK(w.document().stepCount() == 0);
}

TEST_CASE("a wrong transfer function at the start does not keep the volume from opening", "[window]") {
    OpenWindow w;
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    VolumeSource source;
    source.path = "sample:disks";
    source.sampleSize = 16;
    w.opening().openVolume(source, "/nonexistent/a.tf.json");
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    REQUIRE(errorDialog(w.window) != nullptr);
    errorDialog(w.window)->accept();
    CHECK(w.document().volume()->title.find("disks") != std::string::npos);
    w.settle();
    CHECK(w.document().tf() == automaticOf(source));
}

TEST_CASE("files that are dropped on the window are opened", "[window]") {
    OpenWindow w;
    const QTemporaryDir folder;
    const QString volumePath = folder.filePath("small.nrrd"), tfPath = folder.filePath("two.tf.json");
    writeNrrd(makeSample("disks", 16), volumePath.toStdString());
    TransferFunction two = tents(2, 0.25);
    two.range = ValueRange{-1000, 3000}; // made for other data than this
    writeTf(two, tfPath.toStdString());
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    drop(w.window, volumePath);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    CHECK(w.document().volume()->title == "small.nrrd");
    CHECK(w.window.windowTitle().startsWith("small.nrrd"));
    drop(w.window, tfPath);
    REQUIRE(waitFor([&] { return w.document().tf().features.size() == 2; }));
    CHECK(featureOpacities(w.document().tf()) == std::vector<double>{0.25, 0.25});
    CHECK(w.document().canUndo());                                 // opening a transfer function can be undone
    CHECK_FALSE(w.window.isWindowModified());                      // and it is saved already
    CHECK(w.child<QLabel>("noticeText").text().contains("-1000")); // whoever looks is told that it was stretched
    w.settle();
}

TEST_CASE("the mouse turns, pans and zooms, and R fits, Home goes back", "[window]") {
    OpenWindow w;
    VolumeView& view = w.view();
    const Camera start = w.document().camera();
    const QPointF middle(view.width() / 2.0, view.height() / 2.0);
    const auto& geometry = w.document().volume()->geometry();

    // The mouse is over the surface that draws, a child, which leaves it to the view.
    auto* surface = qobject_cast<QWidget*>(view.childAt(middle.toPoint()));
    REQUIRE(surface != nullptr);
    drag(*surface, middle, middle + QPointF(60, 25));
    const Camera turned = w.document().camera();
    CHECK_FALSE(turned == start);
    CHECK(turned.center == start.center);
    // Dragged to the right and down the front goes there, so the eye goes left and up.
    CHECK(viewAngles(turned, geometry).azimuth < viewAngles(start, geometry).azimuth);
    CHECK(viewAngles(turned, geometry).elevation > viewAngles(start, geometry).elevation);

    drag(view, middle, middle + QPointF(20, 0), Qt::MiddleButton);
    CHECK_FALSE(w.document().camera().center == turned.center);
    const Camera panned = w.document().camera();
    drag(view, middle, middle + QPointF(-20, 0), Qt::LeftButton, Qt::ShiftModifier);
    CHECK(glm::length(w.document().camera().center - turned.center) < 1e-6);
    CHECK_FALSE(w.document().camera() == panned);

    const double zoom = viewAngles(w.document().camera(), geometry).zoom;
    QWheelEvent wheel(middle, view.mapToGlobal(middle), {}, {0, 120}, Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase,
                      false);
    QCoreApplication::sendEvent(&view, &wheel);
    CHECK(viewAngles(w.document().camera(), geometry).zoom > zoom);
    const double closer = viewAngles(w.document().camera(), geometry).zoom;
    drag(view, middle, middle + QPointF(0, 80), Qt::RightButton);
    CHECK(viewAngles(w.document().camera(), geometry).zoom < closer);

    QTest::mouseDClick(&view, Qt::LeftButton, {}, middle.toPoint());
    const Camera fit = w.document().camera();
    CHECK(glm::length(fit.forward() - turned.forward()) < 1e-9);
    CHECK(glm::length(fit.eye - fittedView(w.services().scene(), turned).eye) < 1e-6);

    view.setFocus();
    QTest::keyClick(&view, Qt::Key_Left);
    CHECK_FALSE(w.document().camera() == fit);
    w.window.activateWindow(); // shortcuts belong to the active window
    REQUIRE(QTest::qWaitForWindowActive(&w.window, kPatience));
    const Vec3 direction = w.document().camera().forward();
    QTest::keyClick(&view, Qt::Key_Plus);
    QTest::keyClick(&view, Qt::Key_R);
    CHECK(glm::length(w.document().camera().forward() - direction) < 1e-9);
    const Camera byKey = w.document().camera(); // as a double-click fits from there
    QTest::mouseDClick(&view, Qt::LeftButton, {}, middle.toPoint());
    CHECK(glm::length(w.document().camera().eye - byKey.eye) < 1e-9);
    CHECK(w.document().camera().fovY == Approx(byKey.fovY));
    QTest::keyClick(&view, Qt::Key_Home);
    CHECK(glm::length(w.document().camera().eye - homeView(w.services().scene(), Projection::Perspective).eye) < 1e-9);
    QTest::keyClick(&view, Qt::Key_5); // from above
    CHECK(viewAngles(w.document().camera(), geometry).elevation == Approx(90));
    QTest::keyClick(&view, Qt::Key_P);
    CHECK(w.document().camera().projection == Projection::Orthographic);
    QTest::keyClick(&view, Qt::Key_P);
    CHECK(w.document().camera().projection == Projection::Perspective);
    w.settle();
}

TEST_CASE("turning the view changes the picture and measures anew", "[window]") {
    OpenWindow w;
    const QImage before = w.picture();
    const Measures measures = *w.document().measures();
    const QPointF middle(w.view().width() / 2.0, w.view().height() / 2.0);
    drag(w.view(), middle, middle + QPointF(150, 40));
    CHECK_FALSE(w.document().measuresAreCurrent());
    w.settle();
    CHECK(w.document().measuresAreCurrent());
    CHECK(w.document().measures()->visibilityHistogram != measures.visibilityHistogram);
    CHECK(w.picture() != before);
}

TEST_CASE("the influence dock foretells what raising an opacity does", "[window]") {
    OpenWindow w;
    CHECK_FALSE(w.document().influence()); // nobody has asked
    auto& dock = w.child<QDockWidget>("influenceDock");
    CHECK_FALSE(dock.isVisible());
    CHECK(w.child<QAction>("influenceAction").shortcut() == QKeySequence("Ctrl+I"));
    w.child<QAction>("influenceAction").trigger();
    REQUIRE(dock.isVisible());
    REQUIRE(waitFor([&] { return w.document().influenceIsCurrent(); }));
    w.settle();
    auto& table = w.child<QTableWidget>("influenceTable");
    REQUIRE(table.rowCount() == 3);
    REQUIRE(table.columnCount() == 3);
    const auto influence = *w.document().influence();
    CHECK(table.item(1, 0)->text() == QString::asprintf("%+.2g", influence[1][0]).replace('-', QChar(0x2212)));
    CHECK(table.item(1, 0)->toolTip().contains("by 0.01"));

    // W(x + δ) − W(x) = δ·∂W/∂x, up to the curvature (δ², 1e-4) and the engine's deviation.
    const std::vector<double> before = shownVws(w.document());
    constexpr double kStep = 0.01;
    std::vector<double> opacities = featureOpacities(w.document().tf());
    opacities[0] += kStep;
    w.document().setTf(withFeatureOpacities(w.document().tf(), opacities), "raise");
    CHECK_FALSE(w.document().influenceIsCurrent());
    REQUIRE(waitFor([&] { return w.document().influenceIsCurrent() && w.document().measuresAreCurrent(); }));
    const std::vector<double> after = shownVws(w.document());
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(after[i] - before[i] == Approx(kStep * influence[i][0]).margin(2e-4));
        largest = std::max(largest, std::abs(after[i] - before[i]));
    }
    CHECK(largest > 1.5e-3); // there was something to foretell

    w.child<QAction>("copyInfluenceAction").trigger();
    const QStringList lines = QApplication::clipboard()->text().split('\n', Qt::SkipEmptyParts);
    REQUIRE(lines.size() == 4);
    CHECK(lines[1].split('\t').size() == 4);
    CHECK(lines[1].split('\t')[1].toDouble() == Approx((*w.document().influence())[0][0]));

    // The same table tells who hides whom: what comes back of a feature without another one.
    auto& what = w.child<QComboBox>("influenceCombo");
    const QImage shown = table.grab().toImage();
    what.setFocus();
    QTest::keyClick(&what, Qt::Key_Down);
    REQUIRE(what.currentIndex() == 1);
    const OcclusionMatrix hidden = *w.document().occlusion();
    CHECK(hidden[2][0] > 0.05); // the outermost tent of the shells lies before the innermost
    CHECK(hidden[0][0] == 0);
    CHECK(table.item(2, 0)->text() == QString("%1 %").arg(std::lround(100 * hidden[2][0])));
    CHECK(table.item(2, 0)->toolTip().contains("f1 hides"));
    CHECK(table.grab().toImage() != shown);
    std::vector<double> without = featureOpacities(w.document().tf());
    without[0] = 0;
    const auto visible = [&] { return w.document().measures()->features[2].visibility; };
    const double before2 = visible();
    w.document().setTf(withFeatureOpacities(w.document().tf(), without), "remove");
    REQUIRE(waitFor([&] { return w.document().measuresAreCurrent(); }));
    CHECK(visible() > before2);

    dock.close(); // what nobody sees is not measured
    w.document().setCamera(cameraFromView(w.document().volume()->geometry(), 70, 10, 1, Projection::Perspective));
    w.settle();
    CHECK(w.document().measuresAreCurrent());
    CHECK_FALSE(w.document().influenceIsCurrent());
    w.child<QAction>("influenceAction").trigger(); // and shown again it is
    CHECK(waitFor([&] { return w.document().influenceIsCurrent(); }));
}

TEST_CASE("a saved image can be read, in its size and with its background", "[window]") {
    OpenWindow w;
    const QTemporaryDir folder;
    QSignalSpy saved(&w.saving(), &SaveController::imageSaved);
    for (const bool transparent : {false, true}) {
        const QString path = folder.filePath(transparent ? "clear.png" : "seen.png");
        w.saving().saveImage({path, {160, 100}, transparent});
        REQUIRE(waitFor([&] { return saved.count() == (transparent ? 2 : 1); }));
        const Image image = readImage(path.toStdString());
        CHECK(image.width == 160);
        CHECK(image.height == 100);
        CHECK(image.pixel(0, 0)[3] == (transparent ? 0.0f : 1.0f)); // the corner sees past the volume
        CHECK(image.pixel(80, 50)[3] > 0.1f);
    }
    w.saving().saveImage({folder.filePath("picture.xyz"), {160, 100}, false});
    REQUIRE(errorDialog(w.window) != nullptr);
    errorDialog(w.window)->accept();
    w.saving().saveImage({"/nonexistent/folder/a.png", {32, 32}, false});
    REQUIRE(waitFor([&] {
        const auto dialogs = w.window.findChildren<QDialog*>("errorDialog");
        return std::any_of(dialogs.begin(), dialogs.end(), [](QDialog* d) { return d->isVisible(); });
    }));
    for (QDialog* dialog : w.window.findChildren<QDialog*>("errorDialog")) dialog->accept();
}

TEST_CASE("a saved transfer function is the one that is shown", "[window]") {
    OpenWindow w;
    const QTemporaryDir folder;
    const QString path = folder.filePath("mine.tf.json");
    w.document().setTf(tents(3, 0.2), "Tents"); // of colours that 8 bits hold exactly
    CHECK(w.window.isWindowModified());
    REQUIRE(w.saving().saveTf(path));
    CHECK_FALSE(w.window.isWindowModified());
    TransferFunction read = readTf(path.toStdString());
    REQUIRE(read.range);
    CHECK(*read.range == w.document().volume()->range());
    CHECK(read.points == w.document().tf().points);
    CHECK(read.features == w.document().tf().features);
    CHECK_FALSE(w.saving().saveTf("/nonexistent/folder/mine.tf.json"));
    REQUIRE(errorDialog(w.window) != nullptr);
    errorDialog(w.window)->accept();
}

TEST_CASE("the transfer function is saved as a drawing, over the histogram", "[window]") {
    OpenWindow w;
    const QTemporaryDir folder;
    w.document().setTf(tents(3, 0.2), "Tents");
    CHECK(w.child<QAction>("saveTfDrawingAction").isEnabled());
    REQUIRE(w.saving().saveTfDrawing(folder.filePath("tf.svg")));
    QFile file(folder.filePath("tf.svg"));
    REQUIRE(file.open(QIODevice::ReadOnly));
    const QByteArray svg = file.readAll();
    CHECK(svg.contains("voxels (logarithmic)"));
    CHECK(svg.contains("opacity per d0"));
    CHECK(svg.contains(QByteArray::fromStdString("\"" + hexFromRgb(tents(3).points[1].color) + "\"")));
    REQUIRE(w.saving().saveTfDrawing(folder.filePath("tf.png")));
    CHECK_FALSE(QImage(folder.filePath("tf.png")).isNull());
}

TEST_CASE("closing asks about unsaved changes", "[window]") {
    OpenWindow w;
    w.document().setTf(tents(2), "Tents");
    const auto answer = [](QMessageBox::StandardButton button, bool& asked) {
        auto* timer = new QTimer;
        QObject::connect(timer, &QTimer::timeout, [timer, button, &asked] {
            auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
            if (box == nullptr) return;
            asked = true;
            timer->deleteLater();
            timer->stop();
            QTest::mouseClick(box->button(button), Qt::LeftButton);
        });
        timer->start(10);
    };
    bool asked = false;
    answer(QMessageBox::Cancel, asked);
    CHECK_FALSE(w.window.close());
    CHECK(asked);
    CHECK(w.window.isVisible());
    asked = false;
    answer(QMessageBox::Discard, asked);
    CHECK(w.window.close());
    CHECK(asked);
    CHECK_FALSE(w.window.isVisible());
}

TEST_CASE("a window may be closed and go while its jobs run", "[window]") {
    for (const bool optimizing : {true, false}) {
        auto w = std::make_unique<OpenWindow>(48);
        if (optimizing) {
            startEndlessOptimization(*w);
            w->services().store().setClean(); // else it asks
        } else {
            w->refining().refine(); // a measurement follows; the picture is being drawn
            w->document().undo();
            VolumeSource source;
            source.path = "sample:knee";
            w->opening().openVolume(source);
            w->saving().saveImage({QDir::tempPath() + "/never.tiff", {4000, 3000}, false});
        }
        CHECK(w->window.close());
        w.reset();
        QCoreApplication::processEvents();
    }
    QFile::remove(QDir::tempPath() + "/never.tiff");
}

TEST_CASE("opening another volume ends an optimization and starts afresh", "[window]") {
    OpenWindow w;
    startEndlessOptimization(w);
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    VolumeSource source;
    source.path = "sample:disks";
    source.sampleSize = 20;
    w.opening().openVolume(source, "tents:3");
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    const TransferFunction tf = w.document().tf();
    CHECK(tf.points == tents(3).points);
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    w.settle();
    CHECK(w.document().tf() == tf); // nothing of the old run came after it
    CHECK(w.document().measuresAreCurrent());
    CHECK_FALSE(w.document().canUndo());
}

TEST_CASE("opening can be cancelled, and the old volume stays", "[window]") {
    OpenWindow w;
    const auto volume = w.document().volume();
    VolumeSource source;
    source.path = "sample:knee"; // takes seconds
    w.opening().openVolume(source);
    auto& cancel = w.child<QToolButton>("backgroundCancel");
    CHECK(cancel.isVisible());
    CHECK_FALSE(w.window.isSettled());
    QTest::mouseClick(&cancel, Qt::LeftButton);
    CHECK_FALSE(cancel.isVisible());
    w.settle();
    CHECK(w.document().volume() == volume);
    CHECK(errorDialog(w.window) == nullptr);
}

TEST_CASE("volumes with nothing to see open and say so", "[window]") {
    OpenWindow w;
    const QTemporaryDir folder;
    const Geometry geometry{{6, 5, 4}, {1, 1, 1}, {0, 0, 0}};
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    auto& notice = w.child<QLabel>("noticeText");

    const QString constant = folder.filePath("constant.nrrd"), empty = folder.filePath("empty.nrrd");
    writeNrrd(Volume(geometry, std::vector<float>(120, 7.0f)), constant.toStdString());
    writeNrrd(Volume(geometry, std::vector<float>(120, std::nanf(""))), empty.toStdString());
    w.opening().openPath(constant);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    CHECK(notice.text() == "All voxels have the value 7."); // what the loader says, once
    w.settle();
    w.opening().openPath(empty);
    REQUIRE(waitFor([&] { return opened.count() == 2; }));
    CHECK(notice.text() == "No voxel has a valid value.");
    w.settle();
    w.refining().refine(); // nothing to do, and no harm
    w.settle();
}

TEST_CASE("without OpenGL the CPU draws the same scene", "[window]") {
    OpenWindow gl(24, ViewRenderer::Gl);
    OpenWindow cpu(24, ViewRenderer::Cpu);
    CHECK(cpu.view().rendererName() == "CPU");
    const QImage a = gl.picture(), b = cpu.picture();
    REQUIRE(a.size() == b.size());
    double difference = 0;
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) {
            const QColor p = a.pixelColor(x, y), q = b.pixelColor(x, y);
            difference += std::abs(p.red() - q.red()) + std::abs(p.green() - q.green()) + std::abs(p.blue() - q.blue());
        }
    }
    // Two renderers of one integral: on average within 2 of 255 per channel.
    CHECK(difference / (3.0 * a.width() * a.height()) < 2.0);
    drag(cpu.view(), {200, 200}, {300, 220});
    CHECK(cpu.picture() != b);
}
