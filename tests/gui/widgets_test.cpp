#include "gui_support.h"

#include "window/notice_bar.h"

#include <cmath>
#include <fstream>

#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSlider>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QToolButton>
#include <zlib.h>

#include "dialogs/raw_dialog.h"
#include "panels/target_bars.h"
#include "view/cpu_surface.h"
#include "widgets/opacity_editor.h"
#include "widgets/sentence.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

struct Canvas {
    StoreAlone alone;
    Document& document = alone.document;
    Selection selection;
    TfCanvas canvas{alone.store, alone.results, selection};
    Canvas() {
        alone.store.open(sampleScene("shells", 12, tents(3)));
        canvas.resize(600, 200);
        canvas.show();
        REQUIRE(QTest::qWaitForWindowExposed(&canvas, kPatience));
    }
    QPointF at(int index) const {
        const ControlPoint& p = document.tf().points[static_cast<std::size_t>(index)];
        return canvas.positionOf(p.x, p.opacity);
    }
};

} // namespace

TEST_CASE("one drag of a point is one undo step", "[canvas]") {
    Canvas c;
    const TransferFunction start = c.document.tf();
    const QPointF to = c.canvas.positionOf(0.5, 0.9);
    drag(c.canvas, c.at(4), to);
    CHECK(c.document.tf().points[4].opacity == Approx(0.9).margin(0.01)); // a pixel is 1/140
    CHECK(c.document.stepCount() == 1);
    CHECK(c.canvas.selectedPoint() == 4);
    c.document.undo();
    CHECK(c.document.tf() == start);
}

TEST_CASE("the fine opacity axis spreads the small opacities", "[canvas]") {
    Canvas c;
    c.canvas.setFineOpacityAxis(false);
    const double plain = c.canvas.positionOf(0.5, 0).y() - c.canvas.positionOf(0.5, 0.008).y();
    c.canvas.setFineOpacityAxis(true);
    const double fine = c.canvas.positionOf(0.5, 0).y() - c.canvas.positionOf(0.5, 0.008).y();
    CHECK(fine == Approx(25 * plain)); // ∛0.008 = 0.2
    drag(c.canvas, c.at(4), c.canvas.positionOf(0.5, 0.01));
    CHECK(c.document.tf().points[4].opacity == Approx(0.01).margin(0.002));
}

TEST_CASE("a press that hardly moves selects and changes nothing", "[canvas]") {
    Canvas c;
    const TransferFunction start = c.document.tf();
    drag(c.canvas, c.at(4), c.at(4) + QPointF(1, 1));
    CHECK(c.document.tf() == start);
    CHECK(c.canvas.selectedPoint() == 4);
    drag(c.canvas, {300, 40}, {300, 40}); // beside all points
    CHECK(c.canvas.selectedPoint() == -1);
}

TEST_CASE("points are added by a double-click and removed by Delete", "[canvas]") {
    Canvas c;
    const TransferFunction start = c.document.tf();
    const QPointF place = c.canvas.positionOf(0.3, 0.7);
    QTest::mouseDClick(&c.canvas, Qt::LeftButton, {}, place.toPoint());
    REQUIRE(c.document.tf().points.size() == start.points.size() + 1);
    const int index = c.canvas.selectedPoint();
    REQUIRE(index >= 0);
    CHECK(c.document.tf().points[static_cast<std::size_t>(index)].x == Approx(0.3).margin(0.005));
    QTest::keyClick(&c.canvas, Qt::Key_Delete);
    CHECK(c.document.tf() == start);
    CHECK(c.document.stepCount() == 2);
}

TEST_CASE("keys move, fix and choose points", "[canvas]") {
    Canvas c;
    c.canvas.setFineOpacityAxis(false);
    c.canvas.selectPoint(4);
    const double before = c.document.tf().points[4].opacity;
    QTest::keyClick(&c.canvas, Qt::Key_Up);
    QTest::keyClick(&c.canvas, Qt::Key_Up);
    CHECK(c.document.tf().points[4].opacity == Approx(before + 2.0 / 128));
    CHECK(c.document.stepCount() == 1);
    QTest::keyClick(&c.canvas, Qt::Key_Space);
    CHECK(c.document.tf().points[4].fixed);
    QTest::keyClick(&c.canvas, Qt::Key_PageDown);
    CHECK(c.canvas.selectedPoint() == 5);
    QTest::keyClick(&c.canvas, Qt::Key_Escape);
    CHECK(c.canvas.selectedPoint() == -1);
}

