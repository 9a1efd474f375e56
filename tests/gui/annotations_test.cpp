// Annotations in the window: switches, undo, saved pictures, views that speak anatomy.
#include "gui_support.h"

#include <QAction>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLabel>
#include <QPainter>
#include <QSignalSpy>
#include <QTemporaryDir>

#include "image_io/image_file.h"
#include "render/annotation_raster.h"
#include "widgets/mark_painter.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// Pixels that differ within a part of the picture, in shares of its sides.
int differences(const QImage& a, const QImage& b, double left, double top, double right, double bottom) {
    REQUIRE(a.size() == b.size());
    int count = 0;
    for (int y = static_cast<int>(top * a.height()); y < static_cast<int>(bottom * a.height()); ++y)
        for (int x = static_cast<int>(left * a.width()); x < static_cast<int>(right * a.width()); ++x)
            count += a.pixel(x, y) != b.pixel(x, y) ? 1 : 0;
    return count;
}

/// A patient's head of 12³ voxels, RAS.
QString writePatient(const QTemporaryDir& folder) {
    const QString path = folder.filePath("head.nrrd");
    QByteArray bytes("NRRD0004\ntype: uint8\ndimension: 3\nspace: right-anterior-superior\nsizes: 12 12 12\n"
                     "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n\n");
    for (int n = 0; n < 12 * 12 * 12; ++n) bytes.append(static_cast<char>(n % 251));
    QFile file(path);
    REQUIRE(file.open(QIODevice::WriteOnly));
    REQUIRE(file.write(bytes) == bytes.size());
    return path;
}

} // namespace

TEST_CASE("the annotations can be switched, and undone", "[frame]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    SessionStore& store = w.services().store();
    CHECK(*store.session().reference == AnnotationChoice{}); // cube, letters, scale
    const QImage shown = w.picture();
    w.child<QAction>("frameAction").trigger();
    CHECK_FALSE(store.session().reference->on);
    CHECK_FALSE(w.child<QAction>("frameAction").isChecked());
    const QImage plain = w.picture();
    // The cube at the lower left, the bar at the lower right; the sample's file knows no anatomy, so no letters.
    CHECK(differences(shown, plain, 0, 0.7, 0.2, 1) > 200);
    CHECK(differences(shown, plain, 0.7, 0.8, 1, 1) > 100);
    CHECK(differences(shown, plain, 0, 0, 1, 0.7) == 0);
    store.undo();
    CHECK(w.picture() == shown);

    for (const AnnotationPartInfo& part : kAnnotationParts) {
        const QString id = QStringLiteral("frame%1%2Action").arg(QChar(part.name[0]).toUpper()).arg(part.name + 1);
        INFO(id.toStdString());
        auto& action = w.child<QAction>(id.toLatin1().constData());
        const AnnotationChoice before = *store.session().reference;
        CHECK(action.isChecked() == before.*part.shown);
        action.trigger();
        CHECK((*store.session().reference).*part.shown != before.*part.shown);
        CHECK(action.isChecked() != before.*part.shown);
        store.undo();
        CHECK(*store.session().reference == before);
        CHECK(action.isChecked() == before.*part.shown);
        store.redo();
    }
    // Axes, legend and title are on now, the others off.
    CHECK(store.stepCount() == static_cast<int>(std::size(kAnnotationParts)));
    const QImage others = w.picture();
    CHECK(differences(others, plain, 0, 0, 0.3, 0.1) > 50);  // title
    CHECK(differences(others, plain, 0.7, 0, 1, 0.4) > 200); // legend
    // A part that is switched on while all are hidden shows itself.
    w.child<QAction>("frameAction").trigger();
    w.child<QAction>("frameTitleAction").trigger();
    CHECK(store.session().reference->on);
    CHECK(store.session().reference->title);
}

TEST_CASE("no figure and no picture is computed anew for annotations", "[frame]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    w.child<QAction>("frameLegendAction").trigger();
    CHECK(w.document().measuresAreCurrent());
    CHECK(w.view().isComplete());
    CHECK(w.window.isSettled());
}

TEST_CASE("a saved picture has the marks where it is asked for them", "[frame]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    const QTemporaryDir folder;
    QSignalSpy saved(&w.saving(), &SaveController::imageSaved);
    const auto save = [&](const char* name, bool reference) {
        const QString path = folder.filePath(name);
        const auto count = saved.count();
        w.saving().saveImage({path, {320, 240}, false, reference});
        REQUIRE(waitFor([&] { return saved.count() == count + 1; }));
        return readImage(path.toStdString());
    };
    const Image plain = save("plain.png", false), marked = save("marked.png", true);
    CHECK(plain.rgba != marked.rgba);
    // The same marks over the plain picture; one of 255 steps, since that has been rounded already.
    Image expected = plain;
    drawMarks(expected, annotationMarks(annotationInput(pictureInput(w.services().scene(), 320, 240),
                                                        *w.services().store().session().reference)));
    double most = 0;
    for (std::size_t i = 0; i < expected.rgba.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(expected.rgba[i]) - marked.rgba[i]));
    CHECK(most < 1.01 / 255);
    w.child<QAction>("frameAction").trigger();
    CHECK(save("off.png", true).rgba == plain.rgba);
}