TEST_CASE("Escape takes a drag back", "[canvas]") {
    Canvas c;
    const TransferFunction start = c.document.tf();
    const QPointF from = c.at(4);
    QTest::mousePress(&c.canvas, Qt::LeftButton, {}, from.toPoint());
    QMouseEvent move(QEvent::MouseMove, from + QPointF(0, -30), c.canvas.mapToGlobal(from + QPointF(0, -30)),
                     Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&c.canvas, &move);
    CHECK_FALSE(c.document.tf() == start);
    QTest::keyClick(&c.canvas, Qt::Key_Escape);
    CHECK(c.document.tf() == start);
    QTest::mouseRelease(&c.canvas, Qt::LeftButton, {}, from.toPoint());
    CHECK(c.document.tf() == start);
    CHECK_FALSE(c.document.canUndo());
}

TEST_CASE("target handles follow the mouse and the keys", "[bars]") {
    StoreAlone w;
    Document& document = w.document;
    w.store.open(sampleScene("shells", 12, tents(3)));
    TargetBars bars(w.store, w.results);
    bars.resize(400, 200);
    bars.show();
    REQUIRE(QTest::qWaitForWindowExposed(&bars, kPatience));
    const QPointF handle = bars.handlePosition(2);
    drag(bars, handle, {bars.pixelOfShare(0.75), handle.y()});
    CHECK(document.targets()[2] == Approx(0.75).margin(0.01));
    CHECK(document.targets()[0] == Approx(document.targets()[1]));
    CHECK(bars.currentFeature() == 2);
    const double before = document.targets()[2];
    QTest::keyClick(&bars, Qt::Key_Left);
    CHECK(document.targets()[2] == Approx(before - 0.01));
    QTest::keyClick(&bars, Qt::Key_Up);
    QTest::keyClick(&bars, Qt::Key_Right, Qt::ShiftModifier);
    CHECK(bars.currentFeature() == 1);
    CHECK(document.targets()[1] > document.targets()[0]);
    bars.setReadOnly(true);
    const auto targets = document.targets();
    drag(bars, bars.handlePosition(0), {bars.pixelOfShare(0.9), bars.handlePosition(0).y()});
    CHECK(document.targets() == targets);
}

TEST_CASE("the opacity slider is finer near zero and tells drags from edits", "[opacity]") {
    OpacityEditor editor;
    auto* slider = editor.findChild<QSlider*>("opacitySlider");
    auto* spin = editor.findChild<QDoubleSpinBox*>("opacitySpin");
    REQUIRE(slider != nullptr);
    REQUIRE(spin != nullptr);
    double dragged = -1, edited = -1;
    bool released = false;
    QObject::connect(&editor, &OpacityEditor::dragged, &editor, [&](double v) { dragged = v; });
    QObject::connect(&editor, &OpacityEditor::edited, &editor, [&](double v) { edited = v; });
    QObject::connect(&editor, &OpacityEditor::released, &editor, [&] { released = true; });
    editor.setOpacity(0.25);
    CHECK(slider->value() == 500); // √0.25 of 1000
    CHECK(dragged == -1);
    CHECK(edited == -1);
    slider->setSliderDown(true);
    slider->setSliderPosition(100);
    CHECK(dragged == Approx(0.01));
    CHECK(edited == -1);
    slider->setSliderDown(false);
    CHECK(released);
    spin->setValue(0.5);
    CHECK(edited == Approx(0.5));
    CHECK(editor.opacity() == Approx(0.5));
}

TEST_CASE("the raw dialog opens only what fits the file", "[raw]") {
    const QTemporaryDir folder;
    const QString path = folder.filePath("data_8x4x2_uint16.raw");
    std::ofstream(path.toStdString(), std::ios::binary) << std::string(8 * 4 * 2 * 2, 'x');
    RawDialog dialog(QStringList{path});
    auto* open = dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Open);
    CHECK(open->isEnabled());
    CHECK(dialog.layoutOfFile().dims == Int3(8, 4, 2));
    CHECK(dialog.layoutOfFile().type == SampleType::U16);
    dialog.findChild<QSpinBox*>("rawDimz")->setValue(3);
    CHECK_FALSE(open->isEnabled());
    CHECK(dialog.findChild<QLabel*>("rawVerdict")->text().contains("64")); // one more plane: 8·4·2 bytes
}