TEST_CASE("the dialog offers annotations where there are any", "[frame]") {
    for (const bool shown : {true, false}) {
        SaveImageDialog dialog("a.png", {400, 300}, shown, true);
        CHECK(dialog.options().annotated == shown);
        auto* box = dialog.findChild<QCheckBox*>("imageReference");
        REQUIRE(box != nullptr);
        CHECK(box->isEnabled() == shown);
        box->setChecked(false);
        CHECK_FALSE(dialog.options().annotated);
    }
}

TEST_CASE("views speak anatomy where the file does", "[frame]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    CHECK(w.child<QAction>("view1").text() == "Front");
    CHECK(w.child<QAction>("view5").text() == "Top");
    CHECK(w.child<QLabel>("clipAxisY").text() == "y");
    const QTemporaryDir folder;
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    w.opening().openPath(writePatient(folder));
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    w.settle();
    CHECK(w.child<QAction>("view1").text() == "Anterior");
    CHECK(w.child<QAction>("view2").text() == "Posterior");
    CHECK(w.child<QAction>("view6").text() == "Inferior");
    CHECK(w.child<QAction>("view6").toolTip().contains("radiologists"));
    CHECK(w.services().actions().keyTable().contains("Anterior"));
    CHECK(w.child<QLabel>("volumeLabel").toolTip().contains("L→R, P→A, I→S"));
    CHECK(w.child<QLabel>("clipAxisY").text() == "y  P→A");
    CHECK(w.child<QDoubleSpinBox>("clipYHi").toolTip().endsWith("From 0 to 100 % it runs P→A"));
    // World is LPS: left is +x. From the left the eye is there; from the feet the front, -y, is up.
    w.child<QAction>("view3").trigger();
    CHECK(w.document().camera().forward().x == Approx(-1));
    w.child<QAction>("view6").trigger();
    CHECK(w.document().camera().forward().z == Approx(1));
    CHECK(w.document().camera().trueUp().y == Approx(-1));
    CHECK(w.document().camera().right().x == Approx(1)); // the patient's left at the right
    const QImage shown = w.picture();
    w.child<QAction>("frameLettersAction").trigger();
    const QImage without = w.picture();
    CHECK(differences(shown, without, 0, 0.45, 0.1, 0.55) > 10);
    CHECK(differences(shown, without, 0.9, 0.45, 1, 0.55) > 10);
    CHECK(differences(shown, without, 0.45, 0, 0.55, 0.1) > 10);
    CHECK(differences(shown, without, 0.45, 0.9, 0.55, 1) > 10);
}

TEST_CASE("marks that are drawn again look as they did, and those that have changed as they are", "[marks]") {
    const double ratio = GENERATE(1.0, 1.25, 2.0);
    const auto text = [](const char* words, Vec2 at) {
        return Mark{
            AnnotationPart::Letters, Mark::Kind::Text, {at}, {1, 1, 1}, 1, 1.5, 2, {}, words, {10, 0}, {0, -10}};
    };
    std::vector<Mark> marks{text("A", {20.3, 30.6}),
                            {AnnotationPart::Scale, Mark::Kind::Line, {{40, 50}, {90.5, 50}}, {1, 0, 0}, 0.7, 2, 1},
                            {AnnotationPart::Cube, Mark::Kind::Area, {{5, 5}, {25, 8}, {12, 28}}, {0, 1, 0}, 0.5},
                            text("moves", {30, 80})};
    const auto drawn = [&](const auto& draw) {
        QImage image(QSize(static_cast<int>(120 * ratio), static_cast<int>(100 * ratio)), QImage::Format_RGB32);
        image.setDevicePixelRatio(ratio);
        image.fill(QColor(40, 60, 90));
        QPainter painter(&image);
        painter.setRenderHint(QPainter::Antialiasing);
        draw(painter);
        return image;
    };
    MarkPainter again;
    for (int frame = 0; frame < 5; ++frame) {
        marks.back().points[0].x += 3;
        if (frame == 3) marks[0].text = "P";
        const QImage kept = drawn([&](QPainter&painter) { again.draw(painter, marks); }),
                     anew = drawn([&](QPainter&painter) {
                         for (const Mark& mark : marks) drawMark(painter, mark);
                     });
        // A level or two of rounding: a mark that is kept is laid over the picture as a whole.
        int worst = 0;
        for (int y = 0; y < anew.height(); ++y)
            for (int x = 0; x < anew.width(); ++x) {
                const QColor a = anew.pixelColor(x, y), b = kept.pixelColor(x, y);
                worst = std::max({worst, std::abs(a.red() - b.red()), std::abs(a.green() - b.green()),
                                  std::abs(a.blue() - b.blue())});
            }
        INFO("frame " << frame << " at " << ratio);
        CHECK(worst <= 3);
    }
}