TEST_CASE("the raw dialog guesses by the voxels, packed ones, too, and shows a slice", "[raw]") {
    const QTemporaryDir folder;
    const QString path = folder.filePath("data.bin.gz");
    std::string bytes; // 24 x 20 x 16 of u16, a smooth slope along each axis
    for (int z = 0; z < 16; ++z)
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 24; ++x) {
                const int value = 300 + 11 * x + 17 * y + 23 * z;
                bytes += static_cast<char>(value & 255);
                bytes += static_cast<char>(value >> 8);
            }
    gzFile out = gzopen(path.toUtf8().constData(), "wb");
    gzwrite(out, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(out);
    RawDialog dialog(QStringList{path});
    auto* open = dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Open);
    CHECK_FALSE(open->isEnabled()); // it is being unpacked
    REQUIRE(waitFor([&] { return open->isEnabled(); }));
    CHECK(dialog.layoutOfFile().dims == Int3(24, 20, 16));
    CHECK(dialog.layoutOfFile().type == SampleType::U16);
    auto* picture = dialog.findChild<QLabel*>("rawPicture");
    REQUIRE(waitFor([&] { return !picture->pixmap().isNull(); }));
    CHECK(picture->pixmap().width() == 220);
    CHECK(picture->pixmap().height() == 183); // 220 · 20 / 24
    // Another one of the list is taken as a whole.
    auto* guesses = dialog.findChild<QComboBox*>("rawGuesses");
    REQUIRE(guesses->count() > 1);
    guesses->setCurrentIndex(1);
    Q_EMIT guesses->activated(1);
    CHECK_FALSE(dialog.layoutOfFile() == RawLayout{{24, 20, 16}, SampleType::U16});
    CHECK(open->isEnabled());
    CHECK_FALSE(dialog.spacing()); // nothing is said of it
    dialog.findChild<QDoubleSpinBox*>("spacingX")->setValue(2.5e-7);
    dialog.findChild<QComboBox*>("spacingUnit")->setCurrentText("m");
    CHECK(dialog.spacing() == GridSpacing{{2.5e-7, 1, 1}, LengthUnit::Metre});
    CHECK(dialog.findChild<QDoubleSpinBox*>("spacingX")->text() == "x  0.00000025");
}

TEST_CASE("what the core says becomes a sentence, and names stay as they are", "[notices]") {
    CHECK(asSentence("no voxel has a valid value") == "No voxel has a valid value.");
    CHECK(asSentence("cannot write the file, /tmp/a b.png, choose another folder") ==
          "Cannot write the file, /tmp/a b.png, choose another folder.");
    CHECK(asSentence("The board is left out.") == "The board is left out.");
    CHECK(asSentence("Is it there?") == "Is it there?");
    for (const char* name : {"page.html", "f07", "scale_factor", "\"a b\"", "t:", "/data/a"})
        CHECK(asSentence(QString(name) + " is odd") == QString(name) + " is odd.");

    Notices notices;
    notices.add({"no voxel has a valid value", {}});
    notices.add({"no voxel has a valid value", {}});
    REQUIRE(notices.all().size() == 1);
    CHECK(notices.all()[0].text == "No voxel has a valid value.");
    notices.remove("no voxel has a valid value"); // as it was added
    CHECK(notices.all().empty());
}

TEST_CASE("notices stay until they are dismissed", "[notices]") {
    Notices notices;
    QWidget window;
    NoticeBar bar(notices, &window);
    CHECK(bar.isHidden());
    notices.add({"a", {}});
    notices.add({"b", {}});
    notices.add({"a", {}});
    CHECK_FALSE(bar.isHidden());
    CHECK(bar.findChild<QLabel*>("noticeText")->text() == "A.\nB.");
    bar.findChild<QToolButton*>("noticeClose")->click();
    CHECK(bar.isHidden());
    CHECK(notices.all().empty());

    // What can be done about one is a click away, and then it is gone.
    int done = 0;
    notices.add({"c", {{"Do it", [&] { ++done; }}}});
    auto* button = bar.findChild<QPushButton*>("noticeChoice0");
    REQUIRE(button != nullptr);
    button->click();
    CHECK(done == 1);
    CHECK(bar.isHidden());
}

TEST_CASE("the layout of raw data is guessed from name and size", "[raw]") {
    const RawLayout nucleon = rawLayoutInName("/a/nucleon_41x41x41_uint8.raw", 41 * 41 * 41);
    CHECK(nucleon.dims == Int3(41, 41, 41));
    CHECK(nucleon.type == SampleType::U8);
    const RawLayout foot = rawLayoutInName("foot_16x8x4_int16.raw", 1024);
    CHECK(foot.dims == Int3(16, 8, 4));
    CHECK(foot.type == SampleType::I16);
    CHECK(rawLayoutInName("x_4x4x4_float32.raw", 256).type == SampleType::F32);
    CHECK(rawLayoutInName("x_4x4x4.raw", 256).type == SampleType::F32); // four bytes each
    CHECK(rawLayoutInName("cube.dat", 64 * 64 * 64).dims == Int3(64, 64, 64));
}
